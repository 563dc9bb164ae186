#include "services/recogniser/refined/appearance.h"

#include <algorithm>
#include <cmath>

#include "services/recogniser/refined/face_kernel.h"

namespace visavis {
namespace {

constexpr int kFewest = 40;             ///< points that a gain is fitted to
constexpr double kFaintContrast = 0.3;  ///< [levels] below which the pattern is not seen at all
constexpr double kFlat = 1e-4;          ///< contrast of a pattern that is none
constexpr float kNoise = 0.5f;          ///< [levels]
// Cosine below which the eyes' pictures of a point are not compared. The surroundings that blur
// into the points near the outline lie at another depth and pull z: by 3 mm at 0.3, by less than
// 0.8 mm at 0.7.
constexpr float kStereoFacing = 0.7f;
constexpr float kAnyFacing = -2;

/// The first @p n of @p x and @p y where both are seen and turned to their eyes by @p min_facing.
PairedSeries Series(const std::vector<float>& x, const std::vector<unsigned char>& x_flags,
                    const std::vector<float>& x_facing, const FaceSamples& y, float min_facing,
                    std::size_t n) {
  return {x.data(),        y.value.data(),  x_flags.data(), y.seen.data(),
          x_facing.data(), y.facing.data(), min_facing,     n};
}

}  // namespace

void SampleFace(const FacePoints& face, const EyeView& eye, const EyePose& pose, Band band,
                float min_facing, FaceSamples* samples) {
  if (face.size() == 0) return;
  samples->Hold(face.size());
  SamplePoints(KernelEye(*eye.geometry, pose), eye.bands->view(band),
               {face.points.data()->data(), face.normals.data()->data(), face.size()}, min_facing,
               {samples->value.data(), samples->facing.data(), samples->slope.data()->data(),
                samples->seen.data()});
}

GainOffset FitPattern(const FaceSamples& samples, const std::vector<float>& pattern,
                      const std::vector<unsigned char>& usable) {
  const PairSums m =
      SumPairs(Series(pattern, usable, samples.facing, samples, kAnyFacing, pattern.size()));
  GainOffset fit;
  fit.count = static_cast<int>(m.n);
  if (fit.count < kFewest) return fit;
  fit.pattern_rms = std::sqrt(std::max(m.var_x(), 0.0) / m.n);
  fit.gain = m.cov() / (m.var_x() + 1e-12);
  fit.offset = (m.y - fit.gain * m.x) / m.n;
  fit.correlation = m.cov() / std::sqrt(std::max(m.var_x() * m.var_y(), 0.0) + 1e-12);
  return fit;
}

GainOffset AddPattern(const FacePoints& face, const FaceSamples& samples,
                      const Eigen::Matrix3f& R_CM, const std::vector<float>& pattern,
                      const std::vector<unsigned char>& usable, float relative_sigma, float weight,
                      PoseEquations* equations) {
  const GainOffset fit = FitPattern(samples, pattern, usable);
  if (fit.count < kFewest) return fit;
  if (!(fit.pattern_rms > kFlat)) return fit;  // nothing to tell places by
  double gain = fit.gain;
  if (gain * fit.pattern_rms < kFaintContrast) {
    // Not recognised yet: expected with a modest contrast, never upside down.
    gain = 0.5 / fit.pattern_rms;
  }
  const float sigma = relative_sigma * static_cast<float>(gain * fit.pattern_rms) + kNoise;
  AddPairs(Series(pattern, usable, samples.facing, samples, kAnyFacing, pattern.size()),
           {static_cast<float>(gain), static_cast<float>(fit.offset), weight / (sigma * sigma),
            1 / (4 * sigma * sigma), nullptr, samples.slope.data()->data(),
            face.points.data()->data(), &R_CM},
           equations);
  return fit;
}

double StereoCorrelation(const FaceSamples& right, const FaceSamples& left, std::size_t size) {
  const PairSums all =
      SumPairs(Series(left.value, left.seen, left.facing, right, kAnyFacing, size));
  if (all.n < kFewest) return 0;
  return all.cov() / std::sqrt(std::max(all.var_x() * all.var_y(), 0.0) + 1e-12);
}

GainOffset FitEyes(const FaceSamples& right, const FaceSamples& left, std::size_t size) {
  const PairSums m =
      SumPairs(Series(left.value, left.seen, left.facing, right, kStereoFacing, size));
  GainOffset fit;
  fit.count = static_cast<int>(m.n);
  if (fit.count < kFewest) return fit;
  const double var_x = std::max(m.var_x(), 0.0), var_y = std::max(m.var_y(), 0.0);
  fit.gain = std::sqrt((var_y + 1e-9) / (var_x + 1e-9));
  fit.offset = (m.y - fit.gain * m.x) / m.n;
  fit.pattern_rms = std::sqrt(var_y / m.n);
  return fit;
}

void AddStereo(const FacePoints& face, const FaceSamples& right, const FaceSamples& left,
               const Eigen::Matrix3f& R_CM, float relative_sigma, float weight,
               PoseEquations* equations) {
  const GainOffset fit = FitEyes(right, left, face.size());
  if (fit.count < kFewest) return;
  const float sigma = relative_sigma * static_cast<float>(fit.pattern_rms) + kNoise;
  AddPairs(Series(left.value, left.seen, left.facing, right, kStereoFacing, face.size()),
           {static_cast<float>(fit.gain), static_cast<float>(fit.offset), weight / (sigma * sigma),
            1 / (4 * sigma * sigma), left.slope.data()->data(), right.slope.data()->data(),
            face.points.data()->data(), &R_CM},
           equations);
}

}  // namespace visavis
