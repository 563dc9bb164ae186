#include "services/recogniser/fitness_kernel.h"

#include <stdexcept>
#include <string>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "services/recogniser/fitness_kernel.cc"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "services/recogniser/look_up-inl.h"

HWY_BEFORE_NAMESPACE();
namespace visavis {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// No MulAdd here: it fuses on some targets and not on others, and the poses must be the same bit
// for bit. Mul, Add, Div and Sqrt are exact to the last bit by IEEE 754 on all of them.
template <class D, class V = hn::Vec<D>>
V Dot(D d, const float m[3], V x, V y, V z) {
  return hn::Add(hn::Add(hn::Mul(hn::Set(d, m[0]), x), hn::Mul(hn::Set(d, m[1]), y)),
                 hn::Mul(hn::Set(d, m[2]), z));
}

// Fetches the map under points given by their coefficients of @p matrix.
template <class D, class V = hn::Vec<D>>
auto Fetch(D d, const float matrix[3][3], const FitnessView& view, const FitnessMap& map, V a, V b,
           V c) {
  const hn::RebindToSigned<D> di;
  const V x = hn::Add(Dot(d, matrix[0], a, b, c), hn::Set(d, view.origin[0]));
  const V y = hn::Add(Dot(d, matrix[1], a, b, c), hn::Set(d, view.origin[1]));
  const V z = hn::Add(Dot(d, matrix[2], a, b, c), hn::Set(d, view.origin[2]));
  const V inverse_z = hn::Div(hn::Set(d, 1.0f), z);
  const V zero = hn::Zero(d);
  // cx and cy carry the half that makes truncation round to the nearest pixel.
  const V px = hn::Add(hn::Mul(x, inverse_z), hn::Set(d, view.cx));
  const V py = hn::Add(hn::Mul(y, inverse_z), hn::Set(d, view.cy));
  const auto column = hn::ConvertTo(di, hn::Min(hn::Max(px, zero), hn::Set(d, map.max_x)));
  const auto row = hn::ConvertTo(di, hn::Min(hn::Max(py, zero), hn::Set(d, map.max_y)));
  const auto index = hn::Add(hn::Mul(row, hn::Set(di, map.stride)), column);
  return LookUp(di, reinterpret_cast<const std::int32_t*>(map.pixels), index);
}

void SumFitnessTarget(const FitnessView& view, const FitnessMap& map, const FitnessPoints& points,
                      FitnessSums* sums) {
  const hn::CappedTag<float, 16> d;
  const hn::RebindToSigned<decltype(d)> di;
  const int lanes = static_cast<int>(hn::Lanes(d));
  const auto byte = hn::Set(di, 255);
  const auto top_byte = [&](auto v) { return hn::And(hn::ShiftRight<24>(v), byte); };

  auto color = hn::Zero(di), site_in = hn::Zero(di), site_out = hn::Zero(di);
  for (int i = 0; i < points.num_in; i += lanes) {
    const auto u = hn::LoadU(d, points.in_u + i), v = hn::LoadU(d, points.in_v + i);
    const auto r2 = hn::Add(hn::Mul(u, u), hn::Mul(v, v));
    const auto h = hn::Sqrt(hn::Sub(hn::Set(d, 1.0f), hn::Mul(hn::Set(d, view.rho2), r2)));
    const auto fetched = Fetch(d, view.disc, view, map, u, v, h);
    const auto is_hair = hn::Gt(Dot(d, view.hair, u, v, h), hn::Set(d, view.hair_offset));
    const auto class_byte =
        hn::IfThenElse(hn::RebindMask(di, is_hair), fetched, hn::ShiftRight<8>(fetched));
    color = hn::Add(color, hn::And(class_byte, byte));
    site_in = hn::Add(site_in, top_byte(fetched));
  }
  const auto contour_h = hn::Set(d, view.contour_h);
  for (int i = 0; i < points.num_out; i += lanes) {
    const auto u = hn::LoadU(d, points.out_u + i), v = hn::LoadU(d, points.out_v + i);
    site_out = hn::Add(site_out, top_byte(Fetch(d, view.disc, view, map, u, v, contour_h)));
  }
  const auto sum_features = [&](int begin, int end) {
    auto sum = hn::Zero(di);
    for (int i = begin; i < end; i += lanes) {
      const auto x = hn::LoadU(d, points.feature_x + i), y = hn::LoadU(d, points.feature_y + i),
                 z = hn::LoadU(d, points.feature_z + i);
      const auto fetched = Fetch(d, view.model, view, map, x, y, z);
      sum = hn::Add(sum, hn::And(hn::ShiftRight<16>(fetched), byte));
    }
    return hn::GetLane(hn::SumOfLanes(di, sum));
  };
  sums->site_in = hn::GetLane(hn::SumOfLanes(di, site_in));
  sums->site_out = hn::GetLane(hn::SumOfLanes(di, site_out));
  sums->color = hn::GetLane(hn::SumOfLanes(di, color));
  sums->feature_in = sum_features(0, points.num_feature_in);
  sums->feature_out = sum_features(points.num_feature_in, points.num_feature);
}

}  // namespace HWY_NAMESPACE
}  // namespace visavis
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace visavis {

HWY_EXPORT(SumFitnessTarget);

void SumFitness(const FitnessView& view, const FitnessMap& map, const FitnessPoints& points,
                FitnessSums* sums) {
  HWY_DYNAMIC_DISPATCH(SumFitnessTarget)(view, map, points, sums);
}

void SelectSimdTarget(const char* name) {
  hwy::SetSupportedTargetsForTest(0);
  const std::string wanted = name;
  if (wanted == "auto") return;
  std::int64_t allowed = 0;
  // Bits are ordered from the best target to the worst.
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    if (wanted == hwy::TargetName(target)) allowed = target;
  }
  if (allowed == 0) {
    throw std::invalid_argument("simd: " + wanted + ": must be auto or one of " + SimdTargets());
  }
  hwy::SetSupportedTargetsForTest(allowed);
}

const char* SimdTargets() {
  static const std::string names = [] {
    std::string text;
    for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
      text += (text.empty() ? "" : ",") + std::string(hwy::TargetName(target));
    }
    return text;
  }();
  return names.c_str();
}

}  // namespace visavis
#endif
