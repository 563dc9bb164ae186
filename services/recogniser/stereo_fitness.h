#pragma once

#include "common/geometry/head_angles.h"
#include "common/geometry/stereo_rig.h"
#include "services/recogniser/fitness_kernel.h"
#include "services/recogniser/head_model.h"
#include "services/recogniser/packed_map.h"

namespace visavis {

/// Maps of a stereo pair. A null map: that camera has no picture, the other decides alone.
struct StereoMaps {
  const PackedMap* right{nullptr};
  const PackedMap* left{nullptr};
};

/// F and its parts (Eqs. 25, 29, 31, 32), each a mean over the cameras.
struct Fitness {
  double total{0};
  double site{0};
  double color{0};
  double feat{0};
};

/// How sums become F.
struct FitnessConfig {
  template <typename A>
  void Serialize(A* a) {
    a->Visit("normalised", &normalised);
    a->Visit("use_site", &use_site);
    a->Visit("use_color", &use_color);
    a->Visit("use_feat", &use_feat);
  }
  /// Each sum divided by its number of points and by 255, so that F_site and F_color lie in [0, 1]
  /// and F_feat in [-1, 1]. false: raw sums as printed in Eqs. 24, 28, 30 (p in 0..255, h and b in
  /// 0..1), where the terms weigh by their numbers of points.
  bool normalised{true};
  bool use_site{true}, use_color{true}, use_feat{true};  ///< terms that enter Eq. 32
};

/// The fitness F(phi) of Eq. 32: how well the head model, posed by phi, lies on the head in both
/// images. Cameras are ideal pinholes here: maps of undistorted images.
class StereoFitness {
 public:
  StereoFitness(const HeadModel& model, const StereoRig& rig, const FitnessConfig& config);
  StereoFitness(const StereoFitness&) = delete;  // points_ looks into model_
  StereoFitness& operator=(const StereoFitness&) = delete;

  /// F at phi = [t_x t_y t_z Phi theta psi] (m, rad). The head must lie in front of both cameras by
  /// more than its own size. No allocation.
  Fitness Evaluate(const StereoMaps& maps, const Vector6d& phi) const;

  /// Points projected by one evaluation of a stereo pair.
  int num_points() const { return 2 * model_.num_points(); }
  const HeadModel& model() const { return model_; }

 private:
  struct Camera {
    double fx, fy, cx, cy;
    Eigen::Matrix3d R_KC;  ///< camera K seen from C
    Eigen::Vector3d p_KC;
  };

  static Camera MakeCamera(const Pinhole& pinhole, const RigidTransform& X_CK);
  FitnessView MakeView(const Camera& camera, const Eigen::Matrix3d& R_CM,
                       const Eigen::Vector3d& p_CM) const;
  Fitness Combine(const FitnessSums& sums) const;

  const HeadModel model_;
  const FitnessConfig config_;
  const Camera right_, left_;
  FitnessPoints points_;
};

}  // namespace visavis
