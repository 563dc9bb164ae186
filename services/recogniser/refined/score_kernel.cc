#include "services/recogniser/refined/score_kernel.h"

#include <algorithm>
#include <cmath>

#include "services/recogniser/refined/score_map.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "services/recogniser/refined/score_kernel.cc"
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
using V = hn::Vec<D>;
using VI = hn::Vec<DI>;

template <class T>
V Load(const T& column, int i) {
  return hn::LoadU(D(), column.data() + i);
}

V Dot(const float m[3], V x, V y, V z) {
  const D d;
  return hn::Add(hn::Add(hn::Mul(hn::Set(d, m[0]), x), hn::Mul(hn::Set(d, m[1]), y)),
                 hn::Mul(hn::Set(d, m[2]), z));
}

struct Place {
  V x, y, z;
};

Place Turned(const float R[3][3], V x, V y, V z) {
  return {Dot(R[0], x, y, z), Dot(R[1], x, y, z), Dot(R[2], x, y, z)};
}

Place InEye(const KernelEye& eye, V x, V y, V z) {
  const D d;
  const Place p = Turned(eye.R, x, y, z);
  return {hn::Add(p.x, hn::Set(d, eye.t[0])), hn::Add(p.y, hn::Set(d, eye.t[1])),
          hn::Add(p.z, hn::Set(d, eye.t[2]))};
}

// The scores of the pixels nearest to (u, v); unknown and neutral outside of the box.
VI Fetch(const ScoreView& map, V u, V v) {
  const D d;
  const DI di;
  const V half = hn::Set(d, 0.5f), x = hn::Add(u, half), y = hn::Add(v, half);
  const auto inside =
      hn::And(hn::And(hn::Ge(x, hn::Set(d, map.x0)), hn::Lt(x, hn::Set(d, map.x1))),
              hn::And(hn::Ge(y, hn::Set(d, map.y0)), hn::Lt(y, hn::Set(d, map.y1))));
  const VI column = hn::ConvertTo(di, hn::IfThenElseZero(inside, x));
  const VI row = hn::ConvertTo(di, hn::IfThenElseZero(inside, y));
  const VI index = hn::Add(hn::Mul(row, hn::Set(di, map.stride)), column);
  const VI fetched = LookUp(di, reinterpret_cast<const std::int32_t*>(map.scores), index);
  return hn::IfThenElse(hn::RebindMask(di, inside), fetched,
                        hn::Set(di, static_cast<std::int32_t>(ScoreMap::kUnknown)));
}

// n.(p - p_ME).
template <class Points>
V FacingAt(const KernelEye& eye, const Points& points, int i) {
  return hn::Sub(Load(points.n_dot_p, i), Dot(eye.p_ME, Load(points.normal_x, i),
                                              Load(points.normal_y, i), Load(points.normal_z, i)));
}

// Points that count, one behind the other: few of a block do, and a gather costs as much for one.
struct Compacted {
  static constexpr int kSize = 256;
  int n{0};
  float x[kSize + kLanes], y[kSize + kLanes], z[kSize + kLanes];
  float normal_x[kSize + kLanes], normal_y[kSize + kLanes], normal_z[kSize + kLanes];
  std::int32_t shift[kSize + kLanes];
};

// The points of the block at @p i that @p mask says.
void Append(const ScorePoints& points, int i, hn::Mask<D> mask, Compacted* compacted) {
  Compacted& c = *compacted;
  const KeptLanes<D> kept(D(), mask);
  kept.Copy(points.x.data() + i, c.x + c.n);
  kept.Copy(points.y.data() + i, c.y + c.n);
  kept.Copy(points.z.data() + i, c.z + c.n);
  kept.Copy(points.normal_x.data() + i, c.normal_x + c.n);
  kept.Copy(points.normal_y.data() + i, c.normal_y + c.n);
  kept.Copy(points.normal_z.data() + i, c.normal_z + c.n);
  kept.Copy(points.shift.data() + i, c.shift + c.n);
  c.n += kept.count();
}

