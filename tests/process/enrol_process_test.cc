// visavis-enrol as its users start it: a person is recorded, enrolled, and tracked in another
// recording; simulated, and the sample that another renderer made.
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

TEST(EnrolProcessTest, APersonsOwnMeshIsTrackedInItsOwnFrameWithoutAnOffset) {
  const TemporaryFolder folder;
  const std::string mesh = folder / "head.obj", head = folder / "head.yaml";
  const std::string other = folder / "other.lcm", run = folder / "run.lcm";
  RunWell({Program("simulator"), "--subject", "adult_a", "--export-mesh", mesh});
  Simulate(folder / "first.lcm", 2, 0.33, 1);
  Simulate(other, 4, 0.5, 2);
  const auto position_mm = [&](const std::string& measured) {
    RunWell({Program("enrol"), folder / "first.lcm", "-o", head, "--set",
             "refined.head.file=" + mesh, "--set", "refined.head.origin_m=[0, 0, 0]", "--set",
             "refined.head.measured=" + measured});
    RunWell({Program("recogniser"), "--replay", other, "--record", run, "--set",
             "refined.head.file=" + head});
    const auto as_told = nlohmann::json::parse(RunWell({Program("evaluate"), run, "--json", "-"}));
    EXPECT_GE(as_told["share_tracking"], 0.9);
    return as_told["raw"]["position_mm"]["norm"]["rmse"].get<double>();
  };
  const double measured_mm = position_mm("true");
  EXPECT_LT(measured_mm, 1);
  EXPECT_LT(measured_mm, 0.5 * position_mm("false"));
}

// Ten poses, each change a jump: where a part of the face lies in the part of the picture that is
// looked at first, it may look like another part.
TEST(EnrolProcessTest, TheSampleEnrolledOnFiveViewsIsTrackedAndNeverWrongAfterAJump) {
  const TemporaryFolder folder;
  const std::string data = Environment("VISAVIS_SOURCE_DIR") + "/tests/data/";
  const std::string views = folder / "views.lcm", jumps = folder / "jumps.lcm";
  const std::string head = folder / "head.yaml", offset = folder / "offset.json";
  RunWell({Program("log"), "import", data + "man_reference", views});
  RunWell({Program("log"), "import", data + "man_static", jumps});
  RunWell({Program("enrol"), views, "-o", head});
  const auto replay = [&](const std::string& log, const std::string& to, int seed) {
    RunWell({Program("recogniser"), "--replay", log, "--record", to, "--set",
             "refined.head.file=" + head, "--set", "seed=" + std::to_string(seed)});
  };
  replay(views, folder / "views.run.lcm", 1);
  RunWell({Program("evaluate"), folder / "views.run.lcm", "--fit-head-offset", offset});
  for (const int seed : {1, 2, 3}) {
    const std::string run = folder / "jumps.run.lcm";
    replay(jumps, run, seed);
    const auto figures = nlohmann::json::parse(
        RunWell({Program("evaluate"), run, "--head-offset", offset, "--json", "-"}));
    EXPECT_EQ(figures["share_tracking"], 1) << seed;
    EXPECT_EQ(figures["aligned"]["share_false_tracking"], 0) << seed;
    EXPECT_LT(figures["aligned"]["position_mm"]["norm"]["rmse"], 1.3) << seed;
    EXPECT_LT(figures["aligned"]["angle_deg"]["total"]["rmse"], 0.8) << seed;
  }
}

}  // namespace
}  // namespace visavis
