#include "tests/people/looks_sampler.h"

#include <cmath>
#include <limits>
#include <optional>

#include "services/recogniser/log_player.h"
#include "services/recogniser/refined/appearance.h"
#include "services/recogniser/refined/band_images.h"
#include "services/recogniser/refined/working_pair.h"

namespace visavis {
namespace {

using Eigen::Vector3f;

constexpr double kDistance_m = 1.05;  ///< of the heads in the recordings
constexpr float kMinFacing = 0.6f;
constexpr float kFromHair_m = 0.009f;  ///< as FacePointsOf: nearer to the border is no face
constexpr float kBefore_m = 0.2f, kStep_m = 0.001f;

/// Where the line parallel to z first meets the surface from in front.
std::optional<Vector3f> FrontAt(const HeadSurface& surface, float x_m, float y_m) {
  const auto is_inside = [&](float z) {
    const Vector3f p(x_m, y_m, z);
    return p.norm() < surface.Radius(p.normalized());
  };
  float z = -kBefore_m;
  while (z < 0 && !is_inside(z)) z += kStep_m;
  if (z >= 0) return std::nullopt;
  float outside = z - kStep_m, inside = z;
  for (int k = 0; k < 16; ++k) {
    const float middle = 0.5f * (outside + inside);
    (is_inside(middle) ? inside : outside) = middle;
  }
  return Vector3f(x_m, y_m, inside);
}

}  // namespace

LooksSampler::LooksSampler(const LooksGrid& grid, const HeadSurface& mean) {
  for (int cell = 0; cell < grid.size(); ++cell) {
    const auto p = FrontAt(mean, grid.x_m(cell), grid.y_m(cell));
    on_face_.push_back(p && mean.HairSide(*p) < -kFromHair_m);
    // Where there is no surface, a point that is turned away from all cameras.
    points_.points.push_back(p.value_or(Vector3f::Zero()));
    points_.normals.push_back(p ? mean.NormalAt(*p) : Vector3f::UnitZ());
  }
}

std::vector<LooksView> LooksSampler::Sample(const std::string& log,
                                            const RigidTransform& X_TM) const {
  LogPlayer player(log);
  WorkingPair pair(player.rig(), kDistance_m);
  std::array<BandImages, 2> bands{BandImages(pair.eye(0).width, pair.eye(0).height),
                                  BandImages(pair.eye(1).width, pair.eye(1).height)};
  FaceSamples samples(points_.size());
  std::vector<LooksView> views;
  while (const LogPlayer::Pair* shown = player.Next()) {
    if (!shown->truth) continue;
    const RigidTransform X_CM = *shown->truth * X_TM;
    for (std::size_t eye = 0; eye < 2; ++eye) {
      const auto picture = pair.Picture(shown->frame, eye);
      const PixelBox box = pair.BoxAround(eye, X_CM, kHeadRadius_m);
      if (!picture || box.width() < kLeastBox_px || box.height() < kLeastBox_px) continue;
      pair.Fill(eye, box);
      bands[eye].Build(*picture, box);
      LooksView& view = views.emplace_back();
      for (const Band band : {kFineBand, kCoarseBand}) {
        SampleFace(points_, {&pair.eye(eye), nullptr, &bands[eye]}, EyePose(pair.eye(eye), X_CM),
                   band, kMinFacing, &samples);
        for (std::size_t i = 0; i < points_.size(); ++i)
          view[band].push_back(samples.seen[i] ? samples.value[i]
                                               : std::numeric_limits<float>::quiet_NaN());
      }
    }
  }
  return views;
}

}  // namespace visavis
