#include "services/recogniser/refined/appearance.h"

#include <cmath>

namespace visavis {
namespace {

using Eigen::Vector3f;

constexpr int kFewest = 40;             ///< points that a gain is fitted to
constexpr double kFaintContrast = 0.3;  ///< [levels] below which the pattern is not seen at all
constexpr double kFlat = 1e-4;          ///< contrast of a pattern that is none
constexpr float kNoise = 0.5f;          ///< [levels]
// Cosine below which the eyes' pictures of a point are not compared. The surroundings that blur
// into the points near the outline lie at another depth and pull z: by 3 mm at 0.3, by less than
// 0.8 mm at 0.7.
constexpr float kStereoFacing = 0.7f;

struct Moments {
  int n{0};
  double x{0}, y{0}, xx{0}, xy{0}, yy{0};
  void Add(double a, double b) {
    ++n;
    x += a;
    y += b;
    xx += a * a;
    xy += a * b;
    yy += b * b;
  }
  double var_x() const { return xx - x * x / n; }
  double var_y() const { return yy - y * y / n; }
  double cov() const { return xy - x * y / n; }
};

}  // namespace

void SampleFace(const FacePoints& face, const EyeView& eye, const EyePose& pose, Band band,
                float min_facing, FaceSamples* samples) {
  const EyeGeometry& g = *eye.geometry;
  const Eigen::Matrix3f R_CE = g.R_EC.transpose();
  samples->Hold(face.size());
  for (std::size_t i = 0; i < face.size(); ++i) {
    samples->seen[i] = 0;
    const Vector3f view = face.points[i] - pose.p_ME;
    const float facing = -face.normals[i].dot(view);
    if (facing <= 0 || facing * facing < min_facing * min_facing * view.squaredNorm()) continue;
    const Vector3f p = pose.InEye(face.points[i]);
    if (p.z() < 0.1f) continue;
    const float iz = 1 / p.z(), x = p.x() * iz, y = p.y() * iz;
    BandImages::Sample s;
    if (!eye.bands->At(band, g.cx + g.fx * x, g.cy + g.fy * y, &s)) continue;
    const float du = s.du * g.fx * iz, dv = s.dv * g.fy * iz;
    samples->value[i] = s.value;
    samples->facing[i] = facing / view.norm();
    samples->slope[i] = R_CE * Vector3f(du, dv, -(du * x + dv * y));
    samples->seen[i] = 1;
  }
}

GainOffset FitPattern(const FaceSamples& samples, const std::vector<float>& pattern,
                      const std::vector<unsigned char>& usable) {
  Moments m;
  for (std::size_t i = 0; i < pattern.size(); ++i) {
    if (samples.seen[i] && usable[i]) {
      m.Add(static_cast<double>(pattern[i]), static_cast<double>(samples.value[i]));
    }
  }
  GainOffset fit;
  fit.count = m.n;
  if (m.n < kFewest) return fit;
  fit.pattern_rms = std::sqrt(m.var_x() / m.n);
  fit.gain = m.cov() / (m.var_x() + 1e-12);
  fit.offset = (m.y - fit.gain * m.x) / m.n;
  fit.correlation = m.cov() / std::sqrt(m.var_x() * m.var_y() + 1e-12);
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
  const auto g = static_cast<float>(gain), o = static_cast<float>(fit.offset);
  const float sigma = relative_sigma * static_cast<float>(gain * fit.pattern_rms) + kNoise;
  const float scale = weight / (sigma * sigma), robust = 1 / (4 * sigma * sigma);
  for (std::size_t i = 0; i < face.size(); ++i) {
    if (!samples.seen[i] || !usable[i]) continue;
    const float residual = g * pattern[i] + o - samples.value[i];
    equations->Add(samples.slope[i], R_CM * face.points[i], residual,
                   scale / (1 + residual * residual * robust));
  }
  return fit;
}

double AddStereo(const FacePoints& face, const FaceSamples& right, const FaceSamples& left,
                 const Eigen::Matrix3f& R_CM, float relative_sigma, float weight,
                 PoseEquations* equations) {
  const auto faces_both = [&](std::size_t i) {
    return right.facing[i] >= kStereoFacing && left.facing[i] >= kStereoFacing;
  };
  Moments all, m;
  for (std::size_t i = 0; i < face.size(); ++i) {
    if (!right.seen[i] || !left.seen[i]) continue;
    const auto l = static_cast<double>(left.value[i]), r = static_cast<double>(right.value[i]);
    all.Add(l, r);
    if (faces_both(i)) m.Add(l, r);
  }
  if (all.n < kFewest) return 0;
  const double correlation = all.cov() / std::sqrt(all.var_x() * all.var_y() + 1e-12);
  if (m.n < kFewest) return correlation;
  // left * ratio + offset as the right eye sees it; the ratio from the contrasts, which noise
  // raises alike on both sides.
  const double ratio = std::sqrt((m.var_y() + 1e-9) / (m.var_x() + 1e-9));
  const auto r = static_cast<float>(ratio);
  const auto o = static_cast<float>((m.y - ratio * m.x) / m.n);
  const float contrast = static_cast<float>(std::sqrt(m.var_y() / m.n));
  const float sigma = relative_sigma * contrast + kNoise;
  const float scale = weight / (sigma * sigma), robust = 1 / (4 * sigma * sigma);
  for (std::size_t i = 0; i < face.size(); ++i) {
    if (!right.seen[i] || !left.seen[i] || !faces_both(i)) continue;
    const float residual = r * left.value[i] + o - right.value[i];
    equations->Add(right.slope[i] - r * left.slope[i], R_CM * face.points[i], residual,
                   scale / (1 + residual * residual * robust));
  }
  return correlation;
}

}  // namespace visavis
