#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "common/config/rule.h"

namespace visavis {

/// Shape and features of the head model in its frame M (origin: centre of the ellipsoid; x to the
/// image's right when the head faces the camera, y down, z to the back of the head; the face looks
/// along -z). Lengths in mm. Defaults are means of adult anthropometry, not of one person.
struct HeadModelConfig {
  template <typename A>
  void Serialize(A* a) {
    a->Visit("shape", &shape, OneOf({"sphere", "ellipsoid"}));
    a->Visit("radius_mm", &radius_mm, InRange(40.0, 200.0, "mm"));
    a->Visit("semi_axis_x_mm", &semi_axis_x_mm, InRange(40.0, 200.0, "mm"));
    a->Visit("semi_axis_y_mm", &semi_axis_y_mm, InRange(40.0, 200.0, "mm"));
    a->Visit("semi_axis_z_mm", &semi_axis_z_mm, InRange(40.0, 200.0, "mm"));
    a->Visit("hair_tilt_deg", &hair_tilt_deg, InRange(-90.0, 90.0, "deg"));
    a->Visit("hair_offset_mm", &hair_offset_mm, InRange(-150.0, 150.0, "mm"));
    a->Visit("chin_gap_deg", &chin_gap_deg, InRange(0.0, 180.0, "deg"));
    a->Visit("outline_width", &outline_width, InRange(0.02, 0.5));
    a->Visit("eye_x_mm", &eye_x_mm, InRange(10.0, 60.0, "mm"));
    a->Visit("eye_y_mm", &eye_y_mm, InRange(-60.0, 80.0, "mm"));
    a->Visit("eye_half_width_mm", &eye_half_width_mm, InRange(4.0, 30.0, "mm"));
    a->Visit("eye_half_height_mm", &eye_half_height_mm, InRange(2.0, 15.0, "mm"));
    a->Visit("brow_y_mm", &brow_y_mm, InRange(-80.0, 80.0, "mm"));
    a->Visit("brow_inner_x_mm", &brow_inner_x_mm, InRange(2.0, 60.0, "mm"));
    a->Visit("brow_outer_x_mm", &brow_outer_x_mm, InRange(5.0, 80.0, "mm"));
    a->Visit("brow_half_height_mm", &brow_half_height_mm, InRange(1.0, 10.0, "mm"));
    a->Visit("brow_arch_mm", &brow_arch_mm, InRange(-10.0, 20.0, "mm"));
  }
  /// @throws FieldError for rules between keys. @p prefix goes before the keys' names.
  void ValidateOrThrow(const std::string& prefix) const;

  std::string shape{"ellipsoid"};  ///< sphere as in the paper's Fig. 5, or ellipsoid
  double radius_mm{95};            ///< of the sphere
  double semi_axis_x_mm{80};       ///< of the ellipsoid, hair included
  double semi_axis_y_mm{108};
  double semi_axis_z_mm{98};
  double hair_tilt_deg{34};    ///< how far the plane of C_h leans back about x
  double hair_offset_mm{-37};  ///< hair where -y cos(tilt) + z sin(tilt) exceeds it
  double chin_gap_deg{50};     ///< lower sector where the outline is neck, not background
  double outline_width{0.35};  ///< S_out's width over the outline's radius
  double eye_x_mm{31};         ///< centre of the eye from the middle
  double eye_y_mm{20};
  double eye_half_width_mm{14};
  double eye_half_height_mm{5};
  double brow_y_mm{10};  ///< at the brow's ends; the arch lies above
  double brow_inner_x_mm{13};
  double brow_outer_x_mm{52};
  double brow_half_height_mm{2.5};
  double brow_arch_mm{4};
};

/// The 3D solid model as point sets (Eq. 22, Eq. 23 and the feature strips), for the kernel:
/// structure of arrays in single precision, each set's size a multiple of kLanes.
///
/// S_in and S_out are given on the disc that the outline C_v spans: (u, v) with radius 1 on the
/// outline as each camera sees it (the tangent contour, not a fixed circle). S_in lies on the
/// visible surface behind the disc, S_out around it. F_in and F_out lie on the surface in M, [m].
class HeadModel {
 public:
  static constexpr int kLanes = 16;  ///< the widest vector that the kernel uses

  /// Point sets of about 400 points a camera. @throws FieldError as ValidateOrThrow.
  explicit HeadModel(const HeadModelConfig& config);

  const Eigen::Vector3d& semi_axes_m() const { return semi_axes_m_; }
  /// Unit normal in M towards the hair, and the plane's offset along it [m]: C_h is its curve on
  /// the surface.
  const Eigen::Vector3d& hair_normal() const { return hair_normal_; }
  double hair_offset_m() const { return hair_offset_m_; }

  int num_in() const { return static_cast<int>(in_u.size()); }
  int num_out() const { return static_cast<int>(out_u.size()); }
  int num_feature_in() const { return num_feature_in_; }
  int num_feature_out() const { return static_cast<int>(feature_x.size()) - num_feature_in_; }
  /// Points projected for one camera.
  int num_points() const { return num_in() + num_out() + static_cast<int>(feature_x.size()); }

  // S_in and S_out on the disc.
  std::vector<float> in_u, in_v;
  std::vector<float> out_u, out_v;
  // F_in, then F_out, in M [m].
  std::vector<float> feature_x, feature_y, feature_z;

 private:
  void MakeDisc(const HeadModelConfig& config);
  void MakeFeatures(const HeadModelConfig& config);
  void AddFeature(double x_mm, double y_mm);

  Eigen::Vector3d semi_axes_m_;
  Eigen::Vector3d hair_normal_;
  double hair_offset_m_;
  int num_feature_in_{0};
};

}  // namespace visavis
