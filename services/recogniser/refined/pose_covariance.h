#pragma once

#include <Eigen/Core>

#include "common/geometry/head_angles.h"
#include "services/recogniser/refined/pose_equations.h"

namespace visavis {

/// How uncertain a pose is, as head_pose_t tells it. The normal equations' inverse holds what the
/// pictures leave open, and what makes pattern and face differ in each frame alike, which is the
/// larger part: a face that was learned repeats to a fraction of it. But the learned points lie on
/// a surface that is not quite the head's, so the pose is wrong by what the direction of view has
/// turned since. The constant offset between two definitions of a head's frame is not in it.
class PoseCovariance {
 public:
  /// Another face.
  void Forget();
  /// The face was learned from @p direction, in which M's origin sees the camera (unit, in M).
  void Learn(const Eigen::Vector3d& direction);

  /// Of a pose that is not one of the learned face seen by both eyes.
  static Matrix6d OfAnyFace(const Matrix6d& information);
  /// Of the learned face, seen from @p direction by both eyes.
  Matrix6d OfLearnedFace(const Matrix6d& information, const Eigen::Vector3d& direction) const;

 private:
  Eigen::Vector3d sum_{Eigen::Vector3d::Zero()};  ///< of directions
  int count_{0};
};

/// The covariance of a pose of the learned face of which @p hidden, a share, was behind something
/// else, whose edges pull at what is seen beside it; most of all in depth, which both eyes fix
/// together. @p sight: towards the head, unit, in C.
Matrix6d WithHidden(const Matrix6d& covariance, double hidden, const Eigen::Vector3d& sight);

/// The covariance of the pose of a frame R that is fixed to M: its position hangs on the rotation
/// with the lever @p p_MR_C, R's origin from M's, in C.
Matrix6d WithLever(const Matrix6d& covariance, const Eigen::Vector3d& p_MR_C);

}  // namespace visavis
