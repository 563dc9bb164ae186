#pragma once

#include <Eigen/Geometry>
#include <memory>

#include "services/recogniser/refined/head_table.h"

namespace visavis {

/// An adult head as an analytic surface, star-shaped about M's origin: a cranium and a face, each a
/// superellipsoid |x/a|^e + |y/b|^e + |z/c|^e = 1, joined smoothly; nose, eye sockets, hair on top.
/// All in the M frame (x to the subject's left as the camera sees right, y down, z to the rear), m.
/// Means of adult anthropometry; the origin lies halfway between vertex and chin.
struct HeadShape {
  Eigen::Vector3f cranium{0.074f, 0.088f, 0.097f};  ///< semi-axes
  Eigen::Vector3f cranium_centre{0, -0.007f, 0.008f};
  Eigen::Vector3f face{0.064f, 0.089f, 0.062f};
  Eigen::Vector3f face_centre{0, 0.035f, -0.027f};
  float cranium_exponent{2.1f}, face_exponent{2.3f};
  float nose{0.020f};                  ///< how far the tip stands out
  float hair{0.005f};                  ///< thickness; more on top and behind
  float hair_tilt_rad{0.5935f};        ///< of the plane between hair and skin, back from horizontal
  float hair_offset{-0.029f};          ///< of that plane along its normal
  float eye_y{0.013f}, eye_x{0.031f};  ///< pupils
  float brow_y{0.0035f};
  float nostril_y{0.059f};
  float mouth_y{0.082f};
};

/// A head's surface, star-shaped about M's origin: HeadShape's, or one from a table by direction.
class HeadSurface {
 public:
  explicit HeadSurface(const HeadShape& shape);
  /// Radii (and, where the table has it, the border of the hair) from @p table; of @p shape the
  /// places of eyes, brows, nostrils and mouth count, and the plane between hair and skin.
  /// @throws std::invalid_argument as HeadTable::ValidateOrThrow.
  HeadSurface(const HeadShape& shape, const HeadTable& table);

  const HeadShape& shape() const { return shape_; }
  /// [m] along the unit vector @p direction, hair included.
  float Radius(const Eigen::Vector3f& direction) const;
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
  Eigen::Vector3f hair_normal_;
  std::shared_ptr<const TabulatedHead> table_;  // null: analytic
};

}  // namespace visavis
