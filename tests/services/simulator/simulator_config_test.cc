#include "services/simulator/simulator_config.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <string>
#include <vector>

#include "common/config/config_reader.h"
#include "common/config/config_writer.h"
#include "tests/support/shipped_config.h"

namespace visavis {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

TEST(SimulatorConfigTest, TheShippedFileHoldsEveryDefault) {
  ExpectShippedFileHoldsEveryDefault<SimulatorConfig>("services/simulator/simulator.yaml");
}

void ExpectRefused(const std::string& assignment, const std::string& key, const std::string& rule) {
  EXPECT_THAT([&] { LoadConfig<SimulatorConfig>("", {assignment}); },
              ThrowsMessage<ConfigError>(AllOf(HasSubstr(key), HasSubstr(rule))))
      << assignment;
}

TEST(SimulatorConfigTest, RefusesBadValuesByKeyAndRule) {
  ExpectRefused("scenario.name=dance", "name", "must be one of shuttle_x");
  ExpectRefused("scenario.amplitude_mm=1500", "amplitude_mm", "0 to 1000 mm");
  ExpectRefused("scenario.head_phi_mm_deg=[1, 2, 3]", "scenario.head_phi_mm_deg", "must be six");
  ExpectRefused("scene.subject=adult_z", "scene.subject", "adult_a");
  ExpectRefused("scene.edge_samples=3", "edge_samples", "1, 2, 4, 8 or 16");
  ExpectRefused("scene.texture_size=1000", "texture_size", "power of two");
  ExpectRefused("scene.light=above", "light", "front side");
  ExpectRefused("sensor.noise_sigma=-1", "noise_sigma", "0 to 40");
  ExpectRefused("sensor.blur_samples=0", "blur_samples", "1 to 64");
  ExpectRefused("image_format=bmp", "image_format", "raw gray jpeg");
  ExpectRefused("rig_file=/nowhere/rig.yaml", "rig_file", "must be a file that exists");
  ExpectRefused("arm_rate_hz=20", "arm_rate_hz", "must not be below frame_rate_hz");
  ExpectRefused("cameras=usb", "cameras", "publish gige");
  ExpectRefused("gige.right.address=127.0.0.1", "gige.right.address", "the left camera's");
  ExpectRefused("gige.left.address=here", "gige.left.address", "must be an IPv4 address");
  ExpectRefused("gige.left.address=127.0.0.256", "gige.left.address", "must be an IPv4 address");
  ExpectRefused("gige.right.serial=LEFT", "gige.right.serial", "the left camera's");
  ExpectRefused("gige.faults=[{camera: left}]", "gige.faults", "needs cameras: gige");
  ExpectRefused("gige.faults=[{camera: up}]", "gige.faults.0.camera", "left right");
  ExpectRefused("gige.faults=[{}, {when_s: 3}]", "gige.faults.1.when_s", "unknown key");
  ExpectRefused("scene.hair=long", "hair", "unknown key");
}

TEST(SimulatorConfigTest, FaultsAreReadInOrderAndWrittenAsTheyAreRead) {
  const auto config = LoadConfig<SimulatorConfig>(
      "",
      {"cameras=gige",
       "gige.faults=[{camera: right, fault: die, at_s: 5, for_s: 2}, {fault: drop, frames: 3}]"});
  ASSERT_EQ(config.gige.faults.size(), 2u);
  EXPECT_EQ(config.gige.faults[0].camera, "right");
  EXPECT_EQ(config.gige.faults[0].for_s, 2);
  EXPECT_EQ(config.gige.faults[1].fault, "drop");
  EXPECT_EQ(config.gige.faults[1].frames, 3);
  const YAML::Node written = YAML::Load(DumpConfig(config))["gige"]["faults"];
  ASSERT_EQ(written.size(), 2u);
  EXPECT_EQ(written[0]["fault"].as<std::string>(), "die");
  EXPECT_EQ(written[1]["frames"].as<int>(), 3);
}

}  // namespace
}  // namespace visavis
