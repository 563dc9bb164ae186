// Lanes looked up and lanes kept, compiled once for each SIMD target: to be included by kernels
// after highway.h.
#if defined(VISAVIS_LOOK_UP_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VISAVIS_LOOK_UP_INL_H_
#undef VISAVIS_LOOK_UP_INL_H_
#else
#define VISAVIS_LOOK_UP_INL_H_
#endif

#include <hwy/highway.h>

#include <cstddef>
#include <cstdint>

HWY_BEFORE_NAMESPACE();
namespace visavis {
namespace HWY_NAMESPACE {

/// table[index] of each lane. One load each: processors' own gathers are several times slower than
/// that on some (microcode against leaks of data, and AMD's), and hardly faster on any.
template <class D, class T = hwy::HWY_NAMESPACE::TFromD<D>>
hwy::HWY_NAMESPACE::Vec<D> LookUp(
    D d, const T* table, hwy::HWY_NAMESPACE::Vec<hwy::HWY_NAMESPACE::RebindToSigned<D>> index) {
  namespace hn = hwy::HWY_NAMESPACE;
  constexpr std::size_t kMost = hn::MaxLanes(D());
  HWY_ALIGN std::int32_t at[kMost];
  HWY_ALIGN T found[kMost];
  hn::Store(index, hn::RebindToSigned<D>(), at);
  for (std::size_t k = 0; k < hn::Lanes(d); ++k) found[k] = table[at[k]];
  return hn::Load(d, found);
}

/// Calls @p keep with the number of each lane that is set in @p mask. Not Compress: without an
/// instruction for it (before AVX-512) Highway 1.0's copies its table to the stack each time.
template <class D, class Mask, class Keep>
void ForLanes(D d, Mask mask, const Keep& keep) {
  std::uint8_t bytes[8] = {};  // StoreMaskBits may write as many
  hwy::HWY_NAMESPACE::StoreMaskBits(d, mask, bytes);
  for (unsigned bits = bytes[0] | bytes[1] << 8u; bits != 0; bits &= bits - 1)
    keep(__builtin_ctz(bits));
}

}  // namespace HWY_NAMESPACE
}  // namespace visavis
HWY_AFTER_NAMESPACE();

#endif
