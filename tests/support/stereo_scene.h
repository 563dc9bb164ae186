#pragma once

#include <cstdint>
#include <vector>

#include "common/core/random.h"
#include "common/geometry/head_angles.h"
#include "services/recogniser/estimator.h"
#include "tests/support/painted_head.h"

namespace visavis {

/// phi from t_x t_y t_z [mm] and Phi theta psi [deg].
Vector6d PhiOf(double x_mm, double y_mm, double z_mm, double phi_deg, double theta_deg,
               double psi_deg);

/// A random pose in the default search space's middle half.
Vector6d RandomPhi(Random* random);

/// The head that the tests paint and look for, every number of it given: tuned defaults move no
/// test.
HeadModelConfig TestHead();

/// A rig of 320x240 px with f = 400 px: a quarter of TestRig()'s pixels, so a quarter of the time
/// to paint.
StereoRig SmallRig();

/// A rig that shares nothing between its cameras: other focal lengths and centres, the left camera
/// turned about all three axes.
StereoRig UnevenRig();

/// Painted stereo pictures of a head.
class StereoScene {
 public:
  StereoScene(const HeadModelConfig& head, const StereoRig& rig)
      : rig_(rig), right_(head, rig.right), left_(head, rig.left) {}

  /// The pair that shows the head at @p X_CM; lives until the next call.
  StereoFrame Paint(const RigidTransform& X_CM, std::int64_t utime_us = 0) {
    return {utime_us, right_.Paint(X_CM), left_.Paint(rig_.X_CL.inverse() * X_CM)};
  }
  StereoFrame Paint(const Vector6d& phi) { return Paint(TransformFromPhi(phi)); }

 private:
  StereoRig rig_;
  PaintedHead right_, left_;
};

/// A picture in memory of its own.
struct OwnedImage {
  std::vector<std::uint8_t> bytes;
  ImageView view;
};

/// RGB picture of independent random bytes.
OwnedImage NoiseImage(int width, int height, Random* random);

/// RGB picture of one colour.
OwnedImage FlatImage(int width, int height, std::uint8_t r, std::uint8_t g, std::uint8_t b);

/// The same picture as grey, by the luma that p is defined on.
OwnedImage GrayImage(const ImageView& rgb);

/// The same picture with its bytes in the order blue, green, red.
OwnedImage BgrImage(const ImageView& rgb);

}  // namespace visavis
