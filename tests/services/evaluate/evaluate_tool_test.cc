#include "services/evaluate/evaluate_tool.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/support/environment.h"
#include "tests/support/run_log.h"
#include "tests/support/temporary_folder.h"

namespace visavis {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;
using Json = nlohmann::ordered_json;

struct Result {
  int exit_code;
  std::string out, err;
};

Result Evaluate(const std::vector<std::string>& args) {
  std::vector<const char*> argv{"visavis-evaluate"};
  for (const auto& arg : args) argv.push_back(arg.c_str());
  std::ostringstream out, err;
  const int exit_code = RunEvaluateTool(static_cast<int>(argv.size()), argv.data(), out, err);
  return {exit_code, out.str(), err.str()};
}

class EvaluateToolTest : public ::testing::Test {
 protected:
  EvaluateToolTest() {
    RunLog log(log_path());
    Vector6d error;
    error << 0.003, 0, -0.004, 2 * M_PI / 180, 0, 0;
    for (std::int64_t i = 0; i < 40; ++i) {
      log.Frame(100'000 * i, i < 3 ? RunLog::kSearching : RunLog::kTracking, Pose(0, 0, 1), error);
      log.Latency(100'000 * i, static_cast<double>(1 + i));
    }
  }
  std::string log_path() const { return folder_ / "run.lcm"; }

  const TemporaryFolder folder_;
};

TEST_F(EvaluateToolTest, JsonHasTheSchemaAndItsNumbersAreInMmAndDeg) {
  const Result result = Evaluate({log_path(), "--json", "-"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  const Json json = Json::parse(result.out);  // nothing else is on stdout
  const auto keys = [](const Json& object) {
    std::vector<std::string> names;
    for (const auto& item : object.items()) names.push_back(item.key());
    return names;
  };
  using ::testing::ElementsAre;
  EXPECT_THAT(keys(json), ElementsAre("schema", "frames", "frames_with_truth", "settle_s",
                                      "share_tracking", "first_lock_s", "recovery_frames", "raw",
                                      "aligned", "latency_ms", "head_offset"));
  EXPECT_EQ(json["schema"], 1);
  EXPECT_EQ(json["frames"], 40);
  EXPECT_EQ(json["frames_with_truth"], 40);
  EXPECT_EQ(json["settle_s"], 2);
  EXPECT_DOUBLE_EQ(json["share_tracking"], 37 / 40.0);
  EXPECT_DOUBLE_EQ(json["first_lock_s"], 0.3);
  EXPECT_EQ(json["recovery_frames"].dump(), R"({"count":0,"median":null,"max":null})");
  const Json& raw = json["raw"];
  EXPECT_THAT(keys(raw), ElementsAre("position_mm", "angle_deg", "share_within_15mm_5deg",
                                     "share_false_tracking"));
  EXPECT_THAT(keys(raw["position_mm"]), ElementsAre("x", "y", "z", "norm"));
  EXPECT_THAT(keys(raw["angle_deg"]), ElementsAre("phi", "theta", "psi", "total"));
  EXPECT_THAT(keys(raw["position_mm"]["norm"]), ElementsAre("rmse", "mean", "max", "bias"));
  const auto expect = [](const Json& s, double rmse, double bias) {
    EXPECT_NEAR(s["rmse"], rmse, 1e-9);
    EXPECT_NEAR(s["mean"], rmse, 1e-9);
    EXPECT_NEAR(s["max"], rmse, 1e-9);
    EXPECT_NEAR(s["bias"], bias, 1e-9);
  };
  expect(raw["position_mm"]["x"], 3, 3);
  expect(raw["position_mm"]["y"], 0, 0);
  expect(raw["position_mm"]["z"], 4, -4);
  expect(raw["position_mm"]["norm"], 5, 5);
  expect(raw["angle_deg"]["phi"], 2, 2);
  expect(raw["angle_deg"]["theta"], 0, 0);
  expect(raw["angle_deg"]["psi"], 0, 0);
  expect(raw["angle_deg"]["total"], 2, 2);
  EXPECT_DOUBLE_EQ(raw["share_within_15mm_5deg"], 37 / 40.0);
  EXPECT_EQ(raw["share_false_tracking"], 0);
  EXPECT_TRUE(json["aligned"].is_null());
  EXPECT_TRUE(json["head_offset"].is_null());
  EXPECT_DOUBLE_EQ(json["latency_ms"]["p50"], 20.5);
  EXPECT_DOUBLE_EQ(json["latency_ms"]["p90"], 36.1);
  EXPECT_NEAR(json["latency_ms"]["p99"], 39.61, 1e-12);
  EXPECT_DOUBLE_EQ(json["latency_ms"]["max"], 40);
}

TEST_F(EvaluateToolTest, UnknownsAreNull) {
  RunLog log(folder_ / "no_truth.lcm");
  log.Estimate(0, RunLog::kTracking, Pose(0, 0, 1));
  log.Close();
  const Json json = Json::parse(Evaluate({folder_ / "no_truth.lcm", "--json", "-"}).out);
  EXPECT_EQ(json["frames"], 1);
  EXPECT_EQ(json["frames_with_truth"], 0);
  EXPECT_TRUE(json["share_tracking"].is_null());
  EXPECT_TRUE(json["first_lock_s"].is_null());
  EXPECT_TRUE(json["raw"]["position_mm"]["x"]["rmse"].is_null());
  EXPECT_TRUE(json["raw"]["angle_deg"]["total"]["bias"].is_null());
  EXPECT_TRUE(json["raw"]["share_within_15mm_5deg"].is_null());
  EXPECT_EQ(json["latency_ms"].dump(), R"({"p50":null,"p90":null,"p99":null,"max":null})");
}

TEST_F(EvaluateToolTest, AnOffsetFittedOnOneLogAlignsAnother) {
  const std::string offset = folder_ / "offset.json";
  EXPECT_EQ(Evaluate({log_path(), "--fit-head-offset", offset}).exit_code, 0);
  const Result result = Evaluate({log_path(), "--head-offset", offset, "--json", "-"});
  const Json json = Json::parse(result.out);
  EXPECT_NEAR(json["raw"]["position_mm"]["norm"]["rmse"], 5, 1e-9);
  EXPECT_NEAR(json["aligned"]["position_mm"]["norm"]["max"], 0, 1e-9);
  EXPECT_NEAR(json["aligned"]["angle_deg"]["total"]["max"], 0, 1e-6);
  EXPECT_NEAR(json["head_offset"]["p_m"][0], -0.003, 1e-12);
  EXPECT_NEAR(json["head_offset"]["p_m"][2], 0.004, 1e-12);
  EXPECT_NEAR(json["head_offset"]["q_wxyz"][3], std::sin(M_PI / 180), 1e-12);
  EXPECT_EQ(json["head_offset"]["source"], offset);
  const Json own = Json::parse(Evaluate({log_path(), "--align-head-frame", "--json", "-"}).out);
  EXPECT_NEAR(own["aligned"]["position_mm"]["norm"]["max"], 0, 1e-9);
  EXPECT_EQ(own["head_offset"]["source"], "fit on " + log_path());
}

TEST_F(EvaluateToolTest, TheTableFitsATerminalAndJsonGoesToItsFile) {
  const Result result = Evaluate({log_path(), "--align-head-frame", "--json", folder_ / "a.json"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.out, HasSubstr("distance mm        5.00       5.00       5.00       5.00"));
  EXPECT_THAT(result.out, HasSubstr("first lock after 0.300 s"));
  std::istringstream lines(result.out.substr(result.out.find('\n') + 1));
  for (std::string line; std::getline(lines, line);) {
    if (line.find(log_path()) != std::string::npos) continue;  // as long as the user's path
    EXPECT_LE(line.size(), 80u) << line;
  }
  std::ifstream file(folder_ / "a.json");
  EXPECT_EQ(Json::parse(file)["frames"], 40);
}

TEST_F(EvaluateToolTest, ARunThatNeverTrackedIsEvaluatedButNotFitted) {
  RunLog log(folder_ / "lost.lcm");
  log.Frame(0, RunLog::kSearching, Pose(0, 0, 1));
  log.Close();
  const Result aligned = Evaluate({folder_ / "lost.lcm", "--align-head-frame", "--json", "-"});
  EXPECT_EQ(aligned.exit_code, 0);
  EXPECT_THAT(aligned.err, HasSubstr("0 TRACKING frames with truth: must be at least 5"));
  EXPECT_TRUE(Json::parse(aligned.out)["aligned"].is_null());
  const Result fit = Evaluate({folder_ / "lost.lcm", "--fit-head-offset", folder_ / "offset.json"});
  EXPECT_EQ(fit.exit_code, 2);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "offset.json"));
}

TEST_F(EvaluateToolTest, BadUseAndBadInputExitWith2AndOneLine) {
  std::ofstream(folder_ / "text.lcm") << "no log";
  RunLog log(folder_ / "truth.lcm");
  log.Truth(0, Pose(0, 0, 1));
  log.Close();
  for (const auto& args : std::vector<std::vector<std::string>>{
           {},
           {folder_ / "none.lcm"},
           {folder_ / "text.lcm"},
           {folder_ / "truth.lcm"},
           {log_path(), "--bogus"},
           {log_path(), "--head-offset", folder_ / "none.json"},
           {log_path(), "--head-offset", folder_ / "text.lcm"},
           {log_path(), "--head-offset", folder_ / "text.lcm", "--align-head-frame"},
           {log_path(), "--prefix", "ROBOT2_"}}) {
    const Result result = Evaluate(args);
    EXPECT_EQ(result.exit_code, 2) << ::testing::PrintToString(args);
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    EXPECT_THAT(result.err, StartsWith("visavis-evaluate: "));
    EXPECT_EQ(result.out, "");
  }
}

TEST_F(EvaluateToolTest, FiguresArePngFiles) {
  EXPECT_EQ(Evaluate({log_path(), "--figures", folder_ / "figures"}).exit_code, 0);
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder_ / "figures")) {
    ++files;
    std::ifstream file(entry.path(), std::ios::binary);
    std::string head(8, '\0');
    file.read(head.data(), 8);
    EXPECT_EQ(head, "\x89PNG\r\n\x1a\n") << entry.path();
    EXPECT_GT(entry.file_size(), 5000u) << entry.path();
  }
  EXPECT_EQ(files, 3);
}

TEST_F(EvaluateToolTest, WithoutGnuplotTheFiguresFailAndSayHowToGetIt) {
  const std::string path = Environment("PATH");
  setenv("PATH", "/nonexistent", 1);
  const Result result = Evaluate({log_path(), "--figures", folder_ / "figures"});
  setenv("PATH", path.c_str(), 1);
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.err, HasSubstr("gnuplot-nox"));
  EXPECT_THAT(result.out, HasSubstr("distance mm"));  // the table comes all the same
}

}  // namespace
}  // namespace visavis
