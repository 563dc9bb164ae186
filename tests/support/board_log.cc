#include "tests/support/board_log.h"

#include "common/bus/channels.h"
#include "common/eventlog/event_log_writer.h"
#include "common/geometry/head_angles.h"
#include "tests/support/board_pictures.h"
#include "tests/support/log_writing.h"
#include "visavis/arm_state_t.hpp"

namespace visavis {
namespace {

constexpr char kGantryUrdf[] = R"(<robot name="gantry">
  <link name="base"/><link name="l1"/><link name="l2"/><link name="l3"/><link name="l4"/>
  <link name="l5"/><link name="hand"/>
  <joint name="x" type="prismatic"><parent link="base"/><child link="l1"/><axis xyz="1 0 0"/>
    <limit lower="-9" upper="9" velocity="5" effort="1"/></joint>
  <joint name="y" type="prismatic"><parent link="l1"/><child link="l2"/><axis xyz="0 1 0"/>
    <limit lower="-9" upper="9" velocity="5" effort="1"/></joint>
  <joint name="z" type="prismatic"><parent link="l2"/><child link="l3"/><axis xyz="0 0 1"/>
    <limit lower="-9" upper="9" velocity="5" effort="1"/></joint>
  <joint name="turn_z" type="continuous"><parent link="l3"/><child link="l4"/><axis xyz="0 0 1"/></joint>
  <joint name="turn_y" type="continuous"><parent link="l4"/><child link="l5"/><axis xyz="0 1 0"/></joint>
  <joint name="turn_x" type="continuous"><parent link="l5"/><child link="hand"/><axis xyz="1 0 0"/></joint>
</robot>)";

arm_state_t StateAt(std::int64_t utime_us, const RigidTransform& X_BH, double speed) {
  arm_state_t state{};
  state.utime = utime_us;
  state.num_joints = 6;
  state.joint_names = {"x", "y", "z", "turn_z", "turn_y", "turn_x"};
  state.joint_position = GantryJoints(X_BH);
  state.joint_velocity = std::vector<double>(6, speed);
  state.source = "test";
  return state;
}

}  // namespace

ArmDescription GantryArm() { return {kGantryUrdf, "base", "hand", RigidTransform::Identity()}; }

std::vector<double> GantryJoints(const RigidTransform& X_BH) {
  const Eigen::Vector3d p = X_BH.translation(), angles = AnglesFromRotation(X_BH.linear());
  return {p.x(), p.y(), p.z(), angles[0], angles[1], angles[2]};
}

void WriteBoardLog(const BoardScene& scene, const std::string& path) {
  EventLogWriter writer(path, EventLogWriter::Mode::kReplace);
  const PairRenderer renderer(scene);
  Random random(77);
  for (std::size_t i = 0; i < scene.X_CT.size(); ++i) {
    const std::int64_t rest_us = kFirstViewUs + static_cast<std::int64_t>(i) * kViewPeriodUs;
    for (std::int64_t t_us = -60'000; t_us <= 20'000; t_us += 10'000) {
      WriteMessage(kArmStateChannel,
                   StateAt(rest_us + t_us, scene.X_BH[i], t_us < -40'000 ? 0.5 : 0), &writer);
    }
    if (i % 3 == 0) {
      WriteMessage(kStereoImagesChannel,
                   renderer.Render(scene.X_CT[i], rest_us - 33'000, &random, 7), &writer);
    }
    WriteMessage(kStereoImagesChannel, renderer.Render(scene.X_CT[i], rest_us, &random), &writer);
  }
  writer.Close();
}

}  // namespace visavis
