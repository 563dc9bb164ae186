#pragma once

#include <map>
#include <string>

#include "tests/fuzz/decode_check.h"

namespace visavis {

/// Checks a message's body (what follows its fingerprint) as CheckDecode() does. The reused message
/// is the same in every call, so it holds whatever earlier inputs left in it.
using CheckBody = DecodeVerdict (*)(const std::vector<std::uint8_t>& body, AllocationCounter);

template <typename T>
DecodeVerdict CheckBodyAs(const std::vector<std::uint8_t>& body, AllocationCounter num_allocated) {
  static T reused{};
  std::vector<std::uint8_t> input(8 + body.size());
  const std::int64_t fingerprint = T::getHash();
  __int64_t_encode_array(input.data(), 0, 8, &fingerprint, 1);
  std::copy(body.begin(), body.end(), input.begin() + 8);
  return CheckDecode(input, &reused, num_allocated);
}

template <typename... T>
struct BodyChecks {
  const std::map<std::string, CheckBody> by_name{{T::getTypeName(), &CheckBodyAs<T>}...};
};

/// A check for every message type, by its name.
inline std::map<std::string, CheckBody> AllBodyChecks() { return AllTypes<BodyChecks>().by_name; }

}  // namespace visavis
