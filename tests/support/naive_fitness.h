#pragma once

#include "common/geometry/head_angles.h"
#include "common/geometry/stereo_rig.h"
#include "common/image/image.h"
#include "services/recogniser/head_model.h"
#include "services/recogniser/packed_map.h"
#include "services/recogniser/stereo_fitness.h"

namespace visavis {

/// F of Eq. 32 as the paper writes it: one point at a time, in double precision, colours from the
/// RGB pixel through hue and saturation at every point. The kernel's twin: slow, and easy to check
/// against the text.
class NaiveFitness {
 public:
  NaiveFitness(const HeadModel& model, const StereoRig& rig, const ColorRuleConfig& color)
      : model_(model), rig_(rig), color_(color) {}

  Fitness Evaluate(const ImageView& right, const ImageView& left, const Vector6d& phi) const;

  /// Points of S_in and S_out in M, for the camera whose pose in M is @p p_MK (its centre) and
  /// whose image x axis is @p x_M: the model's disc placed on the tangent contour.
  Eigen::Vector3d SurfacePoint(double u, double v, const Eigen::Vector3d& p_MK,
                               const Eigen::Vector3d& x_M) const;
  Eigen::Vector3d OutlinePoint(double u, double v, const Eigen::Vector3d& p_MK,
                               const Eigen::Vector3d& x_M) const;

 private:
  struct Terms {
    double site, color, feat;
  };
  Terms EvaluateCamera(const ImageView& image, const Pinhole& camera,
                       const RigidTransform& X_KM) const;

  const HeadModel& model_;
  StereoRig rig_;
  ColorRuleConfig color_;
};

/// p of the paper: 255 - grey, 255 is black.
int NaiveBrightness(int r, int g, int b);
/// Eq. 26 with hue in degrees, and the gates of ColorRuleConfig.
bool NaiveIsSkin(int r, int g, int b, const ColorRuleConfig& rule);
/// Eq. 27.
bool NaiveIsHair(int r, int g, int b, const ColorRuleConfig& rule);

}  // namespace visavis
