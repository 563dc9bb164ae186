#include "common/kinematics/arm_chain.h"

#include <console_bridge/console.h>
#include <urdf_model/joint.h>
#include <urdf_model/link.h>
#include <urdf_model/model.h>
#include <urdf_parser/urdf_parser.h>

#include <algorithm>
#include <cmath>
#include <kdl/joint.hpp>
#include <kdl/segment.hpp>
#include <limits>
#include <mutex>
#include <stdexcept>

#include "common/kinematics/urdf_check.h"

namespace visavis {
namespace {

/// Takes what urdfdom prints while it lives. console_bridge has one handler per process.
class UrdfdomLog final : public console_bridge::OutputHandler {
 public:
  UrdfdomLog() : before_(console_bridge::getOutputHandler()) {
    console_bridge::useOutputHandler(this);
  }
  ~UrdfdomLog() override { console_bridge::useOutputHandler(before_); }

  void log(const std::string& text, console_bridge::LogLevel level, const char*, int) override {
    if (level < console_bridge::CONSOLE_BRIDGE_LOG_ERROR) return;
    errors_ += (errors_.empty() ? "" : "; ") + text;
  }
  const std::string& errors() const { return errors_; }

 private:
  console_bridge::OutputHandler* before_;
  std::string errors_;
};

urdf::ModelInterfaceSharedPtr ParseUrdf(const std::string& text) {
  CheckUrdf(text);
  static std::mutex mutex;  // guards console_bridge's handler
  const std::lock_guard<std::mutex> lock(mutex);
  UrdfdomLog log;
  urdf::ModelInterfaceSharedPtr model;
  std::string error;
  try {
    model = urdf::parseURDF(text);
  } catch (const std::exception& e) {
    error = e.what();
  }
  if (!model || !model->getRoot()) {
    if (error.empty()) error = log.errors().empty() ? "no robot" : log.errors();
    RefuseArm("URDF cannot be read: " + Printable(error));
  }
  return model;
}

urdf::LinkConstSharedPtr FindLink(const urdf::ModelInterface& model, const char* role,
                                  const std::string& name) {
  const urdf::LinkConstSharedPtr link = model.getLink(name);
  if (!link) {
    RefuseArm(std::string(role) + " link " + Quoted(name) + " must be a link of robot " +
              Quoted(model.getName()));
  }
  return link;
}

/// Joints from base to tip.
std::vector<urdf::JointConstSharedPtr> FindPath(const urdf::LinkConstSharedPtr& base,
                                                const urdf::LinkConstSharedPtr& tip) {
  std::vector<urdf::JointConstSharedPtr> path;
  for (urdf::LinkConstSharedPtr link = tip; link != base; link = link->getParent()) {
    if (!link->parent_joint) {
      RefuseArm("tip link " + Quoted(tip->name) + " must lie below base link " +
                Quoted(base->name));
    }
    path.push_back(link->parent_joint);
  }
  std::reverse(path.begin(), path.end());
  return path;
}

JointType TypeOf(const urdf::Joint& joint) {
  switch (joint.type) {
    case urdf::Joint::REVOLUTE:
      return JointType::kRevolute;
    case urdf::Joint::CONTINUOUS:
      return JointType::kContinuous;
    case urdf::Joint::PRISMATIC:
      return JointType::kPrismatic;
    default:
      break;
  }
  const char* type = joint.type == urdf::Joint::FLOATING ? "floating"
                     : joint.type == urdf::Joint::PLANAR ? "planar"
                                                         : "unknown";
  RefuseArm("joint " + Quoted(joint.name) + " has type " + type +
            ", must be revolute, continuous, prismatic or fixed");
}

ArmJoint ReadJoint(const urdf::Joint& joint) {
  if (joint.mimic) {
    RefuseArm("joint " + Quoted(joint.name) + " mimics " + Quoted(joint.mimic->joint_name) +
              ", must move by itself");
  }
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  ArmJoint read{joint.name, TypeOf(joint), -kInfinity, kInfinity, kInfinity};
  if (!joint.limits) return read;
  const urdf::JointLimits& limits = *joint.limits;
  if (read.type != JointType::kContinuous) {
    if (!(limits.lower < limits.upper)) {
      RefuseArm("joint " + Quoted(joint.name) + " has limits " + std::to_string(limits.lower) +
                " to " + std::to_string(limits.upper) + ", lower must be below upper");
    }
    read.lower = limits.lower;
    read.upper = limits.upper;
  }
  if (limits.velocity < 0) {
    RefuseArm("joint " + Quoted(joint.name) + " has limit velocity " +
              std::to_string(limits.velocity) + ", must be >= 0");
  }
  if (limits.velocity > 0) read.max_speed = limits.velocity;
  return read;
}

/// Frame of the joint in its parent link, at joint position 0.
KDL::Frame OriginOf(const urdf::Joint& joint) {
  const urdf::Pose& pose = joint.parent_to_joint_origin_transform;
  const urdf::Rotation& r = pose.rotation;
  return {KDL::Rotation::Quaternion(r.x, r.y, r.z, r.w),
          KDL::Vector(pose.position.x, pose.position.y, pose.position.z)};
}

KDL::Segment MakeSegment(const urdf::Joint& joint, JointType type) {
  const KDL::Frame origin = OriginOf(joint);
  const KDL::Vector axis(joint.axis.x, joint.axis.y, joint.axis.z);
  if (!(axis.Norm() > 1e-6)) {
    RefuseArm("joint " + Quoted(joint.name) + " has axis of length " + std::to_string(axis.Norm()) +
              ", must not be 0");
  }
  const auto kdl_type = type == JointType::kPrismatic ? KDL::Joint::TransAxis : KDL::Joint::RotAxis;
  const KDL::Joint kdl_joint(joint.name, origin.p, origin.M * (axis / axis.Norm()), kdl_type);
  return KDL::Segment(joint.child_link_name, kdl_joint, origin);
}

}  // namespace

ArmChain ReadArmChain(const std::string& urdf, const std::string& base_link,
                      const std::string& tip_link) {
  const urdf::ModelInterfaceSharedPtr model = ParseUrdf(urdf);
  ArmChain chain;
  for (const auto& joint :
       FindPath(FindLink(*model, "base", base_link), FindLink(*model, "tip", tip_link))) {
    if (joint->type == urdf::Joint::FIXED) {
      chain.kdl.addSegment(KDL::Segment(
          joint->child_link_name, KDL::Joint(joint->name, KDL::Joint::Fixed), OriginOf(*joint)));
      continue;
    }
    chain.joints.push_back(ReadJoint(*joint));
    chain.kdl.addSegment(MakeSegment(*joint, chain.joints.back().type));
  }
  if (chain.joints.empty() || chain.joints.size() > kMaxArmJoints) {
    RefuseArm("from " + Quoted(base_link) + " to " + Quoted(tip_link) + " there are " +
              std::to_string(chain.joints.size()) + " moving joints, must be 1 to " +
              std::to_string(kMaxArmJoints));
  }
  return chain;
}

}  // namespace visavis
