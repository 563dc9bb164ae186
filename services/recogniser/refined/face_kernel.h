#pragma once

#include <cstdint>
#include <vector>

#include "services/recogniser/refined/equation_kernel.h"
#include "services/recogniser/refined/kernel_types.h"

namespace visavis {

/// One band of a picture: samples in units of kBandUnit, each packed with its right neighbour:
/// the lower 16 bits are the sample, the upper ones the neighbour; both signed.
struct BandView {
  const std::int32_t* pairs;  ///< row by row
  int width, height;          ///< [samples]
  float x0, y0;               ///< [px] of the picture where the first sample begins
  float scale;                ///< samples a px
};
inline constexpr int kBandSteps = 64;
inline constexpr float kBandUnit = 1.0f / kBandSteps;  ///< [levels]

/// The generic pattern's points in M [m], padded with points that are turned away from every eye.
struct PatternPoints : SurfacePoints {
  std::vector<std::int32_t> value;  ///< of the pattern, -127 to 127

  void Add(const Eigen::Vector3f& p, const Eigen::Vector3f& n, float n_dot_p_m, int pattern);
  void Pad();
};

/// Sums for the correlation of a pattern (x) with a band (y, clamped to +-kLargestBandStep).
struct PatternSums {
  std::int32_t n{0}, x{0}, y{0}, xx{0}, xy{0}, yy{0};

  double correlation() const;  ///< -1 to 1
};
inline constexpr int kLargestBandStep = 1000;
/// So many squares of kLargestBandStep fit into 32 bits.
inline constexpr int kMostPatternPoints = 2000;

/// Sums over the points whose n.(p - p_ME) [m] is at most @p highest, at the samples nearest to
/// them. Exact integers.
PatternSums SumPattern(const KernelEye& eye, const BandView& band, const PatternPoints& points,
                       float highest);

/// Sums for the correlation of what the right eye shows at the points (x) with what the left one
/// does (y), over those that count for both. Exact integers.
PatternSums SumAgreement(const KernelEye eyes[2], const BandView bands[2],
                         const PatternPoints& points, const float highest[2]);

/// Arrays of n points: coordinates one point after the other, in M [m].
struct FaceArrays {
  const float *points, *normals;
  std::size_t n;
};
/// What an eye shows at n points; see FaceSamples.
struct SampleArrays {
  float *value, *facing, *slope;  ///< slope: three a point
  unsigned char* seen;
};
/// Value 0, facing 0 and slope 0 where a point is not seen.
void SamplePoints(const KernelEye& eye, const BandView& band, const FaceArrays& face,
                  float min_facing, const SampleArrays& samples);

/// Two series and which points of them count: both flags set, both cosines large enough.
struct PairedSeries {
  const float *x, *y;
  const unsigned char *x_flags, *y_flags;
  const float *x_facing, *y_facing;
  float min_facing;
  std::size_t n;
};
/// Sums over those points in single precision, lane by lane: equal on every SIMD target.
struct PairSums {
  double n{0}, x{0}, y{0}, xx{0}, xy{0}, yy{0};

  double var_x() const { return xx - x * x / n; }
  double var_y() const { return yy - y * y / n; }
  double cov() const { return xy - x * y / n; }
};
PairSums SumPairs(const PairedSeries& series);

/// Adds the equations that gain x + offset = y wants, of weight scale / (1 + robust residual^2),
/// over the points that count, with slopes y_slope - gain x_slope (null: 0; three a point).
struct PairEquations {
  float gain, offset, scale, robust;
  const float *x_slope, *y_slope;
  const float* points;  ///< in M, three a point
  const Eigen::Matrix3f* R_CM;
};
void AddPairs(const PairedSeries& series, const PairEquations& wanted, PoseEquations* equations);

}  // namespace visavis
