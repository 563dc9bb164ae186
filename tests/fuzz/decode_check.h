#pragma once

#include <algorithm>
#include <cstdint>
#include <exception>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/malloc_counter.h"
#include "tests/support/message_equal.h"

namespace visavis {

/// What a decoder did with one input. A crash or an abort does not come back.
struct DecodeVerdict {
  std::string fault;  ///< empty: none
  bool accepted{};    ///< decoded to the last byte: what a subscriber goes by
  std::int64_t allocated_bytes{};
};

/// Most bytes that decoding may allocate, all told.
constexpr std::int64_t AllocationLimit(std::int64_t input_bytes) {
  return 16 * input_bytes + 1000000;
}

/// Bytes allocated so far; -1 where they are not counted.
using AllocationCounter = std::int64_t (*)();

/// Decodes @p input (its heap block ends where the message ends, so that sanitizers see a step
/// beyond) into a fresh message and into @p reused, whatever that held, and checks that
/// - no exception leaves the decoder, and no more than AllocationLimit() is allocated;
/// - both results agree: reused equals fresh, field by field;
/// - no more is read than was given, and what was read encodes to the same bytes.
template <typename T>
DecodeVerdict CheckDecode(const std::vector<std::uint8_t>& input, T* reused,
                          AllocationCounter num_allocated = &NumMallocBytes) {
  DecodeVerdict verdict;
  std::ostringstream fault;
  const int size = static_cast<int>(input.size());
  T fresh{};
  for (T* message : {&fresh, reused}) {
    const std::int64_t before = num_allocated();
    int decoded = 0;
    try {
      decoded = message->decode(input.data(), 0, size);
    } catch (const std::exception& e) {
      fault << "throws " << e.what() << "; ";
      decoded = -1;
    }
    const std::int64_t allocated = before < 0 ? 0 : num_allocated() - before;
    verdict.allocated_bytes = std::max(verdict.allocated_bytes, allocated);
    if (allocated > AllocationLimit(size)) {
      fault << "allocates " << allocated << " bytes for " << size << "; ";
    }
    if (decoded > size) fault << "reads " << decoded << " bytes of " << size << "; ";
    if (message == &fresh) {
      verdict.accepted = decoded == size;
      if (decoded < 0 || decoded > size) continue;
      std::vector<std::uint8_t> again(static_cast<std::size_t>(decoded));
      if (fresh.getEncodedSize() != decoded) fault << "getEncodedSize() differs; ";
      if (fresh.encode(again.data(), 0, decoded) != decoded) fault << "does not encode; ";
      if (!std::equal(again.begin(), again.end(), input.begin())) fault << "encodes otherwise; ";
    } else {
      if (verdict.accepted != (decoded == size)) fault << "reused message decides otherwise; ";
      if (decoded >= 0 && !MessageEqual(fresh, *reused)) fault << "reused message differs; ";
    }
  }
  verdict.fault = fault.str();
  return verdict;
}

}  // namespace visavis
