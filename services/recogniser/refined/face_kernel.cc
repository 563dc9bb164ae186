#include "services/recogniser/refined/face_kernel.h"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "services/recogniser/refined/face_kernel.cc"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "services/recogniser/look_up-inl.h"

HWY_BEFORE_NAMESPACE();
namespace visavis {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
namespace {

// No MulAdd: it fuses on some targets and not on others. No approximations of 1 / x either.
using D = hn::CappedTag<float, kLanes>;
using DI = hn::RebindToSigned<D>;
using DB = hn::Rebind<std::uint8_t, D>;
using V = hn::Vec<D>;
using VI = hn::Vec<DI>;
using M = hn::Mask<D>;

V Dot(const float m[3], V x, V y, V z) {
  const D d;
  return hn::Add(hn::Add(hn::Mul(hn::Set(d, m[0]), x), hn::Mul(hn::Set(d, m[1]), y)),
                 hn::Mul(hn::Set(d, m[2]), z));
}

V Plus(V v, float offset) { return hn::Add(v, hn::Set(D(), offset)); }
V Times(V v, float factor) { return hn::Mul(v, hn::Set(D(), factor)); }

M Within(V v, float from, float to) {
  return hn::And(hn::Ge(v, hn::Set(D(), from)), hn::Lt(v, hn::Set(D(), to)));
}

VI Lower(VI pairs) { return hn::ShiftRight<16>(hn::ShiftLeft<16>(pairs)); }
VI Upper(VI pairs) { return hn::ShiftRight<16>(pairs); }

/// What an eye shows at the pattern's points, at the nearest samples.
struct PatternEye {
  const KernelEye& eye;
  const BandView& band;
  const PatternPoints& points;
  float highest;

  V Load(const std::vector<float>& column, int i) const {
    return hn::LoadU(D(), column.data() + i);
  }

  /// Points of a vector from point @p i on that are turned to the eye.
  M Turned(int i) const {
    const V away =
        hn::Sub(Load(points.n_dot_p, i), Dot(eye.p_ME, Load(points.normal_x, i),
                                             Load(points.normal_y, i), Load(points.normal_z, i)));
    return hn::Le(away, hn::Set(D(), highest));
  }
  /// The clamped samples; takes those out of *@p counts that lie outside of the band.
  VI Fetch(int i, M* counts) const {
    const D d;
    const DI di;
    const V p = Load(points.x, i), q = Load(points.y, i), r = Load(points.z, i);
    const V z = hn::Max(Plus(Dot(eye.R[2], p, q, r), eye.t[2]), hn::Set(d, 0.05f));
    const V iz = hn::Div(hn::Set(d, 1.0f), z);
    const V u = Plus(hn::Mul(Times(Plus(Dot(eye.R[0], p, q, r), eye.t[0]), eye.fx), iz), eye.cx);
    const V v = Plus(hn::Mul(Times(Plus(Dot(eye.R[1], p, q, r), eye.t[1]), eye.fy), iz), eye.cy);
    const V a = Times(Plus(u, 0.5f - band.x0), band.scale);
    const V b = Times(Plus(v, 0.5f - band.y0), band.scale);
    *counts = hn::And(*counts, hn::And(Within(a, 0, static_cast<float>(band.width)),
                                       Within(b, 0, static_cast<float>(band.height))));
    const VI column = hn::ConvertTo(di, hn::IfThenElseZero(*counts, a));
    const VI row = hn::ConvertTo(di, hn::IfThenElseZero(*counts, b));
    const VI index = hn::Add(hn::Mul(row, hn::Set(di, band.width)), column);
    const VI fetched = hn::ShiftRight<3>(Lower(LookUp(di, band.pairs, index)));
    return hn::Min(hn::Max(fetched, hn::Set(di, -kLargestBandStep)), hn::Set(di, kLargestBandStep));
  }
};

struct CorrelationSums {
  VI n, x, y, xx, xy, yy;

