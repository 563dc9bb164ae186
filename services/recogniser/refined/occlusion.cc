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
constexpr float kCertain = 0.85f;              ///< likewise: beside something that hides the face
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

using Patches = std::array<Patch, kColumns * kRows>;
using Marks = std::array<bool, kColumns * kRows>;  ///< of patches

Patches PatchesOf(const FaceTexture& texture, Band band, const FaceSamples& samples) {
  const std::vector<float>& pattern = texture.pattern(band);
  const std::vector<Eigen::Vector3f>& points = texture.points().points;
  Patches patches{};
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!samples.seen[i] || !texture.known(band)[i]) continue;
    Patch& patch = patches[static_cast<std::size_t>(PatchOf(points[i]))];
    const float x = pattern[i], y = samples.value[i];
    patch.x += x;
    patch.y += y;
    patch.xx += x * x;
    patch.xy += x * y;
    patch.yy += y * y;
    ++patch.count;
  }
  return patches;
}

/// What the patches that certainly show the face tell of the light, and how much of it all shows.
struct Light {
  int points{0};
  float contrast{0};  ///< of the pattern: sum of squares over all points
  float gain{0};      ///< 0: nothing is certain

  explicit Light(const Patches& patches) {
    Patch sure;
    for (const Patch& patch : patches) {
      if (patch.count < kFewest) continue;
      points += patch.count;
      contrast += patch.var_x();
      if (patch.correlation() < kSure) continue;
      sure.count += patch.count;
      sure.xx += patch.var_x();
      sure.xy += patch.cov();
    }
    const bool enough = static_cast<float>(sure.count) >= kLeastSure * static_cast<float>(points);
    if (enough && sure.xy > 0) gain = sure.xy / sure.xx;
  }
};

/// The points of @p marked patches are no longer seen in @p samples (null: nothing to do).
void Unsee(const FaceTexture& texture, const Marks& marked, FaceSamples* samples) {
  if (samples == nullptr) return;
  const std::vector<Eigen::Vector3f>& points = texture.points().points;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (marked[static_cast<std::size_t>(PatchOf(points[i]))]) samples->seen[i] = 0;
  }
}

}  // namespace

double HideOccluded(const FaceTexture& texture, Band band,
                    const std::array<FaceSamples*, 2>& samples) {
  std::array<Patches, 2> patches{};
  for (std::size_t e = 0; e < 2; ++e) {
    if (samples[e] != nullptr) patches[e] = PatchesOf(texture, band, *samples[e]);
  }
  const std::array<Light, 2> light = {Light(patches[0]), Light(patches[1])};
  int all = 0, num_hidden = 0;
  std::array<Marks, 2> hidden{};
  for (std::size_t e = 0; e < 2; ++e) {
    all += light[e].points;
    // Where one eye sees nothing for certain, the light is what the other sees.
    const float gain = light[e].gain > 0 ? light[e].gain : light[1 - e].gain;
    if (!(gain > 0) || light[e].points == 0) continue;
    const float rms = std::sqrt(light[e].contrast / static_cast<float>(light[e].points));
    const float usual = kUsualShare * gain * rms + kNoise;
    for (std::size_t k = 0; k < hidden[e].size(); ++k) {
      const Patch& patch = patches[e][k];
      if (patch.count < kFewest || patch.correlation() > kLikely) continue;
      const float contrast = gain * gain * patch.var_x() / static_cast<float>(patch.count);
      const float unexplained = patch.Unexplained(gain);
      hidden[e][k] = unexplained > contrast && unexplained > usual * usual;
      if (hidden[e][k]) num_hidden += patch.count;
    }
  }
  if (num_hidden == 0 || num_hidden > kMostHidden * all) return 0;
  for (std::size_t e = 0; e < 2; ++e) Unsee(texture, hidden[e], samples[e]);
  return static_cast<double>(num_hidden) / all;
}

void KeepCertain(const FaceTexture& texture, Band band,
                 const std::array<FaceSamples*, 2>& samples) {
  for (FaceSamples* eye : samples) {
    if (eye == nullptr) continue;
    const Patches patches = PatchesOf(texture, band, *eye);
    Marks doubtful{};
    for (std::size_t k = 0; k < doubtful.size(); ++k)
      doubtful[k] = patches[k].count < kFewest || patches[k].correlation() < kCertain;
    Unsee(texture, doubtful, eye);
  }
}

}  // namespace visavis
