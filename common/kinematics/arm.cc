#include "common/kinematics/arm.h"

#include "common/core/check.h"
#include "common/kinematics/arm_chain.h"

namespace visavis {

Arm::Arm(const std::string& urdf, const std::string& base_link, const std::string& tip_link)
    : chain_(std::make_shared<const ArmChain>(ReadArmChain(urdf, base_link, tip_link))) {}

int Arm::num_joints() const { return static_cast<int>(chain_->joints.size()); }

const std::vector<ArmJoint>& Arm::joints() const { return chain_->joints; }

RigidTransform Arm::ForwardKinematics(const Eigen::Ref<const Eigen::VectorXd>& q) const {
  VISAVIS_THROW_UNLESS(q.size() == num_joints(), q.size());
  KDL::Frame X_BS;  // S: the end of the segments so far
  int joint = 0;
  for (const KDL::Segment& segment : chain_->kdl.segments) {
    const bool moves = segment.getJoint().getType() != KDL::Joint::Fixed;
    X_BS = X_BS * segment.pose(moves ? q[joint++] : 0.0);
  }
  return ToEigen(X_BS);
}

JacobianMatrix Arm::Jacobian(const Eigen::Ref<const Eigen::VectorXd>& q,
                             const Eigen::Vector3d& p_HP) const {
  VISAVIS_THROW_UNLESS(q.size() == num_joints(), q.size());
  // On the way to H each column takes the joint's axis (below) and a point on it (above); once p_BP
  // is known the point becomes a velocity.
  JacobianMatrix J(6, num_joints());
  KDL::Frame X_BS;
  int joint = 0;
  for (const KDL::Segment& segment : chain_->kdl.segments) {
    if (segment.getJoint().getType() == KDL::Joint::Fixed) {
      X_BS = X_BS * segment.pose(0.0);
      continue;
    }
    J.col(joint).head<3>() = ToEigen(X_BS * segment.getJoint().JointOrigin());
    J.col(joint).tail<3>() = ToEigen(X_BS.M * segment.getJoint().JointAxis());
    X_BS = X_BS * segment.pose(q[joint++]);
  }
  const Eigen::Vector3d p_BP = ToEigen(X_BS) * p_HP;
  for (int i = 0; i < num_joints(); ++i) {
    const Eigen::Vector3d point = J.col(i).head<3>(), axis = J.col(i).tail<3>();
    if (chain_->joints[i].type == JointType::kPrismatic) {
      J.col(i) << axis, Eigen::Vector3d::Zero();
    } else {
      J.col(i).head<3>() = axis.cross(p_BP - point);
    }
  }
  return J;
}

int Arm::FindJointBeyondLimits(const Eigen::Ref<const Eigen::VectorXd>& q, double tolerance) const {
  VISAVIS_THROW_UNLESS(q.size() == num_joints(), q.size());
  for (int i = 0; i < num_joints(); ++i) {
    const ArmJoint& joint = chain_->joints[i];
    if (!(q[i] >= joint.lower - tolerance && q[i] <= joint.upper + tolerance)) return i;
  }
  return -1;
}

}  // namespace visavis
