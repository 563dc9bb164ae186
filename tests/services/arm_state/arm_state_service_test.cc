#include "services/arm_state/arm_state_service.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "common/bus/log_bus.h"
#include "common/config/config_reader.h"
#include "common/convert/rig_message.h"
#include "common/eventlog/event_log.h"
#include "common/rigs/demo_rig.h"
#include "common/rigs/rig_file.h"
#include "tests/support/temporary_folder.h"
#include "visavis/iiwa_status_t.hpp"

namespace visavis {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

constexpr std::int64_t kStartUs = 1'700'000'000'000'000;

/// A service on a log bus, listening to an iiwa, and all that it published.
class ArmStateServiceTest : public ::testing::Test {
 protected:
  ArmStateServiceTest() { clock_.Set(kStartUs); }

  void Start(const std::vector<std::string>& settings = {"source=iiwa"}, bool live = false) {
    bus_.emplace("", &clock_, &writer_);  // without the handlers of a service before
    service_ = std::make_unique<ArmStateService>(LoadConfig<ArmStateConfig>("", settings),
                                                 ServiceContext{&*bus_, &clock_, &status_, live});
  }
  template <typename Message>
  void Send(const std::string& channel, const Message& message) {
    LogEvent event;
    event.channel = channel;
    event.data.resize(static_cast<std::size_t>(message.getEncodedSize()));
    message.encode(event.data.data(), 0, static_cast<int>(event.data.size()));
    bus_->Dispatch(event);
  }
  void SendRig() { Send("STEREO_RIG", ToMessage(DemoRig(), clock_.NowUs())); }
  /// @p delay_us  from its stamp to its arrival by the host's clock
  void SendIiwa(std::int64_t t_us, double q0, int num_joints = 7, std::int64_t delay_us = 500) {
    iiwa_status_t m{};
    m.utime = kStartUs + t_us;
    m.num_joints = num_joints;
    const auto n = static_cast<std::size_t>(num_joints);
    m.joint_position_measured = std::vector<double>(n, 0.1);
    m.joint_position_measured[0] = q0;
    m.joint_velocity_estimated = std::vector<double>(n, 0.2);
    m.joint_position_commanded = m.joint_position_ipo = m.joint_torque_measured =
        m.joint_torque_commanded = m.joint_torque_external = std::vector<double>(n, 9);
    clock_.Set(kStartUs + t_us + delay_us);
    Send("IIWA_STATUS", m);
  }
  std::vector<arm_state_t> States() {
    writer_.Flush();
    EventLogReader reader(folder_ / "out.lcm");
    std::vector<arm_state_t> states;
    for (LogEvent event; reader.Next(&event);) {
      if (event.channel != "ARM_STATE") continue;
      states.emplace_back();
      states.back().decode(event.data.data(), 0, static_cast<int>(event.data.size()));
    }
    return states;
  }
  service_status_t Status() {
    service_->UpdateStatus();
    return status_.Make(clock_.NowUs());
  }
  static std::int64_t Counter(const service_status_t& status, const std::string& name) {
    for (std::size_t i = 0; i < status.counter_names.size(); ++i)
      if (status.counter_names[i] == name) return status.counters[i];
    return -1;
  }