// The sum over the points and all rings.
VI SumCompacted(const KernelEye& eye, const ScoreView& map, const Compacted& points,
                const ScoreRings& rings) {
  const D d;
  const DI di;
  const int width = static_cast<int>(hn::Lanes(d));
  const VI byte = hn::Set(di, 255), middle = hn::Set(di, kScoreZero);
  const VI limit = hn::Set(di, kScoreLimit), least = hn::Set(di, -kScoreLimit);
  VI sum = hn::Zero(di);
  for (int i = 0; i < points.n; i += width) {
    const auto load = [&](const float* column) { return hn::LoadU(d, column + i); };
    const Place p = InEye(eye, load(points.x), load(points.y), load(points.z));
    const Place n =
        Turned(eye.R, load(points.normal_x), load(points.normal_y), load(points.normal_z));
    const VI shift = hn::LoadU(di, points.shift + i);
    const auto counts = hn::Lt(hn::Iota(di, i), hn::Set(di, points.n));
    for (int k = 0; k < rings.n; ++k) {
      const V beyond = hn::Set(d, rings.beyond_m[k]);
      const V x = hn::Add(p.x, hn::Mul(beyond, n.x)), y = hn::Add(p.y, hn::Mul(beyond, n.y));
      const V z = hn::Max(hn::Add(p.z, hn::Mul(beyond, n.z)), hn::Set(d, 0.05f));
      const V iz = hn::Div(hn::Set(d, 1.0f), z);
      const V u = hn::Add(hn::Mul(hn::Mul(x, hn::Set(d, eye.fx)), iz), hn::Set(d, eye.cx));
      const V v = hn::Add(hn::Mul(hn::Mul(y, hn::Set(d, eye.fy)), iz), hn::Set(d, eye.cy));
      const VI score = hn::Sub(hn::And(hn::Shr(Fetch(map, u, v), shift), byte), middle);
      sum = hn::Add(sum, hn::IfThenElseZero(counts, hn::Min(hn::Max(score, least), limit)));
    }
  }
  return sum;
}

ScoreSum SumScoresTarget(const KernelEye& eye, const ScoreView& map, const ScorePoints& points,
                         const ScoreRings& rings, float lowest) {
  const D d;
  const DI di;
  const int width = static_cast<int>(hn::Lanes(d)), n = points.size();
  const V zero = hn::Zero(d), low = hn::Set(d, lowest);
  Compacted compacted;
  VI sum = hn::Zero(di);
  int count = 0;
  const auto flush = [&] {
    // What is left of earlier points behind the last one is finite and does not count.
    for (float* column : {compacted.x, compacted.y, compacted.z, compacted.normal_x,
                          compacted.normal_y, compacted.normal_z}) {
      std::fill_n(column + compacted.n, kLanes, 0.0f);
    }
    std::fill_n(compacted.shift + compacted.n, kLanes, 0);
    sum = hn::Add(sum, SumCompacted(eye, map, compacted, rings));
    count += compacted.n;
    compacted.n = 0;
  };
  for (int i = 0; i < n; i += width) {
    const V facing = FacingAt(eye, points, i);
    const auto mask = hn::And(hn::Lt(facing, zero), hn::Gt(facing, low));
    if (hn::AllFalse(d, mask)) continue;
    Append(points, i, mask, &compacted);
    if (compacted.n > Compacted::kSize - kLanes) flush();
  }
  flush();
  return {hn::GetLane(hn::SumOfLanes(di, sum)), rings.n * count};
}

int FindNearOutlineTarget(const KernelEye& eye, const OutlineVertices& vertices, float* facing,
                          std::int32_t* near) {
  const D d;
  const int width = static_cast<int>(hn::Lanes(d)), n = static_cast<int>(vertices.reach.size());
  const V distance = hn::Set(d, eye.distance);
  int found = 0;
  for (int i = 0; i < n; i += width) {
    const V value = FacingAt(eye, vertices, i);
    hn::StoreU(value, d, facing + i);
    const V reach =
        hn::Add(Load(vertices.reach, i), hn::Mul(Load(vertices.reach_a_m, i), distance));
    const KeptLanes<D> kept(d, hn::Le(hn::Abs(value), reach));
    std::int32_t numbers[kLanes];
    hn::StoreU(hn::Iota(DI(), i), DI(), numbers);
    kept.Copy(numbers, near + found);
    found += kept.count();
  }
  return found;
}

