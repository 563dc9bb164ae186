#include "services/stereo_capture/picture_source.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <thread>

#include "common/core/clock.h"
#include "services/stereo_capture/picture_format.h"
#include "services/stereo_capture/sources.h"
#include "services/stereo_capture/uvc_camera.h"
#include "tests/support/temporary_folder.h"

namespace visavis {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

/// Pictures 0 to 3 of both sides, each filled with 10 times its number, the left ones plus 100.
class PictureSourceTest : public ::testing::Test {
 protected:
  PictureSourceTest() {
    std::ofstream csv(folder_ / "frames.csv");
    csv << "frame,time_s,left,right\n";
    for (int i = 0; i < 4; ++i) {
      const std::string number = std::to_string(i);
      cv::imwrite(folder_ / ("left_" + number + ".png"), Picture(100 + 10 * i));
      cv::imwrite(folder_ / ("right_" + number + ".png"), Picture(10 * i));
      csv << i << "," << i << ",left_" << number << ".png,right_" << number << ".png\n";
    }
    config_.source = "folder";
    config_.folder = folder_ / ".";
    config_.camera.frame_rate_hz = 100;
    config_.loop = false;
  }
  static cv::Mat Picture(int value) { return {8, 12, CV_8UC3, cv::Scalar(value, 1, 2)}; }

  /// All frames until the source has finished, or @p count.
  std::vector<CapturedFrame> Run(std::size_t count = 1000) {
    const StereoSources sources = MakeSources(config_, rig_sizes_, &queue_);
    EXPECT_EQ(sources[0], sources[1]);
    std::vector<CapturedFrame> frames;
    const double end_s = MonotonicSeconds() + 5;
    while (frames.size() < count && MonotonicSeconds() < end_s) {
      if (auto frame = queue_.Pop()) {
        frames.push_back(std::move(*frame));
      } else if (sources[0]->finished()) {
        break;
      } else {
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
      }
    }
    report_ = sources[0]->Report();
    return frames;
  }

