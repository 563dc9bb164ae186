// What kernels do lane by lane where a processor has no good instruction for it, compiled once for
// each SIMD target: to be included after highway.h.
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

/// table[index] of each lane. Before AVX-512 by a load each: gathers are slow there on some.
template <class D, class T = hwy::HWY_NAMESPACE::TFromD<D>>
hwy::HWY_NAMESPACE::Vec<D> LookUp(
    D d, const T* table, hwy::HWY_NAMESPACE::Vec<hwy::HWY_NAMESPACE::RebindToSigned<D>> index) {
  namespace hn = hwy::HWY_NAMESPACE;
#if HWY_TARGET <= HWY_AVX3
  return hn::GatherIndex(d, table, index);
#else
  constexpr std::size_t kMost = hn::MaxLanes(D());
  HWY_ALIGN std::int32_t at[kMost];
  HWY_ALIGN T found[kMost];
  hn::Store(index, hn::RebindToSigned<D>(), at);
  for (std::size_t k = 0; k < hn::Lanes(d); ++k) found[k] = table[at[k]];
  return hn::Load(d, found);
#endif
}

/// The lanes that are set in a mask. Before AVX-512 without Compress: Highway 1.0's copies its
/// table to the stack each time.
template <class D>
class KeptLanes {
 public:
  KeptLanes(D d, hwy::HWY_NAMESPACE::Mask<D> mask)
      : mask_(mask), count_(static_cast<int>(hwy::HWY_NAMESPACE::CountTrue(d, mask))) {
    hwy::HWY_NAMESPACE::StoreMaskBits(d, mask, bits_);
  }
  int count() const { return count_; }

  /// Copies them from @p from on, which has all lanes, to @p to on, one behind the other; what is
  /// behind them, up to all lanes, is overwritten.
  template <class T>
  void Copy(const T* from, T* to) const {
#if HWY_TARGET <= HWY_AVX3
    namespace hn = hwy::HWY_NAMESPACE;
    const hn::Rebind<T, D> d;
    hn::StoreU(hn::Compress(hn::LoadU(d, from), hn::RebindMask(d, mask_)), d, to);
#else
    for (std::size_t k = 0; k < hwy::HWY_NAMESPACE::Lanes(D()); ++k) {
      *to = from[k];
      to += bits_[k / 8] >> k % 8 & 1;
    }
#endif
  }

 private:
  hwy::HWY_NAMESPACE::Mask<D> mask_;
  int count_;
  std::uint8_t bits_[8] = {};  // StoreMaskBits may write as many
};

}  // namespace HWY_NAMESPACE
}  // namespace visavis
HWY_AFTER_NAMESPACE();

#endif
