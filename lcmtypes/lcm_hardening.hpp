#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <type_traits>
#include <vector>

// Checks that harden.awk writes into the decoders of lcm-gen: stock ones abort on a negative array
// length, crash on a negative string length, and allocate whatever a length claims.
namespace visavis_lcm_hardening {

/// Bytes that the smallest element of this type takes on the wire.
template <typename T>
std::int64_t MinEncodedSize() {
  if constexpr (std::is_arithmetic_v<T>) {
    return sizeof(T);
  } else if constexpr (std::is_same_v<T, std::string>) {
    return 5;  // length and NUL
  } else {
    static const std::int64_t size = T{}._getEncodedSizeNoHash();
    return size;
  }
}

/// Whether @p count elements can lie in @p remaining bytes, so that it is safe to allocate them.
template <typename T>
bool ArrayFits(const std::vector<T>&, std::int64_t count, std::int64_t remaining) {
  return count >= 0 && count * MinEncodedSize<T>() <= remaining;
}

/// Whether @p length bytes at @p text are one string with its NUL at the end and none before it.
inline bool StringFits(const char* text, std::int64_t length, std::int64_t remaining) {
  return length >= 1 && length <= remaining &&
         std::memchr(text, 0, static_cast<std::size_t>(length)) == text + length - 1;
}

}  // namespace visavis_lcm_hardening
