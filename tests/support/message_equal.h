#pragma once

#include <cstring>
#include <string>
#include <type_traits>
#include <vector>

#include "all_types.h"

namespace visavis {

/// Whether two messages are the same bit for bit (so NaN equals itself), lengths of vectors
/// included: encoding them would not show surplus elements.
template <typename T>
bool MessageEqual(const T& a, const T& b);

template <typename T>
bool FieldEqual(const T& a, const T& b) {
  if constexpr (std::is_arithmetic_v<T>) {
    // NOLINTNEXTLINE(bugprone-suspicious-memory-comparison): bit for bit is what is meant.
    return std::memcmp(&a, &b, sizeof a) == 0;
  } else {
    return MessageEqual(a, b);
  }
}
inline bool FieldEqual(const std::string& a, const std::string& b) { return a == b; }
template <typename T, std::size_t n>
bool FieldEqual(const T (&a)[n], const T (&b)[n]) {
  for (std::size_t i = 0; i < n; ++i) {
    if (!FieldEqual(a[i], b[i])) return false;
  }
  return true;
}
template <typename T>
bool FieldEqual(const std::vector<T>& a, const std::vector<T>& b) {
  if (a.size() != b.size()) return false;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (!FieldEqual(a[i], b[i])) return false;
  }
  return true;
}

template <typename T>
bool MessageEqual(const T& a, const T& b) {
  return AllFields(a, b, [](const auto& x, const auto& y) { return FieldEqual(x, y); });
}

}  // namespace visavis
