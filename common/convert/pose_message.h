#pragma once

#include "common/geometry/rigid_transform.h"
#include "visavis/head_pose_t.hpp"
#include "visavis/rigid_transform_t.hpp"

namespace visavis {

/// Unit quaternion in the messages' order w x y z, w >= 0.
void WriteQuaternion(const Eigen::Matrix3d& R, double wxyz[4]);

/// @throws MessageError unless finite and of norm 1 within 1e-3.
RigidTransform ReadTransform(const char* field, const double p_m[3], const double q_wxyz[4]);

/// @throws MessageError naming field, value and rule.
RigidTransform FromMessage(const rigid_transform_t& message);
rigid_transform_t ToMessage(const RigidTransform& X, std::int64_t utime);

/// Whether the message holds a pose (and not NaN).
bool HasPose(const head_pose_t& message);

/// X_CM. @throws MessageError where there is none.
RigidTransform FromMessage(const head_pose_t& message);

/// A head_pose_t whose numbers are all NaN or 0: "no estimate".
head_pose_t EmptyHeadPose();

/// Sets position, quaternion and angles of X_CM.
void SetPose(const RigidTransform& X_CM, head_pose_t* message);
/// Sets the pose in the world.
void SetWorldPose(const RigidTransform& X_WM, head_pose_t* message);

/// Truth as HEAD_POSE_TRUTH carries it: TRACKING with the pose; LOST with NaN where no head is
/// seen.
head_pose_t TruthMessage(std::int64_t utime, std::int64_t seq, const RigidTransform* X_CM);

}  // namespace visavis
