#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "common/mesh/label.h"
#include "services/simulator/actor.h"
#include "services/simulator/lighting.h"
#include "services/simulator/ray_scene.h"

namespace visavis {

/// Light reflected towards the camera by the points that a batch of rays hit.
struct ShadedBatch {
  alignas(64) std::array<float, RayBatch::kMax> red, green, blue;  ///< linear, 1 = white
  std::array<Label, RayBatch::kMax> label;
};

/// Shades points of one actor seen from one camera; made anew for every picture.
class Shader {
 public:
  /// @p pixel_angle_rad: what one pixel sees, for the choice of the texture's level.
  Shader(const Actor& actor, const Lighting& light, const RigidTransform& X_SC,
         float pixel_angle_rad);

  /// Shades the batch's rays whose numbers @p rays lists (@p count of them), all of which hit this
  /// actor; (x[i], y[i], 1) is ray i's direction in C. Writes entries of the same numbers.
  void Shade(const RayBatch& batch, const float* x, const float* y, const std::uint8_t* rays,
             int count, ShadedBatch* shaded) const;

  const Eigen::Vector3f& p_OC() const { return p_OC_; }
  const Eigen::Matrix3f& R_OC() const { return R_OC_; }
  const Actor& actor() const { return *actor_; }

 private:
  struct Points;
  void Gather(const RayBatch& batch, const float* x, const float* y, const std::uint8_t* rays,
              int count, Points* points, Label* labels) const;
  void Illuminate(Points* points, int count) const;

  const Actor* actor_;
  Lighting light_;  ///< directions in the actor's frame
  Eigen::Vector3f up_;
  Eigen::Vector3f p_OC_;
  Eigen::Matrix3f R_OC_;
  float pixel_angle_rad_;
};

}  // namespace visavis
