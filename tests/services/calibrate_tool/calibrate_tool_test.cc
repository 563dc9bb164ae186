// visavis-calibrate as its users call it, on logs of rendered pictures.
#include "services/calibrate_tool/calibrate_tool.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "common/config/config_reader.h"
#include "common/rigs/rig_file.h"
#include "tests/support/board_log.h"
#include "tests/support/temporary_folder.h"

namespace visavis {
namespace {

using ::testing::HasSubstr;

constexpr double kDegree = M_PI / 180;

struct Result {
  int exit_code;
  std::string out, err;
};

Result Calibrate(const std::vector<std::string>& args) {
  std::vector<const char*> argv{"visavis-calibrate"};
  for (const auto& arg : args) argv.push_back(arg.c_str());
  std::ostringstream out, err;
  const int exit_code = RunCalibrateTool(
      static_cast<int>(argv.size()), argv.data(), [] { return false; }, out, err);
  return {exit_code, out.str(), err.str()};
}

/// What must be refused: the one line it prints.
std::string Refusal(const std::vector<std::string>& args) {
  const Result result = Calibrate(args);
  EXPECT_EQ(result.exit_code, 2) << result.err;
  EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
  return result.err;
}

/// A log of 14 postures, rendered once for all tests, and what else the tool needs.
class CalibrateToolTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new TemporaryFolder;
    scene_ = new BoardScene(MakeBoardScene(SmallBoard(9, 7), 14, 2));
    WriteBoardLog(*scene_, log());
    RigDescription nominal;
    nominal.rig = scene_->rig;
    nominal.rig.right.fx = nominal.rig.left.fx = 700;
    SaveRigFile(nominal, *folder_ / "armless.yaml");
    nominal.arm = GantryArm();
    SaveRigFile(nominal, *folder_ / "nominal.yaml");
    std::ofstream(board()) << "kind: charuco\ncolumns: 9\nrows: 7\nsquare_mm: 60\nmarker_mm: 45\n";
  }
  static void TearDownTestSuite() {
    delete scene_;
    delete folder_;
  }
  static std::string log() { return *folder_ / "board.lcm"; }
  static std::string board() { return *folder_ / "board.yaml"; }

  static TemporaryFolder* folder_;
  static BoardScene* scene_;
};

TemporaryFolder* CalibrateToolTest::folder_ = nullptr;
BoardScene* CalibrateToolTest::scene_ = nullptr;

