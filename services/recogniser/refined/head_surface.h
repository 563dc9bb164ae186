#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <memory>

#include "services/recogniser/refined/head_table.h"

namespace visavis {

/// Where a head has its features, and the plane C_h between hair and skin, in the M frame (x to the
/// subject's left as the camera sees right, y down, z to the rear), m. Means of adult
/// anthropometry; the origin lies halfway between the mean vertex and chin.
struct HeadShape {
  float hair_tilt_rad{0.5935f};        ///< of the plane, back from horizontal
  float hair_offset{-0.029f};          ///< of that plane along its normal
  float eye_y{0.013f}, eye_x{0.031f};  ///< pupils
  float brow_y{0.0035f};
  float nostril_y{0.059f};
  float mouth_y{0.082f};

  /// Unit normal of the plane, into the hair.
  Eigen::Vector3f hair_normal() const {
    return {0, -std::sin(hair_tilt_rad), std::cos(hair_tilt_rad)};
  }
};

/// A head's surface, star-shaped about M's origin, from a table by direction.
class HeadSurface {
 public:
  /// The plane of @p shape counts where the table has no border of the hair.
  /// @throws std::invalid_argument as HeadTable::ValidateOrThrow.
  HeadSurface(const HeadShape& shape, const HeadTable& table);

  const HeadShape& shape() const { return shape_; }
  /// [m] along the unit vector @p direction, hair included.
  float Radius(const Eigen::Vector3f& direction) const;
  /// [m] standard deviation of that.
  float Sigma(const Eigen::Vector3f& direction) const;
  /// [m] of @p p beyond the plane C_h (Eq. 23), or the border that a table has in its place:
  /// positive on the hair's side.
  float HairSide(const Eigen::Vector3f& p) const;
  /// Unit vector along the surface at its point @p p, straight into the hair.
  Eigen::Vector3f IntoHair(const Eigen::Vector3f& p) const;
  /// The surface point in direction @p p, and its outward unit normal.
  Eigen::Vector3f Onto(const Eigen::Vector3f& p) const;
  Eigen::Vector3f NormalAt(const Eigen::Vector3f& p) const;

 private:
  HeadShape shape_;
  std::shared_ptr<const TabulatedHead> table_;
};

}  // namespace visavis
