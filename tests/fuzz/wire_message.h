#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "common/core/random.h"
#include "tests/support/lcm_schema.h"

namespace visavis {

using Bytes = std::vector<std::uint8_t>;

/// Where a length stands in a message's bytes, and what it counts.
struct WireLength {
  std::size_t offset;  ///< of the first of its bytes
  int num_bytes;       ///< 1, 2, 4 or 8; big-endian, signed
  bool is_string;      ///< a string's, its NUL included; else an array's count
  /// Least bytes of one more element: of each array with this count, and of all together; 1: a
  /// string.
  std::vector<int> element_bytes;
};

/// A message's bytes, fingerprint first, with the places worth lying at.
struct WireMessage {
  Bytes bytes;
  std::vector<WireLength> lengths;
};

/// A valid message of @p type with random content, arrays of 0 to @p max_count elements and strings
/// of 0 to 20 letters. Written from the .lcm files alone.
WireMessage RandomWireMessage(const LcmSchema& schema, const std::string& type, int max_count,
                              Random* random);

/// Overwrites a length with @p value, cut to its size.
void SetLength(const WireLength& length, std::int64_t value, Bytes* bytes);
std::int64_t GetLength(const WireLength& length, const Bytes& bytes);

/// One to three seeded mutations of a valid message: flipped bits, lying lengths, zeros and 0xff,
/// truncation, extension, bytes removed or doubled, random bytes behind the fingerprint or all
/// over.
Bytes Mutate(const WireMessage& message, Random* random);

/// The message with every length in turn set to the largest count that the rest of @p size bytes
/// can hold (the bytes behind are zeros): what asks a decoder for most memory.
std::vector<Bytes> Greediest(const WireMessage& message, std::size_t size);

}  // namespace visavis