// Corners of rendered pictures are found to about 0.05 px: the bounds are five of the standard
// deviations that the tool tells, and those are below what is asked of 60 views with 0.2 px.
TEST_F(CalibrateToolTest, ALogOfPicturesBecomesARigWithHandEyeAndReports) {
  const std::string rig = *folder_ / "rig.yaml", whole = *folder_ / "whole.yaml";
  const Result stereo =
      Calibrate({"stereo", log(), "--board", board(), "-o", rig, "--rig", *folder_ / "nominal.yaml",
                 "--report", *folder_ / "stereo.png", "--min-change-px", "10"});
  ASSERT_EQ(stereo.exit_code, 0) << stereo.err;
  EXPECT_THAT(stereo.out, HasSubstr("14 views kept of 19 pairs: 5 blurred"));
  const RigDescription found = LoadRigFile(rig);
  ASSERT_TRUE(found.uncertainty.has_value());
  const StereoRig& truth = scene_->rig;
  const RigidTransform error = truth.X_CL.inverse() * found.rig.X_CL;
  for (int i = 0; i < 3; ++i) {
    const double p_sigma = found.uncertainty->X_CL.p_m[i],
                 r_sigma = found.uncertainty->X_CL.r_rad[i];
    EXPECT_LT(std::abs((truth.X_CL.translation() - found.rig.X_CL.translation())[i]), 5 * p_sigma);
    EXPECT_LT(std::abs(LogRotation(error.linear())[i]), 5 * r_sigma);
    EXPECT_LT(p_sigma, 3e-4);
    EXPECT_LT(r_sigma, 0.04 * kDegree);
  }
  EXPECT_NEAR(found.rig.right.fx, truth.right.fx, 5 * found.uncertainty->right.fx);
  EXPECT_NEAR(found.rig.left.cx, truth.left.cx, 5 * found.uncertainty->left.cx);
  EXPECT_FALSE(found.X_HC.has_value());
  ASSERT_TRUE(found.arm.has_value());

  const Result hand = Calibrate({"hand-eye", log(), "--board", board(), "--rig", rig, "-o", whole,
                                 "--report", *folder_ / "hand.png"});
  ASSERT_EQ(hand.exit_code, 0) << hand.err;
  EXPECT_THAT(hand.out, HasSubstr("of these 0 without arm state, 0 with the arm moving"));
  const RigDescription with_hand = LoadRigFile(whole);
  ASSERT_TRUE(with_hand.X_HC && with_hand.uncertainty && with_hand.uncertainty->X_HC);
  EXPECT_LT((with_hand.X_HC->translation() - scene_->X_HC.translation()).norm(), 7e-4);
  EXPECT_LT(LogRotation(with_hand.X_HC->linear().transpose() * scene_->X_HC.linear()).norm(),
            0.04 * kDegree);
  EXPECT_EQ(with_hand.rig.right.fx, found.rig.right.fx);
  for (const char* png : {"stereo.png", "hand.png"})
    EXPECT_GT(std::filesystem::file_size(*folder_ / png), 10'000u);
}

TEST_F(CalibrateToolTest, SquaresAsMeasuredScaleTheRig) {
  const std::string rig = *folder_ / "scaled.yaml";
  const Result result = Calibrate({"stereo", log(), "--board", board(), "-o", rig, "--square-mm",
                                   "30", "--views", "10", "--distortion", "4"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("10 views kept"));
  const RigDescription found = LoadRigFile(rig);
  EXPECT_NEAR(found.rig.baseline_m(), 0.5 * scene_->rig.baseline_m(), 2e-4);
  EXPECT_EQ(found.rig.right.distortion[4], 0);
}

TEST_F(CalibrateToolTest, BoardWritesAPdfAndWhatTheOthersRead) {
  const std::string pdf = *folder_ / "print.pdf";
  const Result result = Calibrate({"board", pdf, "--columns", "9", "--rows", "6", "--square-mm",
                                   "40", "--paper", "a3", "--dictionary", "5x5"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("360 x 240 mm"));
  EXPECT_GT(std::filesystem::file_size(pdf), 5'000u);
  const auto spec = LoadConfig<BoardSpec>(*folder_ / "print.yaml");
  EXPECT_EQ(spec.columns, 9);
  EXPECT_EQ(spec.marker_mm, 30);
  EXPECT_EQ(spec.dictionary, "5x5");
}

TEST_F(CalibrateToolTest, BadInputGetsOneLineAndExitCode2) {
  const std::string out = *folder_ / "never.yaml";
  const std::vector<std::string> stereo = {"stereo", log(), "-o", out};
  const auto with = [](std::vector<std::string> args, const std::vector<std::string>& more) {
    args.insert(args.end(), more.begin(), more.end());
    return args;
  };
  EXPECT_THAT(Refusal({"board", *folder_ / "a.png"}), HasSubstr("a.png: must end in .pdf"));
  EXPECT_THAT(Refusal({"board", *folder_ / "a.pdf", "--square-mm", "50"}),
              HasSubstr("must fit on 297 x 210 mm"));
  EXPECT_THAT(Refusal({"board", "/nonexistent/a.pdf"}), HasSubstr("/nonexistent/a.pdf: must lie"));
  EXPECT_THAT(Refusal({"board", *folder_ / "a.pdf", "--kind", "chessboard", "--columns", "11",
                       "--rows", "9"}),
              HasSubstr("rows: 9: must be even where columns is odd"));
  EXPECT_THAT(Refusal(with(stereo, {"--board", "/none.yaml"})), HasSubstr("/none.yaml: cannot be"));
  std::ofstream(*folder_ / "bad.yaml") << "columns: 9\nrows: two\n";
  EXPECT_THAT(Refusal(with(stereo, {"--board", *folder_ / "bad.yaml"})),
              HasSubstr("bad.yaml:2: rows: two: must be a whole number"));
  EXPECT_THAT(Refusal({"stereo", "--board", board(), "-o", out}),
              HasSubstr("LOG or --live: one of the two must be given"));
  EXPECT_THAT(Refusal({"stereo", log(), "--board", board(), "-o", "/nonexistent/r.yaml"}),
              HasSubstr("/nonexistent/r.yaml: must lie in a folder that exists"));
  EXPECT_THAT(Refusal({"stereo", board(), "--board", board(), "-o", out}),
              HasSubstr("board.yaml: must be an LCM event log"));
  EXPECT_THAT(Refusal({"hand-eye", log(), "--board", board(), "-o", out}), HasSubstr("--rig"));
  EXPECT_THAT(Refusal({"hand-eye", log(), "--board", board(), "-o", out, "--rig",
                       *folder_ / "armless.yaml"}),
              HasSubstr("armless.yaml: arm: missing: must be given here or by STEREO_RIG"));
  EXPECT_FALSE(std::filesystem::exists(out));
}

TEST_F(CalibrateToolTest, AnotherBoardThanTheOneSeenIsToldByWhatWasLeftOut) {
  std::ofstream(*folder_ / "other.yaml") << "kind: charuco\ncolumns: 9\nrows: 7\nsquare_mm: 60\n"
                                            "marker_mm: 45\ndictionary: 6x6\n";
  EXPECT_THAT(
      Refusal({"stereo", log(), "--board", *folder_ / "other.yaml", "-o", *folder_ / "never.yaml"}),
      HasSubstr("0 views kept of 19 pairs: 19 without enough of the board in both images: "
                "must be at least 8 views; is the board the one given?"));
}

}  // namespace
}  // namespace visavis