  const TemporaryFolder folder_;
  ManualClock clock_;
  EventLogWriter writer_{folder_ / "out.lcm", EventLogWriter::Mode::kReplace};
  std::optional<LogBus> bus_;
  StatusReporter status_{"arm_state", "0"};
  std::unique_ptr<ArmStateService> service_;
};

TEST_F(ArmStateServiceTest, AnIiwasStatusBecomesAnArmStateWithTheUrdfsNames) {
  Start();
  SendRig();
  SendIiwa(0, 0.5);
  SendIiwa(5'000, 0.501);
  const auto states = States();
  ASSERT_EQ(states.size(), 2u);
  EXPECT_EQ(states[1].utime, kStartUs + 5'000);
  EXPECT_EQ(states[0].seq, 0);
  EXPECT_EQ(states[1].seq, 1);
  EXPECT_EQ(states[1].source, "iiwa");
  EXPECT_EQ(states[1].num_joints, 7);
  EXPECT_EQ(states[1].joint_names.front(), "joint_1");
  EXPECT_THAT(states[1].joint_position, ElementsAre(0.501, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1));
  EXPECT_THAT(states[1].joint_velocity, ElementsAre(0.2, 0.2, 0.2, 0.2, 0.2, 0.2, 0.2));
  EXPECT_EQ(states[1].clock_state, arm_state_t::CLOCK_UNKNOWN);  // offline nothing asks the host
  EXPECT_TRUE(std::isnan(states[1].clock_offset_s));
}

TEST_F(ArmStateServiceTest, WithoutAnArmNothingIsPublishedAndTheStatusSaysWhatIsMissing) {
  Start();
  SendIiwa(0, 0.5);
  RigDescription armless = DemoRig();
  armless.arm.reset();
  Send("STEREO_RIG", ToMessage(armless, kStartUs));
  EXPECT_TRUE(States().empty());
  EXPECT_THAT(Status().state_text, HasSubstr("no STEREO_RIG with an arm yet"));
  EXPECT_EQ(Status().dropped, 1);
  SendRig();
  SendIiwa(5'000, 0.5);
  EXPECT_EQ(States().size(), 1u);
  EXPECT_EQ(Status().state_text.find("STEREO_RIG"), std::string::npos);
}

TEST_F(ArmStateServiceTest, TheSameRigAgainForgetsNothing) {
  Start();
  SendRig();
  SendIiwa(0, 0.5);
  SendRig();
  SendIiwa(5'000, 2.5);  // impossible after 0.5
  EXPECT_EQ(States().size(), 1u);
  EXPECT_EQ(Counter(Status(), "refused_impossible"), 1);
}

TEST_F(ArmStateServiceTest, ARigFileServesInTheRigsPlace) {
  SaveRigFile(DemoRig(), folder_ / "rig.yaml");
  Start({"source=iiwa", "rig_file=" + (folder_ / "rig.yaml")});
  SendIiwa(0, 0.5);
  EXPECT_EQ(States().size(), 1u);
  RigDescription armless = DemoRig();
  armless.arm.reset();
  SaveRigFile(armless, folder_ / "armless.yaml");
  EXPECT_THAT([&] { Start({"rig_file=" + (folder_ / "armless.yaml")}); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("armless.yaml: arm: missing")));
}

TEST_F(ArmStateServiceTest, WhatIsRefusedIsCountedAndToldByChannelJointAndRule) {
  Start();
  SendRig();
  SendIiwa(0, 0.5);
  SendIiwa(5'000, 0.5, 6);
  EXPECT_EQ(Status().last_error,
            "IIWA_STATUS: 6 positions and 6 velocities: must be 7 each, for as many joints");
  SendIiwa(10'000, 2.5);
  const service_status_t status = Status();
  EXPECT_THAT(status.last_error, HasSubstr("IIWA_STATUS: position of 'joint_1': 2.5 after 0.5"));
  EXPECT_EQ(status.rejected, 2);
  EXPECT_EQ(status.processed, 1);
  EXPECT_EQ(Counter(status, "refused_joints"), 1);
  EXPECT_EQ(Counter(status, "refused_impossible"), 1);
  EXPECT_EQ(States().size(), 1u);
}

TEST_F(ArmStateServiceTest, AgeRateGapsAndSilenceAreInTheStatus) {
  Start();
  SendRig();
  EXPECT_THAT(Status().state_text, HasSubstr("no IIWA_STATUS yet"));
  for (int i = 0; i < 200; ++i) SendIiwa(5'000 * i, 0.5);
  clock_.Set(kStartUs + 1'000'000);
  service_status_t status = Status();
  EXPECT_EQ(status.state_text, "");
  EXPECT_EQ(Counter(status, "age_us"), 5'000);
  EXPECT_EQ(Counter(status, "gaps"), 0);
  EXPECT_NEAR(status.latency_p50_ms, 0.5, 1e-6);
  SendIiwa(1'700'000, 0.5);
  clock_.Set(kStartUs + 2'000'000);
  status = Status();
  EXPECT_THAT(status.state_text, HasSubstr("IIWA_STATUS at 1 Hz, must be at least 50"));
  EXPECT_EQ(Counter(status, "gaps"), 1);
  EXPECT_EQ(Counter(status, "largest_gap_us"), 705'000);
  clock_.Set(kStartUs + 4'000'000);
  EXPECT_THAT(Status().state_text, HasSubstr("no IIWA_STATUS for 2.3 s"));
}

// The driver's clock is an hour ahead.
TEST_F(ArmStateServiceTest, StampsOfAnotherClockAreToldWithTheRemedyAndMappedOnesAreNot) {
  constexpr std::int64_t kHourUs = 3'600'000'000;
  Start();
  SendRig();
  for (int i = 0; i < 20; ++i) SendIiwa(kHourUs + 5'000 * i, 0.5, 7, 500 - kHourUs);
  EXPECT_THAT(Status().state_text, HasSubstr("IIWA_STATUS is stamped 3600.0 s ahead of this host's "
                                             "clock: synchronise the clocks, or set times to"));
  EXPECT_EQ(States().back().utime, kStartUs + kHourUs + 95'000);

  Start({"source=iiwa", "times=mapped"});
  clock_.Set(kStartUs);
  SendRig();
  for (int i = 0; i < 20; ++i) SendIiwa(kHourUs + 5'000 * i, 0.5, 7, 500 - kHourUs);
  EXPECT_EQ(Status().state_text, "");
  EXPECT_EQ(States().back().utime, kStartUs + 95'500);
}

TEST_F(ArmStateServiceTest, ALogThatIsPlayedAgainIsANewSession) {
  Start();
  SendRig();
  SendIiwa(10'000'000, 0.5);
  SendIiwa(0, -0.5);
  EXPECT_EQ(States().size(), 2u);
  EXPECT_EQ(Counter(Status(), "sessions"), 1);
}

TEST_F(ArmStateServiceTest, ACsvWaitsForItsArmIsPlayedToItsEndAndEndsTheService) {
  std::ofstream(folder_ / "arm.csv")
      << "time_s,joint_7,joint_1,joint_2,joint_3,joint_4,joint_5,joint_6\n"
         "0,0.7,0.1,0.2,0.3,0.4,0.5,0.6\n0.01,0.71,0.1,0.2,0.3,0.4,0.5,0.6\n"
         "0.02,0.72,0.1,0.2,0.3,0.4,0.5,0.6\n";
  Start({"source=csv", "csv_file=" + (folder_ / "arm.csv")}, true);
  EXPECT_EQ(service_->next_wake_us(), Service::kNever);
  SendRig();
  EXPECT_EQ(service_->next_wake_us(), kStartUs);
  clock_.Set(kStartUs + 20'000);
  service_->Wake();
  EXPECT_TRUE(service_->finished());
  const auto states = States();
  ASSERT_EQ(states.size(), 2u);  // the first row has no velocity
  EXPECT_EQ(states[0].utime, kStartUs + 10'000);
  EXPECT_EQ(states[0].joint_position[6], 0.71);
  EXPECT_NEAR(states[0].joint_velocity[6], 1, 1e-9);
  EXPECT_EQ(states[1].source, "csv");
}

TEST_F(ArmStateServiceTest, AReplayLeavesOutEarlierArmStatesAndImages) {
  const Replay::Filter filter = ArmStateService::ReplayFilter(ArmStateConfig{}, "R_");
  EXPECT_TRUE(filter.is_own_output({0, 0, "R_ARM_STATE", {}}));
  EXPECT_FALSE(filter.is_own_output({0, 0, "R_SIMULATOR_ARM_STATE", {}}));
  EXPECT_FALSE(filter.is_own_output({0, 0, "R_SERVICE_STATUS", {1, 2}}));
  EXPECT_TRUE(filter.is_image({0, 0, "R_STEREO_IMAGES", {}}));
}

}  // namespace
}  // namespace visavis
