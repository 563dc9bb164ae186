#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "common/geometry/rigid_transform.h"

namespace visavis {

/// Largest number of moving joints of an arm, as in arm_state_t.
constexpr int kMaxArmJoints = 64;

/// One number per moving joint, base to tip [rad or m; rad/s or m/s for velocities]. Never on the
/// heap.
using JointVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMaxArmJoints, 1>;

/// [J_p; J_o], 6 x joints: three rows of translation over three of rotation. Never on the heap.
using JacobianMatrix = Eigen::Matrix<double, 6, Eigen::Dynamic, 0, 6, kMaxArmJoints>;

enum class JointType { kRevolute, kContinuous, kPrismatic };

/// A moving joint as its URDF describes it.
struct ArmJoint {
  std::string name;
  JointType type;
  double lower;      ///< [rad or m] -infinity for a continuous joint
  double upper;      ///< [rad or m] +infinity for a continuous joint
  double max_speed;  ///< [rad/s or m/s] > 0; +infinity where the URDF says 0 or nothing
};

struct ArmChain;  // Internal: hides KDL.

/// Kinematics of a serial arm. B is the frame of its base link, H that of its tip link (the hand,
/// the paper's end-effector). Immutable and cheap to copy; all methods may be called from any
/// thread and allocate nothing.
class Arm {
 public:
  /// @param urdf       text of the URDF, at most 4 MB and 1000 joints
  /// @param base_link  name of the link whose frame is B
  /// @param tip_link   name of the link below it whose frame is H
  /// @throws std::invalid_argument naming what is wrong, its value and the rule. Joints between the
  ///   two links may be fixed, revolute, continuous or prismatic, and not mimic others.
  Arm(const std::string& urdf, const std::string& base_link, const std::string& tip_link);

  int num_joints() const;

  /// Moving joints from base to tip: the order of every JointVector.
  const std::vector<ArmJoint>& joints() const;

  /// X_BH at joint positions @p q. @pre q.size() == num_joints(), else std::invalid_argument.
  RigidTransform ForwardKinematics(const Eigen::Ref<const Eigen::VectorXd>& q) const;

  /// Jacobian in B of the point P fixed to H at @p p_HP [m], Eqs. 4 and 5:
  /// v_BP = J_p qdot, w_BH = J_o qdot, both expressed in B. @pre as ForwardKinematics().
  JacobianMatrix Jacobian(const Eigen::Ref<const Eigen::VectorXd>& q,
                          const Eigen::Vector3d& p_HP = Eigen::Vector3d::Zero()) const;

  /// Index of the first joint outside its limits by more than @p tolerance, or -1.
  int FindJointBeyondLimits(const Eigen::Ref<const Eigen::VectorXd>& q, double tolerance = 0) const;

  /// For the other files of this folder.
  const ArmChain& chain() const { return *chain_; }

 private:
  std::shared_ptr<const ArmChain> chain_;
};

}  // namespace visavis