  CorrelationSums() : n(hn::Zero(DI())), x(n), y(n), xx(n), xy(n), yy(n) {}
  void Add(M counts, VI left, VI right) {
    const auto mask = hn::RebindMask(DI(), counts);
    const VI a = hn::IfThenElseZero(mask, left), b = hn::IfThenElseZero(mask, right);
    n = hn::Sub(n, hn::VecFromMask(DI(), mask));
    x = hn::Add(x, a);
    y = hn::Add(y, b);
    xx = hn::Add(xx, hn::Mul(a, a));
    xy = hn::Add(xy, hn::Mul(a, b));
    yy = hn::Add(yy, hn::Mul(b, b));
  }
  PatternSums Total() const {
    const auto sum = [](VI v) { return hn::GetLane(hn::SumOfLanes(DI(), v)); };
    return {sum(n), sum(x), sum(y), sum(xx), sum(xy), sum(yy)};
  }
};

PatternSums SumPatternTarget(const KernelEye& eye, const BandView& band,
                             const PatternPoints& points, float highest) {
  const D d;
  const int width = static_cast<int>(hn::Lanes(d)), size = points.size();
  const PatternEye seen{eye, band, points, highest};
  CorrelationSums sums;
  for (int i = 0; i < size; i += width) {
    M counts = seen.Turned(i);
    if (hn::AllFalse(d, counts)) continue;
    const VI value = seen.Fetch(i, &counts);
    sums.Add(counts, hn::LoadU(DI(), points.value.data() + i), value);
  }
  return sums.Total();
}

PatternSums SumAgreementTarget(const KernelEye eyes[2], const BandView bands[2],
                               const PatternPoints& points, const float highest[2]) {
  const D d;
  const int width = static_cast<int>(hn::Lanes(d)), size = points.size();
  const PatternEye right{eyes[0], bands[0], points, highest[0]};
  const PatternEye left{eyes[1], bands[1], points, highest[1]};
  CorrelationSums sums;
  for (int i = 0; i < size; i += width) {
    M counts = hn::And(right.Turned(i), left.Turned(i));
    if (hn::AllFalse(d, counts)) continue;
    const VI x = right.Fetch(i, &counts), y = left.Fetch(i, &counts);
    sums.Add(counts, x, y);
  }
  return sums.Total();
}

// The 4 x 4 neighbourhood without its corners: value and gradient [levels, a px], interpolated.
void Interpolate(const BandView& band, VI index, V a, V b, V* value, V* du, V* dv) {
  const D d;
  const DI di;
  const auto fetch = [&](int row, int column) {
    return LookUp(di, band.pairs + row * band.width + column, index);
  };
  const auto lower = [&](VI pairs) { return hn::ConvertTo(d, Lower(pairs)); };
  const auto upper = [&](VI pairs) { return hn::ConvertTo(d, Upper(pairs)); };
  const auto blend = [](V share, V from, V to) {
    return hn::Add(from, hn::Mul(share, hn::Sub(to, from)));
  };
  const VI above = fetch(-1, 0), below = fetch(2, 0);
  const VI left0 = fetch(0, -1), right0 = fetch(0, 1), left1 = fetch(1, -1), right1 = fetch(1, 1);
  const V r0 = blend(a, lower(above), upper(above)), r1 = blend(a, upper(left0), lower(right0));
  const V r2 = blend(a, upper(left1), lower(right1)), r3 = blend(a, lower(below), upper(below));
  const V c0 = blend(b, lower(left0), lower(left1)), c1 = blend(b, upper(left0), upper(left1));
  const V c2 = blend(b, lower(right0), lower(right1)), c3 = blend(b, upper(right0), upper(right1));
  *value = Times(blend(b, r1, r2), kBandUnit);
  const float half = 0.5f * band.scale * kBandUnit;
  *du = Times(blend(a, hn::Sub(c2, c0), hn::Sub(c3, c1)), half);
  *dv = Times(blend(b, hn::Sub(r2, r0), hn::Sub(r3, r1)), half);
}

// One block of kLanes points.
void SampleBlock(const KernelEye& eye, const BandView& band, const float* points,
                 const float* normals, float min_facing, const SampleArrays& out) {
  const D d;
  const DI di;
  const int width = static_cast<int>(hn::Lanes(d));
  for (int i = 0; i < kLanes; i += width) {
    V x, y, z, nx, ny, nz;
    hn::LoadInterleaved3(d, points + 3 * i, x, y, z);
    hn::LoadInterleaved3(d, normals + 3 * i, nx, ny, nz);
    const V wx = Plus(x, -eye.p_ME[0]), wy = Plus(y, -eye.p_ME[1]), wz = Plus(z, -eye.p_ME[2]);
    const V towards = hn::Neg(hn::Add(hn::Add(hn::Mul(nx, wx), hn::Mul(ny, wy)), hn::Mul(nz, wz)));
    const V square = hn::Add(hn::Add(hn::Mul(wx, wx), hn::Mul(wy, wy)), hn::Mul(wz, wz));
    const V facing = hn::Div(towards, hn::Sqrt(square));
    M seen = hn::And(hn::Gt(towards, hn::Zero(d)), hn::Ge(facing, hn::Set(d, min_facing)));
    V value = hn::Zero(d), sx = value, sy = value, sz = value;
    if (!hn::AllFalse(d, seen)) {
      const V depth = Plus(Dot(eye.R[2], x, y, z), eye.t[2]);
      seen = hn::And(seen, hn::Ge(depth, hn::Set(d, 0.1f)));
      const V iz = hn::Div(hn::Set(d, 1.0f), hn::Max(depth, hn::Set(d, 0.1f)));
      const V p = hn::Mul(Plus(Dot(eye.R[0], x, y, z), eye.t[0]), iz);
      const V q = hn::Mul(Plus(Dot(eye.R[1], x, y, z), eye.t[1]), iz);
      const V u = Plus(Times(p, eye.fx), eye.cx), v = Plus(Times(q, eye.fy), eye.cy);
      const V column = Plus(Times(Plus(u, 0.5f - band.x0), band.scale), -0.5f);
      const V row = Plus(Times(Plus(v, 0.5f - band.y0), band.scale), -0.5f);
      seen = hn::And(seen, hn::And(Within(column, 2, static_cast<float>(band.width - 3)),
                                   Within(row, 2, static_cast<float>(band.height - 3))));
      // Points that are not seen read sample (2, 2) of a band that has one.
      const V two = hn::Set(d, 2.0f);
      const V from_x = hn::IfThenElse(seen, column, two), from_y = hn::IfThenElse(seen, row, two);
      const VI ix = hn::ConvertTo(di, from_x), iy = hn::ConvertTo(di, from_y);
      if (!hn::AllFalse(d, seen)) {
        V du, dv;
        Interpolate(band, hn::Add(hn::Mul(iy, hn::Set(di, band.width)), ix),
                    hn::Sub(from_x, hn::ConvertTo(d, ix)), hn::Sub(from_y, hn::ConvertTo(d, iy)),
                    &value, &du, &dv);
        const V su = hn::Mul(Times(du, eye.fx), iz), sv = hn::Mul(Times(dv, eye.fy), iz);
        const V sw = hn::Neg(hn::Add(hn::Mul(su, p), hn::Mul(sv, q)));
        sx = Dot(eye.R_CE[0], su, sv, sw);
        sy = Dot(eye.R_CE[1], su, sv, sw);
        sz = Dot(eye.R_CE[2], su, sv, sw);
      }
    }
    hn::StoreU(hn::IfThenElseZero(seen, value), d, out.value + i);
    hn::StoreU(hn::IfThenElseZero(seen, facing), d, out.facing + i);
    hn::StoreInterleaved3(hn::IfThenElseZero(seen, sx), hn::IfThenElseZero(seen, sy),
                          hn::IfThenElseZero(seen, sz), d, out.slope + 3 * i);
    const VI flags = hn::IfThenElseZero(hn::RebindMask(di, seen), hn::Set(di, 1));
    hn::StoreU(hn::DemoteTo(DB(), flags), DB(), out.seen + i);
  }
}

void SamplePointsTarget(const KernelEye& eye, const BandView& band, const FaceArrays& face,
                        float min_facing, const SampleArrays& out) {
  const Blocks<float, 3> points(face.points, face.n), normals(face.normals, face.n);
  const int n = static_cast<int>(face.n);
  for (int i = 0; i < n; i += kLanes) {
    float value[kLanes], facing[kLanes], slope[3 * kLanes];
    unsigned char seen[kLanes];
    const int count = std::min(n - i, kLanes);
    const SampleArrays block = count == kLanes ? SampleArrays{out.value + i, out.facing + i,
                                                              out.slope + 3 * i, out.seen + i}
                                               : SampleArrays{value, facing, slope, seen};
    SampleBlock(eye, band, points.At(i), normals.At(i), min_facing, block);
    if (count == kLanes) continue;
    std::copy(value, value + count, out.value + i);
    std::copy(facing, facing + count, out.facing + i);
    std::copy(slope, slope + 3 * count, out.slope + 3 * i);
    std::copy(seen, seen + count, out.seen + i);
  }
}

struct SeriesBlocks {
  explicit SeriesBlocks(const PairedSeries& s)
      : x(s.x, s.n),
        y(s.y, s.n),
        x_facing(s.x_facing, s.n),
        y_facing(s.y_facing, s.n),
        x_flags(s.x_flags, s.n),
        y_flags(s.y_flags, s.n),
        min_facing(s.min_facing) {}
  Blocks<float> x, y, x_facing, y_facing;
  Blocks<unsigned char> x_flags, y_flags;
  float min_facing;

