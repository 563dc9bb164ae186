#pragma once

#include <cmath>
#include <memory>
#include <ostream>
#include <string>

#include "common/core/random.h"
#include "services/recogniser/stereo_fitness.h"
#include "tests/support/stereo_scene.h"

namespace visavis {

/// A random head whose face is skin: its features lie below the hair.
inline HeadModelConfig RandomHead(const std::string& shape, Random* random) {
  HeadModelConfig head = TestHead();
  head.shape = shape;
  head.radius_mm = random->Uniform(80, 110);
  head.semi_axis_x_mm = random->Uniform(75, 90);
  head.semi_axis_y_mm = random->Uniform(90, 120);
  head.semi_axis_z_mm = random->Uniform(75, 110);
  head.hair_tilt_deg = random->Uniform(30, 45);
  head.hair_offset_mm = random->Uniform(-40, -25);
  head.eye_x_mm = 30;
  head.eye_half_width_mm = 10;
  head.brow_outer_x_mm = random->Uniform(40, 50);
  return head;
}

/// The rig with twice the pixels: there S_in and S_out lie more than a pixel from the outline.
inline StereoRig Doubled(const StereoRig& rig) {
  StereoRig doubled = rig;
  for (Pinhole* camera : {&doubled.right, &doubled.left}) {
    camera->width *= 2, camera->height *= 2;
    camera->fx *= 2, camera->fy *= 2;
    camera->cx = 2 * camera->cx + 0.5, camera->cy = 2 * camera->cy + 0.5;
  }
  return doubled;
}

/// Black where a ray of the camera meets the ellipsoid, white elsewhere: the outline, found without
/// the model's points.
inline OwnedImage Silhouette(const Eigen::Vector3d& semi_axes, const Pinhole& camera,
                             const RigidTransform& X_KM, bool negative = false) {
  OwnedImage image = FlatImage(camera.width, camera.height, 255, 255, 255);
  const RigidTransform X_MK = X_KM.inverse();
  const Eigen::Vector3d o = X_MK.translation().cwiseQuotient(semi_axes);
  auto out = image.bytes.begin();
  for (int y = 0; y < camera.height; ++y) {
    for (int x = 0; x < camera.width; ++x, out += 3) {
      const Eigen::Vector3d d =
          (X_MK.linear() * Unproject(camera, {x, y})).cwiseQuotient(semi_axes);
      const double discriminant = o.dot(d) * o.dot(d) - d.squaredNorm() * (o.squaredNorm() - 1);
      if ((discriminant > 0) != negative) std::fill(out, out + 3, std::uint8_t{0});
    }
  }
  return image;
}

/// The map of a picture.
inline PackedMap MapOf(const ImageView& image, const ColorRuleConfig& rule = {}) {
  PackedMap map(image.width, image.height);
  map.Build(image, rule);
  return map;
}

/// A model on a rig with both ways to add up the fitness.
struct Kernel {
  Kernel(const HeadModelConfig& head, const StereoRig& stereo_rig)
      : rig(stereo_rig),
        normalised(HeadModel(head), rig, {}),
        raw(HeadModel(head), rig, RawSums()) {}
  static FitnessConfig RawSums() {
    FitnessConfig config;
    config.normalised = false;
    return config;
  }
  const HeadModel& model() const { return normalised.model(); }
  StereoRig rig;
  StereoFitness normalised, raw;
};

/// A head shape on a rig.
struct HeadOnRig {
  const char* name;
  const char* shape;
  StereoRig (*rig)();
  friend void PrintTo(const HeadOnRig& c, std::ostream* os) { *os << c.name; }
};

/// Both shapes, on equal parallel cameras and on unequal ones with the left one turned.
inline const HeadOnRig kHeadsOnRigs[] = {{"SphereParallel", "sphere", SmallRig},
                                         {"EllipsoidParallel", "ellipsoid", SmallRig},
                                         {"SphereUneven", "sphere", UnevenRig},
                                         {"EllipsoidUneven", "ellipsoid", UnevenRig}};

}  // namespace visavis