void PlaceCrossingsTarget(const KernelEye& eye, const float middle[2], int num_directions,
                          Crossings* c) {
  const D d;
  const DI di;
  const int width = static_cast<int>(hn::Lanes(d));
  const V one = hn::Set(d, 1.0f), zero = hn::Zero(d);
  for (int i = 0; i < c->n; i += width) {
    const V a = Load(c->facing_a, i), b = Load(c->facing_b, i);
    const V t = hn::Div(a, hn::Sub(a, b)), s = hn::Sub(one, t);
    const auto blend = [&](const Crossings::Column& from, const Crossings::Column& to) {
      return hn::Add(hn::Mul(s, Load(from, i)), hn::Mul(t, Load(to, i)));
    };
    const V x = blend(c->ax, c->bx), y = blend(c->ay, c->by), z = blend(c->az, c->bz);
    const Place p = InEye(eye, x, y, z);
    const V inverse_z = hn::Div(one, p.z);
    const V du = hn::Sub(hn::Mul(p.x, inverse_z), hn::Set(d, middle[0]));
    const V dv = hn::Sub(hn::Mul(p.y, inverse_z), hn::Set(d, middle[1]));
    // atan(q) / 2 pi of q = 0 ... 1 to 2e-6.
    const V across = hn::Abs(du), down = hn::Abs(dv);
    const V q = hn::Div(hn::Min(across, down), hn::Max(hn::Max(across, down), hn::Set(d, 1e-9f)));
    const V q2 = hn::Mul(q, q);
    V turn = hn::Set(d, 0.00331601f);
    for (const float coefficient : {-0.01354934f, 0.02867033f, -0.05256880f, 0.15913362f}) {
      turn = hn::Add(hn::Mul(turn, q2), hn::Set(d, coefficient));
    }
    turn = hn::Mul(turn, q);
    turn = hn::IfThenElse(hn::Gt(down, across), hn::Sub(hn::Set(d, 0.25f), turn), turn);
    turn = hn::IfThenElse(hn::Lt(du, zero), hn::Sub(hn::Set(d, 0.5f), turn), turn);
    turn = hn::IfThenElse(hn::Lt(dv, zero), hn::Neg(turn), turn);
    const V scaled =
        hn::Mul(hn::Add(turn, hn::Set(d, 0.5f)), hn::Set(d, static_cast<float>(num_directions)));
    const V last = hn::Set(d, static_cast<float>(num_directions - 1));
    hn::StoreU(hn::ConvertTo(di, hn::Min(hn::Max(scaled, zero), last)), di, c->bin.data() + i);
    hn::StoreU(x, d, c->x.data() + i);
    hn::StoreU(y, d, c->y.data() + i);
    hn::StoreU(z, d, c->z.data() + i);
    hn::StoreU(hn::Add(hn::Mul(du, du), hn::Mul(dv, dv)), d, c->distance.data() + i);
  }
}

constexpr int kPixelLimit = 40;       ///< of one pixel's score: none decides alone
constexpr float kMinVariance = 0.5f;  ///< [px^2]
constexpr float kVagueShare = 0.28f;  ///< of reach^2: a posterior as wide says nothing
constexpr float kRobust_px2 = 9;

struct Posterior {
  V mean, variance;
  hn::Mask<DI> known;
};

// The boundary lies between two pixels of the normal; how likely, the sum of scores up to there
// tells, of which neighbours are not independent.
Posterior Locate(const ScoreView& map, V u, V v, V nu, V nv, VI edge, int reach,
                 const float* likelihoods) {
  const D d;
  const DI di;
  VI sums[2 * kMaxContourReach + 1];
  const int n_pixels = 2 * reach + 1;
  const VI byte = hn::Set(di, 255), limit = hn::Set(di, kPixelLimit),
           least = hn::Set(di, -kPixelLimit), middle = hn::Set(di, kScoreZero);
  const auto is_hair = hn::Eq(edge, hn::Set(di, static_cast<std::int32_t>(Edge::kHair)));
  const auto is_skin = hn::Eq(edge, hn::Set(di, static_cast<std::int32_t>(Edge::kSkin)));
  VI sum = hn::Zero(di), best = hn::Set(di, -1'000'000);
  auto known = hn::Eq(edge, edge);
  for (int k = 0; k < n_pixels; ++k) {
    const V s = hn::Set(d, static_cast<float>(k - reach));
    const VI fetched = Fetch(map, hn::Add(u, hn::Mul(s, nu)), hn::Add(v, hn::Mul(s, nv)));
    known = hn::And(known, hn::Lt(fetched, hn::Zero(di)));  // the highest byte is 255
    const VI hair = hn::And(fetched, byte), skin = hn::And(hn::ShiftRight<8>(fetched), byte);
    const VI inside = hn::IfThenElse(is_skin, skin, hair);
    const VI outside = hn::IfThenElse(hn::Or(is_hair, is_skin), middle, skin);
    sum = hn::Add(sum, hn::Min(hn::Max(hn::Sub(inside, outside), least), limit));
    sums[k] = sum;
    if (k < n_pixels - 1) best = hn::Max(best, sum);
  }
  V total = hn::Zero(d), first = total, second = total;
  for (int k = 0; k < n_pixels - 1; ++k) {
    const V p = LookUp(d, likelihoods, hn::Sub(best, sums[k]));
    const V at = hn::Set(d, static_cast<float>(k - reach) + 0.5f), moment = hn::Mul(p, at);
    total = hn::Add(total, p);
    first = hn::Add(first, moment);
    second = hn::Add(second, hn::Mul(moment, at));
  }
  const V mean = hn::Div(first, total);
  return {mean, hn::Sub(hn::Div(second, total), hn::Mul(mean, mean)), known};
}

