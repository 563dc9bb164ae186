#include "services/recogniser/packed_map_kernel.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "services/recogniser/packed_map_kernel.cc"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace visavis {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// One pixel, for the rest of a row; the vector code below does the same sixteen at a time.
inline std::uint32_t PackOne(int r, int g, int b, const PackRule& rule) {
  const int gray = (77 * r + 150 * g + 29 * b + 128) >> 8;
  const int p = 255 - gray;
  const bool skin = r >= g && g > b && 2 * (g - b) < r - b && r >= rule.skin_min_value &&
                    (r - b) * 255 >= rule.skin_min_saturation * r;
  const bool hair = p > rule.hair_min_p && !skin;
  return (hair ? 0xffu : 0u) | (skin ? 0xff00u : 0u) | static_cast<std::uint32_t>(p) << 16 |
         static_cast<std::uint32_t>(p) << 24;
}

// Widening to 16 bits leaves room for every product: 255 * 255 < 65536.
void PackColorRowTarget(const std::uint8_t* pixels, int n, const PackRule& rule,
                        std::uint32_t* out) {
  const hn::CappedTag<std::uint16_t, 16> d16;
  const hn::Rebind<std::uint8_t, decltype(d16)> d8;
  const int lanes = static_cast<int>(hn::Lanes(d8));
  const auto set16 = [&](int v) { return hn::Set(d16, static_cast<std::uint16_t>(v)); };
  int i = 0;
  for (; i + lanes <= n; i += lanes) {
    hn::Vec<decltype(d8)> first, green, last;
    hn::LoadInterleaved3(d8, pixels + 3 * i, first, green, last);
    const auto r = hn::PromoteTo(d16, rule.bgr ? last : first);
    const auto g = hn::PromoteTo(d16, green);
    const auto b = hn::PromoteTo(d16, rule.bgr ? first : last);
    const auto luma = hn::Add(hn::Add(hn::Mul(r, set16(77)), hn::Mul(g, set16(150))),
                              hn::Add(hn::Mul(b, set16(29)), set16(128)));
    const auto p = hn::Sub(set16(255), hn::ShiftRight<8>(luma));
    // Saturated differences: 0 where the order is not r >= g > b, which the masks refuse anyway.
    const auto chroma = hn::SaturatedSub(r, b);
    const auto twice = hn::ShiftLeft<1>(hn::SaturatedSub(g, b));
    auto skin = hn::AndNot(hn::Gt(g, r), hn::And(hn::Gt(g, b), hn::Lt(twice, chroma)));
    skin = hn::AndNot(hn::Gt(set16(rule.skin_min_value), r), skin);
    skin = hn::AndNot(
        hn::Gt(hn::Mul(r, set16(rule.skin_min_saturation)), hn::Mul(chroma, set16(255))), skin);
    const auto hair = hn::AndNot(skin, hn::Gt(p, set16(rule.hair_min_p)));
    const auto all = set16(255);
    const auto p8 = hn::DemoteTo(d8, hn::BitCast(hn::RebindToSigned<decltype(d16)>(), p));
    const auto demote = [&](auto mask) {
      return hn::DemoteTo(
          d8, hn::BitCast(hn::RebindToSigned<decltype(d16)>(), hn::IfThenElseZero(mask, all)));
    };
    hn::StoreInterleaved4(demote(hair), demote(skin), p8, p8, d8,
                          reinterpret_cast<std::uint8_t*>(out + i));
  }
  for (; i < n; ++i) {
    const std::uint8_t* q = pixels + 3 * i;
    out[i] = rule.bgr ? PackOne(q[2], q[1], q[0], rule) : PackOne(q[0], q[1], q[2], rule);
  }
}

void PackGrayRowTarget(const std::uint8_t* pixels, int n, std::uint32_t* out) {
  for (int i = 0; i < n; ++i) out[i] = (255u - pixels[i]) * 0x01010000u;
}

}  // namespace HWY_NAMESPACE
}  // namespace visavis
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace visavis {

HWY_EXPORT(PackColorRowTarget);
HWY_EXPORT(PackGrayRowTarget);

void PackColorRow(const std::uint8_t* pixels, int n, const PackRule& rule, std::uint32_t* out) {
  HWY_DYNAMIC_DISPATCH(PackColorRowTarget)(pixels, n, rule, out);
}

void PackGrayRow(const std::uint8_t* pixels, int n, std::uint32_t* out) {
  HWY_DYNAMIC_DISPATCH(PackGrayRowTarget)(pixels, n, out);
}

}  // namespace visavis
#endif
