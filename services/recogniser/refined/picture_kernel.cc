#include "services/recogniser/refined/picture_kernel.h"

#include "services/recogniser/refined/color_model.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "services/recogniser/refined/picture_kernel.cc"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "services/recogniser/look_up-inl.h"

HWY_BEFORE_NAMESPACE();
namespace visavis {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
namespace {

void LookUpScoresTarget(const std::uint8_t* pixels, int n, bool bgr, const std::uint32_t* table,
                        std::uint32_t* scores) {
  const hn::CappedTag<std::int32_t, 16> di;
  const hn::RebindToUnsigned<decltype(di)> du;
  const hn::Rebind<std::uint8_t, decltype(di)> d8;
  const int width = static_cast<int>(hn::Lanes(di));
  const auto high_bits = hn::Set(du, 0xf0);
  int i = 0;
  for (; i + width <= n; i += width) {
    hn::Vec<decltype(d8)> first, green, last;
    hn::LoadInterleaved3(d8, pixels + 3 * i, first, green, last);
    const auto r = hn::And(hn::PromoteTo(du, bgr ? last : first), high_bits);
    const auto g = hn::And(hn::PromoteTo(du, green), high_bits);
    const auto b = hn::ShiftRight<4>(hn::PromoteTo(du, bgr ? first : last));
    const auto bin = hn::BitCast(di, hn::Or(hn::Or(hn::ShiftLeft<4>(r), g), b));
    hn::StoreU(LookUp(du, table, bin), du, scores + i);
  }
  for (; i < n; ++i) {
    const std::uint8_t* p = pixels + 3 * i;
    scores[i] = table[ColorModel::BinOf(p[bgr ? 2 : 0], p[1], p[bgr ? 0 : 2])];
  }
}

void MeanBrightnessTarget(const std::uint8_t* top, const std::uint8_t* bottom, int n, bool bgr,
                          std::uint16_t* out) {
  const hn::CappedTag<std::uint16_t, 16> d16;
  const hn::Rebind<std::uint8_t, decltype(d16)> d8;
  using V = hn::Vec<decltype(d16)>;
  const int width = static_cast<int>(hn::Lanes(d16));
  const std::uint16_t first_weight = bgr ? 29 : 77, last_weight = bgr ? 77 : 29;
  const auto brightness = [&](const std::uint8_t* pixels) {  // at most 255 * 256
    hn::Vec<decltype(d8)> first, green, last;
    hn::LoadInterleaved3(d8, pixels, first, green, last);
    const V a = hn::Mul(hn::PromoteTo(d16, first), hn::Set(d16, first_weight));
    const V b = hn::Mul(hn::PromoteTo(d16, green), hn::Set(d16, std::uint16_t{150}));
    const V c = hn::Mul(hn::PromoteTo(d16, last), hn::Set(d16, last_weight));
    return hn::Add(hn::Add(a, b), c);
  };
  int i = 0;
  for (; i + width <= n; i += width) {
    hn::StoreU(hn::AverageRound(brightness(top + 3 * i), brightness(bottom + 3 * i)), d16, out + i);
  }
  for (; i < n; ++i) {
    const std::uint8_t *a = top + 3 * i, *b = bottom + 3 * i;
    const int sum =
        first_weight * (a[0] + b[0]) + 150 * (a[1] + b[1]) + last_weight * (a[2] + b[2]);
    out[i] = static_cast<std::uint16_t>((sum + 1) / 2);
  }
}

using D = hn::CappedTag<float, 16>;
using V = hn::Vec<D>;

// ln(x) of normal x > 0: x = 2^e m with m in [sqrt(1/2), sqrt(2)), ln(m) = 2 artanh(t),
// t = (m - 1) / (m + 1). No MulAdd: it fuses on some targets and not on others.
V Log(V x) {
  const D d;
  const hn::RebindToSigned<D> di;
  const auto bits = hn::BitCast(di, x);
  const auto exponent = hn::ShiftRight<23>(hn::Sub(bits, hn::Set(di, 0x3f3504f3)));
  const V m = hn::BitCast(d, hn::Sub(bits, hn::ShiftLeft<23>(exponent)));
  const V one = hn::Set(d, 1.0f);
  const V t = hn::Div(hn::Sub(m, one), hn::Add(m, one)), t2 = hn::Mul(t, t);
  V series = hn::Add(hn::Mul(t2, hn::Set(d, 0.2f)), hn::Set(d, 1.0f / 3));
  series = hn::Mul(hn::Add(t, t), hn::Add(one, hn::Mul(t2, series)));
  return hn::Add(hn::Mul(hn::ConvertTo(d, exponent), hn::Set(d, 0.693147181f)), series);
}

void MakeScoresTarget(const ColorShares& shares, int n, std::uint32_t* scores) {
  const D d;
  const hn::RebindToSigned<D> di;
  const hn::RebindToUnsigned<D> du;
  const int width = static_cast<int>(hn::Lanes(d));
  const auto byte = [&](V ratio) {
    const V score = hn::Add(hn::Mul(Log(ratio), hn::Set(d, kScorePerNat)),
                            hn::Set(d, static_cast<float>(kScoreZero)));
    const V limited = hn::Min(hn::Max(score, hn::Set(d, 1.0f)), hn::Set(d, 255.0f));
    return hn::BitCast(du, hn::ConvertTo(di, hn::Add(limited, hn::Set(d, 0.5f))));
  };
  for (int i = 0; i < n; i += width) {
    const V skin = hn::LoadU(d, shares.skin + i), hair = hn::LoadU(d, shares.hair + i);
    const V around = hn::Div(hn::Set(d, 1.0f), hn::LoadU(d, shares.surroundings + i));
    const V head = hn::Mul(hn::Set(d, 0.5f), hn::Add(hair, skin));
    const auto packed =
        hn::Or(hn::Or(byte(hn::Mul(hair, around)), hn::ShiftLeft<8>(byte(hn::Mul(skin, around)))),
               hn::ShiftLeft<16>(byte(hn::Mul(head, around))));
    hn::StoreU(hn::Or(packed, hn::Set(du, 0xff000000u)), du, scores + i);
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace visavis
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace visavis {

HWY_EXPORT(LookUpScoresTarget);
HWY_EXPORT(MeanBrightnessTarget);
HWY_EXPORT(MakeScoresTarget);

void LookUpScores(const std::uint8_t* pixels, int n, bool bgr, const std::uint32_t* table,
                  std::uint32_t* scores) {
  HWY_DYNAMIC_DISPATCH(LookUpScoresTarget)(pixels, n, bgr, table, scores);
}

void MeanBrightness(const std::uint8_t* top, const std::uint8_t* bottom, int n, bool bgr,
                    std::uint16_t* out) {
  HWY_DYNAMIC_DISPATCH(MeanBrightnessTarget)(top, bottom, n, bgr, out);
}

void MakeScores(const ColorShares& shares, int n, std::uint32_t* scores) {
  HWY_DYNAMIC_DISPATCH(MakeScoresTarget)(shares, n, scores);
}

}  // namespace visavis
#endif