void MeasureContoursTarget(const KernelEye& eye, const ScoreView& map, const ContourPoints& points,
                           int reach, const float* likelihoods, EquationRows* rows) {
  const D d;
  const DI di;
  const int width = static_cast<int>(hn::Lanes(d));
  const V one = hn::Set(d, 1.0f), fx = hn::Set(d, eye.fx), fy = hn::Set(d, eye.fy);
  rows->n = points.n;
  for (int i = 0; i < points.n; i += width) {
    const V x = Load(points.x, i), y = Load(points.y, i), z = Load(points.z, i);
    const Place p = InEye(eye, x, y, z);
    const Place n =
        Turned(eye.R, Load(points.normal_x, i), Load(points.normal_y, i), Load(points.normal_z, i));
    const V iz = hn::Div(one, hn::Max(p.z, hn::Set(d, 0.1f)));
    const V a = hn::Mul(p.x, iz), b = hn::Mul(p.y, iz);
    V nu = hn::Mul(fx, hn::Sub(n.x, hn::Mul(a, n.z)));
    V nv = hn::Mul(fy, hn::Sub(n.y, hn::Mul(b, n.z)));
    const V length = hn::Sqrt(hn::Add(hn::Mul(nu, nu), hn::Mul(nv, nv)));
    auto valid = hn::And(hn::Gt(p.z, hn::Set(d, 0.1f)), hn::Gt(length, hn::Set(d, 1e-6f)));
    nu = hn::Div(nu, length);
    nv = hn::Div(nv, length);
    const V u = hn::Add(hn::Set(d, eye.cx), hn::Mul(fx, a));
    const V v = hn::Add(hn::Set(d, eye.cy), hn::Mul(fy, b));
    const Posterior found =
        Locate(map, u, v, nu, nv, hn::LoadU(di, points.edge.data() + i), reach, likelihoods);
    const V vague = hn::Set(d, kVagueShare * static_cast<float>(reach * reach));
    valid = hn::And(valid, hn::Le(found.variance, vague));
    valid = hn::And(valid, hn::RebindMask(d, found.known));
    const auto store = [&](EquationRows::Column* column, V value) {
      hn::StoreU(hn::IfThenElseZero(valid, value), d, column->data() + i);
    };
    const V su = hn::Mul(hn::Mul(nu, fx), iz), sv = hn::Mul(hn::Mul(nv, fy), iz);
    const Place slope = Turned(eye.R_CE, su, sv, hn::Neg(hn::Add(hn::Mul(su, a), hn::Mul(sv, b))));
    const Place arm = Turned(eye.R_CM, x, y, z);
    store(&rows->slope_x, slope.x);
    store(&rows->slope_y, slope.y);
    store(&rows->slope_z, slope.z);
    store(&rows->arm_x, arm.x);
    store(&rows->arm_y, arm.y);
    store(&rows->arm_z, arm.z);
    store(&rows->residual, found.mean);
    const V robust =
        hn::Add(one, hn::Mul(hn::Mul(found.mean, found.mean), hn::Set(d, 1 / kRobust_px2)));
    const V spread = hn::Mul(hn::Add(found.variance, hn::Set(d, kMinVariance)), robust);
    store(&rows->weight, hn::Div(Load(points.weight, i), spread));
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace visavis
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace visavis {

HWY_EXPORT(SumScoresTarget);
HWY_EXPORT(FindNearOutlineTarget);
HWY_EXPORT(PlaceCrossingsTarget);
HWY_EXPORT(MeasureContoursTarget);

ScoreSum SumScores(const KernelEye& eye, const ScoreView& map, const ScorePoints& points,
                   const ScoreRings& rings, float lowest) {
  return HWY_DYNAMIC_DISPATCH(SumScoresTarget)(eye, map, points, rings, lowest);
}

int FindNearOutline(const KernelEye& eye, const OutlineVertices& vertices, float* facing,
                    std::int32_t* near) {
  return HWY_DYNAMIC_DISPATCH(FindNearOutlineTarget)(eye, vertices, facing, near);
}

void PlaceCrossings(const KernelEye& eye, const float middle[2], int num_directions,
                    Crossings* crossings) {
  HWY_DYNAMIC_DISPATCH(PlaceCrossingsTarget)(eye, middle, num_directions, crossings);
}

void MeasureContours(const KernelEye& eye, const ScoreView& map, const ContourPoints& points,
                     int reach_px, const std::vector<float>& likelihoods, EquationRows* rows) {
  HWY_DYNAMIC_DISPATCH(MeasureContoursTarget)
  (eye, map, points, reach_px, likelihoods.data(), rows);
}

}  // namespace visavis
#endif
