#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <string>
#include <type_traits>
#include <vector>

// What harden.awk writes into the headers of lcm-gen 1.3.1. Stock decoders abort on a negative
// array length, crash on a negative string length, allocate whatever a length claims, and leave old
// elements in a reused message.
namespace visavis_lcm_hardening {

/// Bytes that the smallest element of this type takes on the wire, at least 1.
template <typename T>
std::int64_t MinEncodedSize() {
  if constexpr (std::is_arithmetic_v<T>) {
    return sizeof(T);
  } else if constexpr (std::is_same_v<T, std::string>) {
    return 5;  // length and NUL
  } else {
    static const std::int64_t size = std::max(1, T{}._getEncodedSizeNoHash());
    return size;
  }
}

/// Makes @p v as long as @p count claims, if so many elements can lie in @p remaining bytes; else
/// returns false and leaves @p v alone. Allocates exactly, so never more than the largest
/// sizeof(T) / MinEncodedSize<T>() times the input; elements that stay keep their own memory.
template <typename T>
bool Resize(std::vector<T>* v, std::int64_t count, std::int64_t remaining) {
  if (count < 0 || count > remaining / MinEncodedSize<T>()) return false;
  const auto size = static_cast<std::size_t>(count);
  v->reserve(size);
  v->resize(size);
  return true;
}

/// Whether @p length bytes at @p text are one string with its NUL at the end and none before it.
inline bool StringFits(const char* text, std::int64_t length, std::int64_t remaining) {
  return length >= 1 && length <= remaining &&
         std::memchr(text, 0, static_cast<std::size_t>(length)) == text + length - 1;
}

/// Whether @p v has the elements that the message's count promises to an encoder.
template <typename T>
bool Holds(const std::vector<T>& v, std::int64_t count) {
  return count >= 0 && static_cast<std::uint64_t>(count) <= v.size();
}

// float and double, big-endian. Stock code reads and writes them through integer pointers, which
// the optimiser may reorder with the caller's own accesses (GCC 12 does at -O2).

template <typename T>
using BitsOf = std::conditional_t<sizeof(T) == 4, std::uint32_t, std::uint64_t>;

/// @return bytes written, or -1 where @p maxlen is too short.
template <typename T>
int EncodeFloats(void* buf, int offset, int maxlen, const T* p, int elements) {
  if (maxlen < static_cast<int>(sizeof(T)) * elements) return -1;
  auto* out = static_cast<std::uint8_t*>(buf) + offset;
  for (int i = 0; i < elements; ++i) {
    BitsOf<T> bits;
    std::memcpy(&bits, p + i, sizeof(T));
    for (int shift = 8 * sizeof(T) - 8; shift >= 0; shift -= 8) {
      *out++ = static_cast<std::uint8_t>(bits >> shift);
    }
  }
  return static_cast<int>(sizeof(T)) * elements;
}

/// @return bytes read, or -1 where @p maxlen is too short.
template <typename T>
int DecodeFloats(const void* buf, int offset, int maxlen, T* p, int elements) {
  if (maxlen < static_cast<int>(sizeof(T)) * elements) return -1;
  const auto* in = static_cast<const std::uint8_t*>(buf) + offset;
  for (int i = 0; i < elements; ++i) {
    BitsOf<T> bits = 0;
    for (std::size_t k = 0; k < sizeof(T); ++k) bits = static_cast<BitsOf<T>>(bits << 8) | *in++;
    std::memcpy(p + i, &bits, sizeof(T));
  }
  return static_cast<int>(sizeof(T)) * elements;
}

}  // namespace visavis_lcm_hardening