  M Counts(int block, int phase) const {
    const D d;
    const auto flag = [&](const Blocks<unsigned char>& flags) {
      return hn::PromoteTo(DI(), hn::LoadU(DB(), flags.At(block) + phase));
    };
    const auto flags =
        hn::And(hn::Gt(flag(x_flags), hn::Zero(DI())), hn::Gt(flag(y_flags), hn::Zero(DI())));
    const V least = hn::Set(d, min_facing);
    return hn::And(hn::RebindMask(d, flags),
                   hn::And(hn::Ge(hn::LoadU(d, x_facing.At(block) + phase), least),
                           hn::Ge(hn::LoadU(d, y_facing.At(block) + phase), least)));
  }
};

void SumPairsTarget(const PairedSeries& series, float lanes[6][kLanes]) {
  const D d;
  const SeriesBlocks s(series);
  const int width = static_cast<int>(hn::Lanes(d)), size = static_cast<int>(series.n);
  for (int phase = 0; phase < kLanes; phase += width) {
    V n = hn::Zero(d), x = n, y = n, xx = n, xy = n, yy = n;
    for (int i = 0; i < size; i += kLanes) {
      const M counts = s.Counts(i, phase);
      const V a = hn::IfThenElseZero(counts, hn::LoadU(d, s.x.At(i) + phase));
      const V b = hn::IfThenElseZero(counts, hn::LoadU(d, s.y.At(i) + phase));
      n = hn::Add(n, hn::IfThenElseZero(counts, hn::Set(d, 1.0f)));
      x = hn::Add(x, a);
      y = hn::Add(y, b);
      xx = hn::Add(xx, hn::Mul(a, a));
      xy = hn::Add(xy, hn::Mul(a, b));
      yy = hn::Add(yy, hn::Mul(b, b));
    }
    const V sums[6] = {n, x, y, xx, xy, yy};
    for (int k = 0; k < 6; ++k) hn::StoreU(sums[k], d, lanes[k] + phase);
  }
}

void AddPairsTarget(const PairedSeries& series, const PairEquations& e, EquationSums* sums) {
  const D d;
  const SeriesBlocks s(series);
  const Blocks<float, 3> points(e.points, series.n), y_slope(e.y_slope, series.n),
      x_slope(e.x_slope != nullptr ? e.x_slope : e.y_slope, series.n);
  float R[3][3];
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) R[i][j] = (*e.R_CM)(i, j);
  }
  const int width = static_cast<int>(hn::Lanes(d)), size = static_cast<int>(series.n);
  EquationRows rows;
  const auto flush = [&] {
    sums->Add(rows);
    rows.n = 0;
  };
  for (int i = 0; i < size; i += kLanes) {
    for (int phase = 0; phase < kLanes; phase += width) {
      const int at = rows.n + phase;
      const M counts = s.Counts(i, phase);
      V px, py, pz, sx, sy, sz;
      hn::LoadInterleaved3(d, points.At(i) + 3 * phase, px, py, pz);
      hn::LoadInterleaved3(d, y_slope.At(i) + 3 * phase, sx, sy, sz);
      if (e.x_slope != nullptr) {
        V tx, ty, tz;
        hn::LoadInterleaved3(d, x_slope.At(i) + 3 * phase, tx, ty, tz);
        sx = hn::Sub(sx, Times(tx, e.gain));
        sy = hn::Sub(sy, Times(ty, e.gain));
        sz = hn::Sub(sz, Times(tz, e.gain));
      }
      const V x = hn::LoadU(d, s.x.At(i) + phase), y = hn::LoadU(d, s.y.At(i) + phase);
      const V residual = hn::Sub(Plus(Times(x, e.gain), e.offset), y);
      const V spread = Plus(Times(hn::Mul(residual, residual), e.robust), 1);
      const V weight = hn::Div(hn::Set(d, e.scale), spread);
      const auto store = [&](EquationRows::Column* column, V v) {
        hn::StoreU(v, d, column->data() + at);
      };
      store(&rows.slope_x, sx);
      store(&rows.slope_y, sy);
      store(&rows.slope_z, sz);
      store(&rows.arm_x, Dot(R[0], px, py, pz));
      store(&rows.arm_y, Dot(R[1], px, py, pz));
      store(&rows.arm_z, Dot(R[2], px, py, pz));
      store(&rows.residual, residual);
      store(&rows.weight, hn::IfThenElseZero(counts, weight));
    }
    rows.n += kLanes;
    if (rows.n == EquationRows::kSize) flush();
  }
  flush();
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace visavis
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace visavis {

HWY_EXPORT(SumPatternTarget);
HWY_EXPORT(SumAgreementTarget);
HWY_EXPORT(SamplePointsTarget);
HWY_EXPORT(SumPairsTarget);
HWY_EXPORT(AddPairsTarget);

PatternSums SumPattern(const KernelEye& eye, const BandView& band, const PatternPoints& points,
                       float highest) {
  return HWY_DYNAMIC_DISPATCH(SumPatternTarget)(eye, band, points, highest);
}

PatternSums SumAgreement(const KernelEye eyes[2], const BandView bands[2],
                         const PatternPoints& points, const float highest[2]) {
  return HWY_DYNAMIC_DISPATCH(SumAgreementTarget)(eyes, bands, points, highest);
}

void SamplePoints(const KernelEye& eye, const BandView& band, const FaceArrays& face,
                  float min_facing, const SampleArrays& samples) {
  HWY_DYNAMIC_DISPATCH(SamplePointsTarget)(eye, band, face, min_facing, samples);
}

PairSums SumPairs(const PairedSeries& series) {
  float lanes[6][kLanes];
  HWY_DYNAMIC_DISPATCH(SumPairsTarget)(series, lanes);
  double sums[6] = {};
  for (int k = 0; k < 6; ++k) {
    for (const float lane : lanes[k]) sums[k] += static_cast<double>(lane);
  }
  return {sums[0], sums[1], sums[2], sums[3], sums[4], sums[5]};
}

void AddPairs(const PairedSeries& series, const PairEquations& wanted, PoseEquations* equations) {
  EquationSums sums;
  HWY_DYNAMIC_DISPATCH(AddPairsTarget)(series, wanted, &sums);
  sums.AddTo(equations);
}

}  // namespace visavis
#endif
