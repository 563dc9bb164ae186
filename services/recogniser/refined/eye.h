#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "common/geometry/pinhole.h"
#include "common/geometry/rigid_transform.h"

namespace visavis {

/// A rectangle of pixels: x0 <= x < x1.
struct PixelBox {
  int x0{0}, y0{0}, x1{0}, y1{0};

  int width() const { return x1 - x0; }
  int height() const { return y1 - y0; }
  bool empty() const { return x1 <= x0 || y1 <= y0; }
  bool Contains(const PixelBox& box) const {
    return box.x0 >= x0 && box.y0 >= y0 && box.x1 <= x1 && box.y1 <= y1;
  }
};

/// One camera as the refined estimator sees it: an ideal pinhole E (undistorted images).
struct EyeGeometry {
  EyeGeometry(const Pinhole& camera, const RigidTransform& X_CE);

  int width, height;     ///< [px]
  float fx, fy, cx, cy;  ///< [px]
  Eigen::Matrix3f R_EC;
  Eigen::Vector3f p_EC;
};

/// A head's pose as one eye sees it.
struct EyePose {
  EyePose(const EyeGeometry& eye, const RigidTransform& X_CM);

  Eigen::Matrix3f R_CM, R_EM;
  Eigen::Vector3f p_EM;
  Eigen::Vector3f p_ME;  ///< the eye, seen from the head: a point with normal n is turned to the
                         ///< eye where n.(p - p_ME) < 0

  Eigen::Vector3f InEye(const Eigen::Vector3f& p_M) const { return R_EM * p_M + p_EM; }
};

}  // namespace visavis
