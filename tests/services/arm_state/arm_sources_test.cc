// Every source of messages: what it reads of its message, through the bus.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "common/bus/log_bus.h"
#include "services/arm_state/sources/source_list.h"
#include "visavis/arm_state_t.hpp"
#include "visavis/iiwa_status_t.hpp"
#include "visavis/joint_state_t.hpp"
#include "visavis/panda_status_t.hpp"

namespace visavis {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::IsNan;

/// A vector for each array of a message, so that none can be taken for another.
std::vector<double> Values(double first) { return {first, first + 0.5}; }

class ArmSourcesTest : public ::testing::Test {
 protected:
  /// What the source called @p name makes of @p message on its usual channel.
  template <typename Message>
  JointReading Read(const std::string& name, const Message& message) {
    JointReading read;
    int num_read = 0;
    const SourceKind& kind = FindSourceKind(name);
    const auto source =
        kind.make({&bus_, &clock_, true, kind.channel, "", [&](const JointReading& reading) {
                     read = reading;
                     ++num_read;
                   }});
    LogEvent event;
    event.channel = std::string("P_") + kind.channel;
    event.data.resize(static_cast<std::size_t>(message.getEncodedSize()));
    message.encode(event.data.data(), 0, static_cast<int>(event.data.size()));
    bus_.Dispatch(event);
    EXPECT_EQ(num_read, 1);
    EXPECT_EQ(source->next_wake_us(), ArmSource::kNever);
    EXPECT_FALSE(source->finished());
    return read;
  }
  ManualClock clock_;
  LogBus bus_{"P_", &clock_, nullptr};
};

TEST_F(ArmSourcesTest, IiwaGivesWhatIsMeasuredAndEstimated) {
  iiwa_status_t message{};
  message.utime = 123;
  message.num_joints = 2;
  message.joint_position_measured = Values(1);
  message.joint_velocity_estimated = Values(2);
  message.joint_position_commanded = Values(3);
  message.joint_position_ipo = Values(4);
  message.joint_torque_measured = Values(5);
  message.joint_torque_commanded = Values(6);
  message.joint_torque_external = Values(7);
  const JointReading reading = Read("iiwa", message);
  EXPECT_EQ(reading.utime_us, 123);
  EXPECT_THAT(reading.names, IsEmpty());
  EXPECT_THAT(reading.position, ElementsAre(1, 1.5));
  EXPECT_THAT(reading.velocity, ElementsAre(2, 2.5));
}

TEST_F(ArmSourcesTest, PandaGivesWhatIsMeasuredAtTheDriversTime) {
  panda_status_t message{};
  message.utime = 123;
  message.num_joints = 2;
  message.joint_position = Values(1);
  message.joint_position_desired = Values(2);
  message.joint_velocity = Values(3);
  message.joint_velocity_desired = Values(4);
  message.joint_acceleration_desired = Values(5);
  message.joint_torque = Values(6);
  message.joint_torque_desired = Values(7);
  message.joint_torque_external = Values(8);
  message.robot_utime = 7;
  const JointReading reading = Read("panda", message);
  EXPECT_EQ(reading.utime_us, 123);
  EXPECT_THAT(reading.names, IsEmpty());
  EXPECT_THAT(reading.position, ElementsAre(1, 1.5));
  EXPECT_THAT(reading.velocity, ElementsAre(3, 3.5));
}

TEST_F(ArmSourcesTest, JointStateGivesNamesAndKeepsNanVelocities) {
  joint_state_t message{};
  message.utime = 123;
  message.num_joints = 2;
  message.joint_name = {"a", "b"};
  message.joint_position = {1, 1.5F};
  message.joint_velocity = {2, std::nanf("")};
  message.joint_effort = {3, 3.5F};
  const JointReading reading = Read("joint_state", message);
  EXPECT_EQ(reading.utime_us, 123);
  EXPECT_THAT(reading.names, ElementsAre("a", "b"));
  EXPECT_THAT(reading.position, ElementsAre(1, 1.5));
  EXPECT_THAT(reading.velocity, ElementsAre(2, IsNan()));
}

TEST_F(ArmSourcesTest, SimulatorGivesItsArmState) {
  arm_state_t message{};
  message.utime = 123;
  message.num_joints = 2;
  message.joint_names = {"a", "b"};
  message.joint_position = Values(1);
  message.joint_velocity = Values(2);
  const JointReading reading = Read("simulator", message);
  EXPECT_EQ(reading.utime_us, 123);
  EXPECT_THAT(reading.names, ElementsAre("a", "b"));
  EXPECT_THAT(reading.position, ElementsAre(1, 1.5));
  EXPECT_THAT(reading.velocity, ElementsAre(2, 2.5));
}

TEST_F(ArmSourcesTest, ANameThatIsNoneIsRefused) {
  EXPECT_THAT([] { FindSourceKind("ur5"); },
              ::testing::ThrowsMessage<std::invalid_argument>(HasSubstr("source: ur5")));
}

}  // namespace
}  // namespace visavis
