#include "services/arm_state/arm_state_config.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/config/config_reader.h"
#include "common/config/config_writer.h"
#include "tests/support/shipped_config.h"

namespace visavis {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

TEST(ArmStateConfigTest, TheShippedFileHoldsEveryDefault) {
  ExpectShippedFileHoldsEveryDefault<ArmStateConfig>("services/arm_state/arm_state.yaml");
}

TEST(ArmStateConfigTest, BadValuesAreNamed) {
  const auto load = [](std::vector<std::string> assignments) {
    return [assignments] { LoadConfig<ArmStateConfig>("", assignments); };
  };
  const auto refusal = [](const char* text) { return ThrowsMessage<ConfigError>(HasSubstr(text)); };
  EXPECT_THAT(load({"source=ur5"}),
              refusal("source: ur5: must be one of iiwa panda joint_state csv simulator"));
  EXPECT_THAT(load({"source=csv"}), refusal("csv_file: empty: must name a file"));
  EXPECT_THAT(load({"csv_file=a.csv"}),
              refusal("csv_file: a.csv: must be empty where source is simulator"));
  EXPECT_THAT(load({"source=csv", "csv_file=a", "channel=A"}),
              refusal("channel: A: must be empty"));
  EXPECT_THAT(load({"source=csv", "csv_file=a", "times=mapped"}),
              refusal("times: mapped: must be host"));
  EXPECT_THAT(load({"source=csv", "csv_file=/none.csv"}),
              refusal("csv_file: /none.csv: must be a file that exists"));
  EXPECT_THAT(load({"rig_file=/none.yaml"}),
              refusal("rig_file: /none.yaml: must be a file that exists"));
  EXPECT_THAT(load({"channel=ARM_STATE"}),
              refusal("channel: ARM_STATE: must differ from arm_state"));
  EXPECT_THAT(load({"arm_state=STEREO_RIG"}), refusal("must differ from stereo_rig"));
  EXPECT_THAT(load({"channel=arm state"}), refusal("A-Z, 0-9 and _"));
  EXPECT_THAT(load({"times=tai"}), refusal("times: tai: must be one of host mapped"));
  EXPECT_THAT(load({"velocity_window_ms=0"}),
              refusal("velocity_window_ms: 0: must be 1 to 1000 ms"));
  EXPECT_THAT(load({"speed_factor=.nan"}), refusal("speed_factor"));
}

TEST(ArmStateConfigTest, KeysReachTheStates) {
  const auto config = LoadConfig<ArmStateConfig>(
      "", {"source=iiwa", "joint_names=[b, a]", "times=mapped", "velocities=differentiated",
           "velocity_window_ms=30", "speed_factor=3", "beyond_limits_rad=0.2",
           "follow_jump_after=7", "max_gap_ms=80"});
  EXPECT_EQ(config.SourceChannel(), "IIWA_STATUS");
  const StateOptions options = config.States();
  EXPECT_EQ(options.joint_names, (std::vector<std::string>{"b", "a"}));
  EXPECT_TRUE(options.map_times);
  EXPECT_TRUE(options.differentiate);
  EXPECT_DOUBLE_EQ(options.velocity_window_s, 0.03);
  EXPECT_EQ(options.max_gap_us, 80'000);
  EXPECT_EQ(options.jump.speed_factor, 3);
  EXPECT_EQ(options.jump.beyond_limits, 0.2);
  EXPECT_EQ(options.jump.follow_after, 7);
  const auto other = LoadConfig<ArmStateConfig>("", {"channel=MY_ARM"});
  EXPECT_EQ(other.SourceChannel(), "MY_ARM");
}

}  // namespace
}  // namespace visavis