  const TemporaryFolder folder_;
  StereoCaptureConfig config_;
  std::array<std::optional<PictureSize>, 2> rig_sizes_;
  FrameQueue queue_{64};
  CameraReport report_;
};

TEST_F(PictureSourceTest, AFolderGivesItsPairsAtTheRateAndEnds) {
  const auto frames = Run();
  ASSERT_EQ(frames.size(), 8u);
  for (std::size_t i = 0; i < frames.size(); i += 2) {
    const auto n = static_cast<int>(i / 2);
    EXPECT_EQ(frames[i].side, Side::kLeft);
    EXPECT_EQ(frames[i + 1].side, Side::kRight);
    EXPECT_EQ(frames[i].image.format, PixelFormat::kRgb);
    EXPECT_EQ(frames[i].image.data[2], 100 + 10 * n);  // blue was the first of OpenCV's BGR
    EXPECT_EQ(frames[i + 1].image.data[2], 10 * n);
    EXPECT_TRUE(frames[i].is_host_time);
    EXPECT_EQ(frames[i].device_ns, frames[i + 1].device_ns);
    EXPECT_EQ(frames[i].device_ns - frames[0].device_ns, n * 10'000'000);
  }
  EXPECT_EQ(report_.frames, 4);
}

TEST_F(PictureSourceTest, ItBeginsAnewAtTheEndIfItShall) {
  config_.loop = true;
  const auto frames = Run(12);
  ASSERT_EQ(frames.size(), 12u);
  EXPECT_EQ(frames[8].image.data[2], 100);
  EXPECT_GT(frames[8].id, frames[7].id);
}

TEST_F(PictureSourceTest, PatternsOfPicturesAreVideosToo) {
  config_.source = "video";
  config_.left.device = folder_ / "left_%d.png";
  config_.right.device = folder_ / "right_%d.png";
  const auto frames = Run();
  ASSERT_EQ(frames.size(), 8u);
  EXPECT_EQ(frames[7].image.data[2], 30);
}

TEST_F(PictureSourceTest, TheFormatIsTheOneAskedFor) {
  for (const auto& [name, format] :
       std::vector<std::pair<std::string, PixelFormat>>{{"keep", PixelFormat::kBgr},
                                                        {"BGR8", PixelFormat::kBgr},
                                                        {"Mono8", PixelFormat::kGray}}) {
    config_.camera.pixel_format = name;
    const auto frames = Run();
    ASSERT_EQ(frames.size(), 8u);
    EXPECT_EQ(frames[0].image.format, format);
    EXPECT_EQ(frames[0].image.size, frames[0].pixels->size());
  }
  config_.camera.pixel_format = "BayerRG8";
  EXPECT_THAT([&] { Run(); }, ThrowsMessage<std::invalid_argument>(
                                  HasSubstr("camera.pixel_format: BayerRG8: must be keep, Mono8")));
}

TEST_F(PictureSourceTest, APictureThatCannotBeReadIsCountedAndLeftOut) {
  std::ofstream(folder_ / "left_2.png") << "no picture";
  EXPECT_EQ(Run().size(), 6u);
  EXPECT_EQ(report_.bad_frames, 1);
  EXPECT_THAT(report_.last_error, HasSubstr("frames.csv:4: "));
  EXPECT_THAT(report_.last_error, HasSubstr("left_2.png: is no picture"));
}

TEST_F(PictureSourceTest, PicturesOfAnotherSizeThanTheRigsAreRefused) {
  rig_sizes_ = {PictureSize{12, 8}, PictureSize{12, 8}};
  EXPECT_EQ(Run().size(), 8u);
  cv::imwrite(folder_ / "left_2.png", cv::Mat(6, 12, CV_8UC3, cv::Scalar(1, 2, 3)));
  EXPECT_EQ(Run().size(), 6u);
  EXPECT_EQ(report_.last_error, "rig_file: 12x8: the left picture is 12x6");
  rig_sizes_[1] = {640, 480};
  EXPECT_THAT([&] { Run(); }, ThrowsMessage<std::invalid_argument>(
                                  HasSubstr("rig_file: 640x480: the right picture is 12x8")));
}

TEST_F(PictureSourceTest, NothingToReadIsRefusedWithItsName) {
  std::ofstream(folder_ / "left_0.png") << "no picture";
  EXPECT_THAT([&] { Run(); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("left_0.png: is no picture")));
  std::ofstream(folder_ / "frames.csv") << "frame,time_s,left,right\n";
  EXPECT_THAT([&] { Run(); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("must have at least one frame")));
  config_.source = "video";
  config_.left.device = "/nowhere/%d.png";
  EXPECT_THAT([&] { Run(); }, ThrowsMessage<std::invalid_argument>(HasSubstr(
                                  "left.device: /nowhere/%d.png: must be a video, or a pattern")));
}

TEST(PictureFormatTest, PicturesBecomeFramesWithoutPadding) {
  const cv::Mat large(10, 20, CV_8UC3, cv::Scalar(1, 2, 3));
  const cv::Mat part = large(cv::Rect(2, 2, 7, 5));  // rows are apart by 60 bytes
  const CapturedFrame frame = ToFrame(part, "RGB8", Side::kLeft);
  EXPECT_EQ(frame.image.stride, 21);
  EXPECT_EQ(frame.image.size, 105u);
  for (int i = 0; i < 105; ++i) EXPECT_EQ(frame.image.data[i], 3 - i % 3);
  const CapturedFrame gray = ToFrame(cv::Mat(3, 4, CV_8UC1, cv::Scalar(9)), "RGB8", Side::kLeft);
  EXPECT_EQ(gray.image.format, PixelFormat::kRgb);
  EXPECT_EQ(gray.image.data[35], 9);
  EXPECT_THROW(ToFrame(cv::Mat(3, 4, CV_16UC1), "keep", Side::kLeft), std::invalid_argument);
  EXPECT_THROW(ToFrame(cv::Mat(), "keep", Side::kLeft), std::invalid_argument);
}

TEST(UvcCameraTest, ADeviceThatIsMissingOrNoCameraIsWaitedForAndTold) {
  FrameQueue queue(4);
  const auto text_of = [&](const std::string& device) {
    const UvcCamera camera(Side::kRight, {device, {}}, CameraConfig{}, {}, &queue);
    const double end_s = MonotonicSeconds() + 5;
    while (camera.Report().attempts == 0 && MonotonicSeconds() < end_s)
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    return camera.Report().text;
  };
  EXPECT_THAT(text_of("/dev/video77"),
              HasSubstr("right camera: right.device: /dev/video77: no such device file"));
  EXPECT_THAT(text_of("/dev/null"), HasSubstr("right.device: /dev/null: cannot be opened"));
}

}  // namespace
}  // namespace visavis
