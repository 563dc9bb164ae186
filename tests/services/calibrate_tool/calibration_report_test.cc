#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/imgcodecs.hpp>

#include "services/calibrate_tool/calibration_text.h"
#include "services/calibrate_tool/canvas.h"
#include "services/calibrate_tool/report.h"
#include "tests/support/board_scene.h"
#include "tests/support/temporary_folder.h"

namespace visavis {
namespace {

using ::testing::HasSubstr;

class CalibrationReportTest : public ::testing::Test {
 protected:
  CalibrationReportTest() {
    BoardSpec spec;
    spec.square_mm = 60;
    spec.marker_mm = 45;
    scene_.emplace(MakeBoardScene(spec, 10, 1));
    arm_views_ = SeeAll(*scene_, 0.1, 1);
    for (const ArmView& view : arm_views_) views_.push_back(view.view);
    StereoSettings settings;
    settings.width = settings.left_width = 640;
    settings.height = settings.left_height = 480;
    stereo_ = CalibrateStereo(scene_->board, views_, settings);
    arm_views_[3].X_BH.translation().x() += 0.03;
    hand_eye_ = CalibrateHandEye(scene_->board, stereo_.rig, arm_views_, {});
  }
  /// Share of the picture's pixels that are not white within a part of it.
  static double Ink(const cv::Mat& picture, const cv::Rect& part) {
    const cv::Mat cut = picture(part);
    int inked = 0;
    for (int y = 0; y < cut.rows; ++y)
      for (int x = 0; x < cut.cols; ++x)
        inked += cut.at<cv::Vec3b>(y, x) != cv::Vec3b(255, 255, 255) ? 1 : 0;
    return static_cast<double>(inked) / part.area();
  }
  const TemporaryFolder folder_;
  std::optional<BoardScene> scene_;
  std::vector<ArmView> arm_views_;
  std::vector<StereoView> views_;
  StereoCalibration stereo_;
  HandEyeCalibration hand_eye_;
};

TEST_F(CalibrationReportTest, TheStereoPictureHasCoverageAndBarsForBothEyes) {
  DrawStereoReport(folder_ / "stereo.png", scene_->board, views_, stereo_);
  const cv::Mat picture = cv::imread(folder_ / "stereo.png");
  ASSERT_EQ(picture.cols, 1500);
  for (const cv::Rect& part : {cv::Rect(200, 200, 400, 300), cv::Rect(920, 200, 400, 300),
                               cv::Rect(110, 840, 600, 150), cv::Rect(830, 840, 600, 150)})
    EXPECT_GT(Ink(picture, part), 0.02) << part;
  EXPECT_EQ(Ink(picture, {0, 1045, 1500, 15}), 0);
}

TEST_F(CalibrationReportTest, TheHandEyePictureHasDirectionsAndResiduals) {
  DrawHandEyeReport(folder_ / "hand.png", arm_views_, hand_eye_);
  const cv::Mat picture = cv::imread(folder_ / "hand.png");
  ASSERT_EQ(picture.rows, 900);
  for (const cv::Rect& part :
       {cv::Rect(100, 120, 420, 420), cv::Rect(740, 120, 700, 300), cv::Rect(740, 500, 700, 300)})
    EXPECT_GT(Ink(picture, part), 0.02) << part;
}

TEST_F(CalibrationReportTest, AFileThatCannotBeWrittenIsNamed) {
  EXPECT_THAT([&] { DrawHandEyeReport("/nonexistent/a.png", arm_views_, hand_eye_); },
              ::testing::ThrowsMessage<std::runtime_error>(HasSubstr("/nonexistent/a.png")));
}

TEST_F(CalibrationReportTest, TheTextTellsEachViewAndMarksTheWorst) {
  const std::string stereo = StereoText(views_, stereo_);
  EXPECT_THAT(stereo, HasSubstr("\n    10      9.00"));
  EXPECT_THAT(stereo, HasSubstr("reprojection error 0.1"));
  EXPECT_THAT(stereo, HasSubstr("\nX_CL   -150."));
  const std::string hand = HandEyeText(arm_views_, hand_eye_);
  const std::size_t worst = hand.find("<- worse");
  ASSERT_NE(worst, std::string::npos);
  EXPECT_EQ(hand.find("<- worse", worst + 1), std::string::npos);
  EXPECT_EQ(hand.substr(hand.rfind('\n', worst) + 1, 6), "     4");
}

TEST_F(CalibrationReportTest, UncertaintiesReachTheRigFile) {
  RigDescription rig;
  AddUncertainty(hand_eye_, &rig);
  EXPECT_FALSE(rig.uncertainty.has_value());
  rig.uncertainty = UncertaintyOf(stereo_);
  AddUncertainty(hand_eye_, &rig);
  EXPECT_EQ(rig.uncertainty->right.fx, stereo_.right_sigma.fx);
  EXPECT_EQ(rig.uncertainty->X_CL.p_m[2], stereo_.p_CL_sigma_m[2]);
  ASSERT_TRUE(rig.uncertainty->X_HC.has_value());
  EXPECT_EQ(rig.uncertainty->X_HC->r_rad[1], hand_eye_.r_HC_sigma_rad[1]);
}

TEST(CanvasTest, ScalesEndAtRoundNumbers) {
  EXPECT_DOUBLE_EQ(RoundUp(0.031), 0.05);
  EXPECT_DOUBLE_EQ(RoundUp(1.7), 2);
  EXPECT_DOUBLE_EQ(RoundUp(2), 2);
  EXPECT_DOUBLE_EQ(RoundUp(70), 100);
  EXPECT_DOUBLE_EQ(RoundUp(0), 1);
}

}  // namespace
}  // namespace visavis
