#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "services/recogniser/refined/eye.h"

namespace visavis {

/// Points that a kernel handles as one: sums are kept in so many lanes on every SIMD target, so
/// that they are equal to the last bit.
inline constexpr int kLanes = 16;
inline constexpr int PaddedSize(int n) { return (n + kLanes - 1) / kLanes * kLanes; }

/// A head's pose as one eye sees it, as the kernels take it: a model point p lies at R p + t in the
/// eye's frame and is seen at pixel (cx + fx x / z, cy + fy y / z).
struct KernelEye {
  KernelEye(const EyeGeometry& eye, const EyePose& pose);

  float R[3][3], t[3];
  float fx, fy, cx, cy;
  float p_ME[3];     ///< the eye, seen from the head
  float distance;    ///< of the two
  float R_CE[3][3];  ///< from the eye's frame to C
  float R_CM[3][3];
};

/// Points of a surface in M [m] with unit normals, column by column.
struct SurfacePoints {
  std::vector<float> x, y, z, normal_x, normal_y, normal_z, n_dot_p;

  int size() const { return static_cast<int>(x.size()); }
  void Add(const Eigen::Vector3f& p, const Eigen::Vector3f& n, float n_dot_p_m);
};

/// An array of @p kPer values a point, of which the last points are copied to a block that is
/// filled up with zeros: kernels may read whole blocks of kLanes points.
template <typename T, int kPer = 1>
class Blocks {
 public:
  Blocks(const T* data, std::size_t n)
      : data_(data), whole_(static_cast<int>(n) / kLanes * kLanes) {
    std::copy(data + kPer * whole_, data + kPer * static_cast<int>(n), rest_.begin());
  }
  /// The values of point @p i and those of its block behind it.
  const T* At(int i) const {
    return i < whole_ ? data_ + kPer * i : rest_.data() + kPer * (i - whole_);
  }

 private:
  const T* data_;
  int whole_;
  std::array<T, static_cast<std::size_t>(kPer* kLanes)> rest_{};
};

}  // namespace visavis
