#pragma once

// For the solvers alone: the camera model over any scalar, so that it can be differentiated.

#include <Eigen/Core>

#include "common/geometry/pinhole.h"

namespace visavis {

/// fx fy cx cy k1 k2 p1 p2 k3.
constexpr int kNumIntrinsics = 9;
using Intrinsics = Eigen::Matrix<double, kNumIntrinsics, 1>;

inline Intrinsics IntrinsicsOf(const Pinhole& c) {
  Intrinsics k;
  k << c.fx, c.fy, c.cx, c.cy, c.distortion[0], c.distortion[1], c.distortion[2], c.distortion[3],
      c.distortion[4];
  return k;
}

inline Pinhole PinholeOf(const Intrinsics& k, int width, int height) {
  return {width, height, k[0], k[1], k[2], k[3], {k[4], k[5], k[6], k[7], k[8]}};
}

/// Project() of pinhole.h, for p_C with z > 0.
template <typename T>
Eigen::Matrix<T, 2, 1> ProjectWith(const T* k, const Eigen::Matrix<T, 3, 1>& p_C) {
  const T x = p_C[0] / p_C[2], y = p_C[1] / p_C[2];
  const T r2 = x * x + y * y;
  const T radial = 1.0 + r2 * (k[4] + r2 * (k[5] + r2 * k[8]));
  const T u = x * radial + 2.0 * k[6] * x * y + k[7] * (r2 + 2.0 * x * x);
  const T v = y * radial + k[6] * (r2 + 2.0 * y * y) + 2.0 * k[7] * x * y;
  return {k[0] * u + k[2], k[1] * v + k[3]};
}

}  // namespace visavis
