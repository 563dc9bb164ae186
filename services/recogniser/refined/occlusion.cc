#include "services/recogniser/refined/occlusion.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace visavis {
namespace {

constexpr int kColumns = 6, kRows = 7;
constexpr float kLeft_m = -0.06f, kTop_m = -0.04f, kPatch_m = 0.02f;
constexpr float kNoise = 0.5f;        ///< [levels]
constexpr float kUsualShare = 0.45f;  ///< usual deviation, in units of the whole face's contrast
constexpr float kUnusual = 2;         ///< times that: something is wrong
constexpr float kSure = 0.8f, kLikely = 0.5f;  ///< correlation of a patch
constexpr float kLeastSure = 0.1f;             ///< of the points
constexpr int kFewest = 8;                     ///< points that a patch is judged by
constexpr double kMostHidden = 0.85;

int PatchOf(const Eigen::Vector3f& p) {
  const int column = std::clamp(static_cast<int>((p.x() - kLeft_m) / kPatch_m), 0, kColumns - 1);
  const int row = std::clamp(static_cast<int>((p.y() - kTop_m) / kPatch_m), 0, kRows - 1);
  return row * kColumns + column;
}

/// Pattern x against picture y over a patch.
struct Patch {
  int count{0};
  float x{0}, y{0}, xx{0}, xy{0}, yy{0};

  float var_x() const { return xx - x * x / static_cast<float>(count); }
  float var_y() const { return yy - y * y / static_cast<float>(count); }
  float cov() const { return xy - x * y / static_cast<float>(count); }
  float correlation() const { return cov() / std::sqrt(var_x() * var_y() + 1e-6f); }
  /// Mean square of what @p gain times the pattern and a brightness of its own leave unexplained.
  float Unexplained(float gain) const {
    return (var_y() - 2 * gain * cov() + gain * gain * var_x()) / static_cast<float>(count);
  }
};

}  // namespace

double HideOccluded(const FaceTexture& texture, Band band, FaceSamples* samples) {
  const std::vector<float>& pattern = texture.pattern(band);
  const std::vector<Eigen::Vector3f>& points = texture.points().points;
  std::array<Patch, kColumns * kRows> patches{};
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!samples->seen[i] || !texture.known(band)[i]) continue;
    Patch& patch = patches[static_cast<std::size_t>(PatchOf(points[i]))];
    const float x = pattern[i], y = samples->value[i];
    patch.x += x;
    patch.y += y;
    patch.xx += x * x;
    patch.xy += x * y;
    patch.yy += y * y;
    ++patch.count;
  }
  // What certainly shows the face tells the light.
  Patch sure, all;
  for (const Patch& patch : patches) {
    if (patch.count < kFewest) continue;
    all.count += patch.count;
    all.xx += patch.var_x();
    if (patch.correlation() < kSure) continue;
    sure.count += patch.count;
    sure.xx += patch.var_x();
    sure.xy += patch.cov();
  }
  if (static_cast<float>(sure.count) < kLeastSure * static_cast<float>(all.count) || !(sure.xy > 0))
    return 0;
  const float gain = sure.xy / sure.xx;
  const float usual =
      kUsualShare * gain * std::sqrt(all.xx / static_cast<float>(all.count)) + kNoise;
  std::array<bool, kColumns * kRows> hidden{};
  int num_hidden = 0;
  for (std::size_t k = 0; k < patches.size(); ++k) {
    const Patch& patch = patches[k];
    if (patch.count < kFewest || patch.correlation() > kLikely) continue;
    const float contrast = gain * gain * patch.var_x() / static_cast<float>(patch.count);
    const float unexplained = patch.Unexplained(gain);
    hidden[k] = unexplained > contrast && unexplained > usual * usual;
    if (hidden[k]) num_hidden += patch.count;
  }
  if (num_hidden == 0 || num_hidden > kMostHidden * all.count) return 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (hidden[static_cast<std::size_t>(PatchOf(points[i]))]) samples->seen[i] = 0;
  }
  return static_cast<double>(num_hidden) / all.count;
}

}  // namespace visavis
