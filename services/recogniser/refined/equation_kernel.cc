#include "services/recogniser/refined/equation_kernel.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "services/recogniser/refined/equation_kernel.cc"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace visavis {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
namespace {

// No MulAdd: it fuses on some targets and not on others.
void SumRowsTarget(const EquationRows& rows, float lanes[][kLanes]) {
  const hn::CappedTag<float, kLanes> d;
  using V = hn::Vec<decltype(d)>;
  const int width = static_cast<int>(hn::Lanes(d));
  for (int phase = 0; phase < kLanes; phase += width) {
    V h00 = hn::LoadU(d, lanes[0] + phase), h10 = hn::LoadU(d, lanes[1] + phase);
    V h20 = hn::LoadU(d, lanes[2] + phase), h30 = hn::LoadU(d, lanes[3] + phase);
    V h40 = hn::LoadU(d, lanes[4] + phase), h50 = hn::LoadU(d, lanes[5] + phase);
    V h11 = hn::LoadU(d, lanes[6] + phase), h21 = hn::LoadU(d, lanes[7] + phase);
    V h31 = hn::LoadU(d, lanes[8] + phase), h41 = hn::LoadU(d, lanes[9] + phase);
    V h51 = hn::LoadU(d, lanes[10] + phase), h22 = hn::LoadU(d, lanes[11] + phase);
    V h32 = hn::LoadU(d, lanes[12] + phase), h42 = hn::LoadU(d, lanes[13] + phase);
    V h52 = hn::LoadU(d, lanes[14] + phase), h33 = hn::LoadU(d, lanes[15] + phase);
    V h43 = hn::LoadU(d, lanes[16] + phase), h53 = hn::LoadU(d, lanes[17] + phase);
    V h44 = hn::LoadU(d, lanes[18] + phase), h54 = hn::LoadU(d, lanes[19] + phase);
    V h55 = hn::LoadU(d, lanes[20] + phase), g0 = hn::LoadU(d, lanes[21] + phase);
    V g1 = hn::LoadU(d, lanes[22] + phase), g2 = hn::LoadU(d, lanes[23] + phase);
    V g3 = hn::LoadU(d, lanes[24] + phase), g4 = hn::LoadU(d, lanes[25] + phase);
    V g5 = hn::LoadU(d, lanes[26] + phase);
    const auto add = [](V* sum, V a, V b) { *sum = hn::Add(*sum, hn::Mul(a, b)); };
    for (int i = phase; i < rows.n; i += kLanes) {
      const auto load = [&](const EquationRows::Column& c) { return hn::LoadU(d, c.data() + i); };
      const V j0 = load(rows.slope_x), j1 = load(rows.slope_y), j2 = load(rows.slope_z);
      const V ax = load(rows.arm_x), ay = load(rows.arm_y), az = load(rows.arm_z);
      const V w = load(rows.weight), r = load(rows.residual);
      const V j3 = hn::Sub(hn::Mul(ay, j2), hn::Mul(az, j1));  // arm x slope
      const V j4 = hn::Sub(hn::Mul(az, j0), hn::Mul(ax, j2));
      const V j5 = hn::Sub(hn::Mul(ax, j1), hn::Mul(ay, j0));
      const V w0 = hn::Mul(w, j0), w1 = hn::Mul(w, j1), w2 = hn::Mul(w, j2);
      const V w3 = hn::Mul(w, j3), w4 = hn::Mul(w, j4), w5 = hn::Mul(w, j5);
      add(&h00, w0, j0), add(&h10, w0, j1), add(&h20, w0, j2);
      add(&h30, w0, j3), add(&h40, w0, j4), add(&h50, w0, j5);
      add(&h11, w1, j1), add(&h21, w1, j2), add(&h31, w1, j3);
      add(&h41, w1, j4), add(&h51, w1, j5), add(&h22, w2, j2);
      add(&h32, w2, j3), add(&h42, w2, j4), add(&h52, w2, j5);
      add(&h33, w3, j3), add(&h43, w3, j4), add(&h53, w3, j5);
      add(&h44, w4, j4), add(&h54, w4, j5), add(&h55, w5, j5);
      add(&g0, w0, r), add(&g1, w1, r), add(&g2, w2, r);
      add(&g3, w3, r), add(&g4, w4, r), add(&g5, w5, r);
    }
    const V sums[EquationSums::kTerms] = {h00, h10, h20, h30, h40, h50, h11, h21, h31,
                                          h41, h51, h22, h32, h42, h52, h33, h43, h53,
                                          h44, h54, h55, g0,  g1,  g2,  g3,  g4,  g5};
    for (int k = 0; k < EquationSums::kTerms; ++k) hn::StoreU(sums[k], d, lanes[k] + phase);
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace visavis
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace visavis {

HWY_EXPORT(SumRowsTarget);

void EquationSums::Add(const EquationRows& rows) {
  HWY_DYNAMIC_DISPATCH(SumRowsTarget)(rows, lanes_);
}

void EquationSums::AddTo(PoseEquations* equations) const {
  int term = 0;
  const auto next = [&] {
    double sum = 0;
    for (const float lane : lanes_[term]) sum += static_cast<double>(lane);
    ++term;
    return sum;
  };
  for (int column = 0; column < 6; ++column) {
    for (int row = column; row < 6; ++row) equations->H(row, column) += next();
  }
  for (int row = 0; row < 6; ++row) equations->g[row] += next();
}

}  // namespace visavis
#endif
