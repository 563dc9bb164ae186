// visavis-enrol as its users start it: a simulated person is recorded, enrolled, and tracked in
// another recording.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/support/child_process.h"
#include "tests/support/environment.h"
#include "tests/support/temporary_folder.h"

namespace visavis {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

std::string Program(const std::string& name) {
  return Environment("VISAVIS_BIN_DIR") + "/visavis-" + name;
}

/// What it wrote to stdout.
std::string RunWell(const std::vector<std::string>& args) {
  const ProcessResult result = RunProcess(args, {}, std::chrono::minutes(4));
  EXPECT_EQ(result.exit_code, 0) << args[0] << ": " << result.err;
  return result.out;
}

/// The head stands still at random poses, @p hold_s each.
void Simulate(const std::string& log, double seconds, double hold_s, int seed) {
  RunWell({Program("simulator"), "--fast", "--record", log, "--scenario", "random_poses",
           "--subject", "adult_a", "--seconds", std::to_string(seconds), "--seed",
           std::to_string(seed), "--set", "scenario.hold_s=" + std::to_string(hold_s), "--set",
           "scene.texture_size=512", "--set", "scene.edge_samples=1"});
}

/// Errors over the frames of @p log, replayed with @p flags, one constant head offset removed.
nlohmann::json Evaluate(const std::string& log, const std::string& replayed,
                        const std::vector<std::string>& flags) {
  std::vector<std::string> replay = {Program("recogniser"), "--replay", log, "--record", replayed};
  replay.insert(replay.end(), flags.begin(), flags.end());
  RunWell(replay);
  return nlohmann::json::parse(
      RunWell({Program("evaluate"), replayed, "--align-head-frame", "--json", "-"}));
}

TEST(EnrolProcessTest, AnEnrolledPersonIsTrackedMoreExactlyInAnotherRecording) {
  const TemporaryFolder folder;
  const std::string head = folder / "head.yaml", other = folder / "other.lcm";
  Simulate(folder / "first.lcm", 2, 0.33, 1);
  Simulate(other, 4, 0.5, 2);
  const std::string report = RunWell({Program("enrol"), folder / "first.lcm", "-o", head});
  EXPECT_THAT(report, StartsWith(head + ": a head of "));
  EXPECT_THAT(report, HasSubstr("of 60 pairs"));
  EXPECT_THAT(report, HasSubstr("pictures agree with the texture 0.9"));

  const std::string setting = "refined.head.file=" + head;
  RunWell({Program("recogniser"), "--check-config", "--set", setting});
  const auto enrolled = Evaluate(other, folder / "enrolled.lcm", {"--set", setting});
  const auto generic = Evaluate(other, folder / "generic.lcm", {});
  EXPECT_GE(enrolled["share_tracking"], 0.9);
  EXPECT_EQ(enrolled["aligned"]["share_false_tracking"], 0);
  const auto rmse = [](const nlohmann::json& json, const char* kind, const char* of) {
    return json["aligned"][kind][of]["rmse"].get<double>();
  };
  EXPECT_LT(rmse(enrolled, "position_mm", "norm"), 0.8 * rmse(generic, "position_mm", "norm"));
  EXPECT_LT(rmse(enrolled, "angle_deg", "total"), rmse(generic, "angle_deg", "total"));
}

}  // namespace
}  // namespace visavis
