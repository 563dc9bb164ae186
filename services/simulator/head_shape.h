#pragma once

#include <Eigen/Core>

#include "services/simulator/profile.h"

namespace visavis {

/// How one person's head differs from the average adult's. Lengths in mm, as anthropometry gives
/// them; the defaults are means of adults.
struct HeadMeasures {
  double breadth_mm{152};      ///< widest breadth of the cranium
  double length_mm{195};       ///< glabella to the back of the head
  double height_mm{228};       ///< menton (under the chin) to vertex
  double bizygomatic_mm{137};  ///< breadth over the cheekbones
  double bigonial_mm{107};     ///< breadth over the angles of the jaw
  double interpupillary_mm{62};
  double eye_opening_mm{10.0};    ///< height of the opening between the lids
  double canthal_tilt_mm{1.5};    ///< outer corner of the eye above the inner one
  double lid_fold{1.0};           ///< visibility of the fold above the upper lid, 0 to 1
  double nose_length_mm{51};      ///< sellion to subnasale
  double nose_breadth_mm{35};     ///< over the wings
  double nose_protrusion_mm{20};  ///< tip before subnasale
  double nose_bridge_mm{0};       ///< bridge before the average one
  double mouth_breadth_mm{51};
  double lip_fullness{1.0};   ///< 1 average; 0.5 thin; 1.6 full
  double chin_mm{0};          ///< chin before the average one
  double brow_ridge_mm{1.5};  ///< how far the ridge stands out
  double cheek_mm{0};         ///< fullness of the cheeks; negative: hollow
  double neck_breadth_mm{114};
  double ear_length_mm{63};
  double ear_flare_deg{24};  ///< angle between ear and head

  /// @throws std::invalid_argument naming field, value and range.
  void ValidateOrThrow() const;
};

/// The skin of a bare head and neck, as an implicit surface.
///
/// Two coordinate systems, both in mm with M's axes (x to the image's right when the head faces
/// the camera, y down, z to the back of the head) and M's origin, the centre of the cranium's
/// ellipsoid: "average" coordinates, in which every head has its features at the same place
/// (pupils at x = +-31, y = 22; mouth at y = 92; menton at y = 135), and M itself; ToM maps the
/// first to the second. In M the cranium is the ellipsoid with the semi-axes that
/// cranium_semi_axes_mm() gives, narrowed towards the forehead.
class SkinSurface {
 public:
  explicit SkinSurface(const HeadMeasures& shape);

  /// Approximate signed distance [mm] of @p p (average coordinates) from the skin; < 0 inside.
  double Distance(const Eigen::Vector3d& p) const;

  /// Outermost point of the skin on the ray from @p origin (inside) along the unit vector
  /// @p direction, average coordinates.
  Eigen::Vector3d Outermost(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) const;

  /// Average coordinates to M [mm].
  Eigen::Vector3d ToM(const Eigen::Vector3d& p) const;

  Eigen::Vector3d cranium_semi_axes_mm() const;
  const HeadMeasures& shape() const { return shape_; }

 private:
  double Cranium(const Eigen::Vector3d& p) const;
  double Face(const Eigen::Vector3d& p) const;
  double Neck(const Eigen::Vector3d& p) const;
  double Nose(const Eigen::Vector3d& p) const;
  double Relief(const Eigen::Vector3d& p) const;

  HeadMeasures shape_;
  Profile face_front_, face_half_width_, face_centre_, face_back_;
  Profile y_to_M_;
};

/// Polynomial smooth minimum (union of two distance fields) with blending radius @p k.
double SmoothMin(double a, double b, double k);

}  // namespace visavis
