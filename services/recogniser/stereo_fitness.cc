#include "services/recogniser/stereo_fitness.h"

#include <algorithm>
#include <cmath>

namespace visavis {

StereoFitness::StereoFitness(const HeadModel& model, const StereoRig& rig,
                             const FitnessConfig& config)
    : model_(model),
      config_(config),
      right_(MakeCamera(rig.right, RigidTransform::Identity())),
      left_(MakeCamera(rig.left, rig.X_CL)),
      points_{model_.in_u.data(),
              model_.in_v.data(),
              model_.out_u.data(),
              model_.out_v.data(),
              model_.feature_x.data(),
              model_.feature_y.data(),
              model_.feature_z.data(),
              model_.num_in(),
              model_.num_out(),
              model_.num_feature_in(),
              static_cast<int>(model_.feature_x.size())} {}

StereoFitness::Camera StereoFitness::MakeCamera(const Pinhole& pinhole,
                                                const RigidTransform& X_CK) {
  const RigidTransform X_KC = X_CK.inverse();
  return {pinhole.fx, pinhole.fy, pinhole.cx, pinhole.cy, X_KC.linear(), X_KC.translation()};
}

// The tangent contour of the ellipsoid: in coordinates where it is the unit sphere, the camera sits
// at distance d along w, sees the circle of radius rho = sqrt(1 - 1/d^2) at height 1/d, and the
// disc's axes e1, e2 are chosen along the image's x and y.
FitnessView StereoFitness::MakeView(const Camera& camera, const Eigen::Matrix3d& R_CM,
                                    const Eigen::Vector3d& p_CM) const {
  const Eigen::Matrix3d R_KM = camera.R_KC * R_CM;
  const Eigen::Vector3d p_KM = camera.R_KC * p_CM + camera.p_KC;
  const Eigen::Vector3d& a = model_.semi_axes_m();

  const Eigen::Vector3d centre = -(R_KM.transpose() * p_KM).cwiseQuotient(a);
  const double d = std::max(centre.norm(), 1.01);
  const Eigen::Vector3d w = centre / centre.norm();
  const Eigen::Vector3d x_axis = R_KM.row(0).transpose().cwiseProduct(a);
  const Eigen::Vector3d e1 = (x_axis - w * w.dot(x_axis)).normalized();
  const Eigen::Vector3d e2 = e1.cross(w);  // w points at the camera, so e2 points down the image
  const double rho2 = 1 - 1 / (d * d), rho = std::sqrt(rho2);

  Eigen::Matrix3d E;
  E << rho * e1, rho * e2, w;
  const Eigen::Matrix3d disc = R_KM * a.asDiagonal() * E;
  const Eigen::Vector3d focal(camera.fx, camera.fy, 1);
  const Eigen::Vector3d hair = E.transpose() * model_.hair_normal().cwiseProduct(a);

  FitnessView view;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      view.disc[i][j] = static_cast<float>(focal[i] * disc(i, j));
      view.model[i][j] = static_cast<float>(focal[i] * R_KM(i, j));
    }
    view.origin[i] = static_cast<float>(focal[i] * p_KM[i]);
    view.hair[i] = static_cast<float>(hair[i]);
  }
  view.hair_offset = static_cast<float>(model_.hair_offset_m());
  view.rho2 = static_cast<float>(rho2);
  view.contour_h = static_cast<float>(1 / d);
  view.cx = static_cast<float>(camera.cx + 1.5);
  view.cy = static_cast<float>(camera.cy + 1.5);
  return view;
}

// Eqs. 24, 28, 30 of one camera, and their sum; the clamp of F_site comes after the mean (Eq. 25).
Fitness StereoFitness::Combine(const FitnessSums& sums) const {
  const double in = config_.normalised ? 255.0 * model_.num_in() : 1.0;
  const double out = config_.normalised ? 255.0 * model_.num_out() : 1.0;
  const double color = config_.normalised ? in : 255.0;
  const double feature_in = config_.normalised ? 255.0 * model_.num_feature_in() : 1.0;
  const double feature_out = config_.normalised ? 255.0 * model_.num_feature_out() : 1.0;
  Fitness f;
  f.site = sums.site_in / in - sums.site_out / out;
  f.color = sums.color / color;
  f.feat = sums.feature_in / feature_in - sums.feature_out / feature_out;
  return f;
}

Fitness StereoFitness::Evaluate(const StereoMaps& maps, const Vector6d& phi) const {
  const Eigen::Matrix3d R_CM = RotationFromAngles(phi.tail<3>());
  const Eigen::Vector3d p_CM = phi.head<3>();
  Fitness mean;
  int cameras = 0;
  const auto add = [&](const PackedMap* map, const Camera& camera) {
    if (!map) return;
    FitnessSums sums;
    SumFitness(MakeView(camera, R_CM, p_CM),
               {map->data(), map->stride(), static_cast<float>(map->width() + 1),
                static_cast<float>(map->height() + 1)},
               points_, &sums);
    const Fitness one = Combine(sums);
    mean.site += one.site;
    mean.color += one.color;
    mean.feat += one.feat;
    ++cameras;
  };
  add(maps.right, right_);
  add(maps.left, left_);
  if (cameras == 0) return mean;
  mean.site = std::max(0.0, mean.site / cameras);  // Eq. 25: F_site <= 0 counts as 0
  mean.color /= cameras;                           // Eq. 29
  mean.feat /= cameras;                            // Eq. 31
  mean.total = (config_.use_site ? mean.site : 0) + (config_.use_color ? mean.color : 0) +
               (config_.use_feat ? mean.feat : 0);  // Eq. 32
  return mean;
}

}  // namespace visavis
