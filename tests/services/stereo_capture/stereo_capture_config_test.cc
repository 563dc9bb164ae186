#include "services/stereo_capture/stereo_capture_config.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>

#include "common/config/config_reader.h"
#include "common/config/config_writer.h"
#include "tests/support/config_refusal.h"
#include "tests/support/shipped_config.h"

namespace visavis {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

TEST(StereoCaptureConfigTest, TheShippedFileHoldsEveryDefault) {
  ExpectShippedFileHoldsEveryDefault<StereoCaptureConfig>(
      "services/stereo_capture/stereo_capture.yaml");
}

TEST(StereoCaptureConfigTest, FeaturesAreReadByNameFromFileAndFlag) {
  const auto config = LoadConfig<StereoCaptureConfig>(
      "", {"left.features={Gamma: 0.8, LineMode: Output}", "right.features.GainRaw=3"});
  EXPECT_EQ(config.left.features.at("Gamma"), "0.8");
  EXPECT_EQ(config.left.features.at("LineMode"), "Output");
  EXPECT_EQ(config.right.features.at("GainRaw"), "3");
}

TEST(StereoCaptureConfigTest, TheToleranceIsAQuarterOfThePeriodUnlessGiven) {
  StereoCaptureConfig config;
  config.camera.frame_rate_hz = 50;
  EXPECT_EQ(config.tolerance_us(), 5000);
  config.tolerance_ms = 2.5;
  EXPECT_EQ(config.tolerance_us(), 2500);
}

TEST(StereoCaptureConfigTest, AToleranceFromHalfAPeriodOnIsRefused) {
  for (const double rate_hz : {10.0, 30.0, 60.0, 200.0}) {
    StereoCaptureConfig config;
    config.camera.frame_rate_hz = rate_hz;
    config.tolerance_ms = 0.999 * 500 / rate_hz;
    EXPECT_NO_THROW(config.ValidateOrThrow()) << rate_hz;
    config.tolerance_ms = 1.001 * 500 / rate_hz;
    ExpectRefusal([&] { config.ValidateOrThrow(); }, "tolerance_ms", "", "below half a period");
  }
}

TEST(StereoCaptureConfigTest, ASlowCameraIsGivenTwoAndAHalfPeriodsBeforeItIsStalled) {
  CameraConfig config;
  EXPECT_DOUBLE_EQ(config.stall_s(), 0.3);
  config.frame_rate_hz = 5;
  EXPECT_DOUBLE_EQ(config.stall_s(), 0.5);
}

void ExpectRefused(const std::string& assignment, const std::string& key, const std::string& rule) {
  EXPECT_THAT([&] { LoadConfig<StereoCaptureConfig>("", {assignment}); },
              ThrowsMessage<ConfigError>(AllOf(HasSubstr(key), HasSubstr(rule))))
      << assignment;
}

TEST(StereoCaptureConfigTest, RefusesBadValuesByKeyAndRule) {
  ExpectRefused("source=scanner", "source", "must be one of aravis");
  ExpectRefused("left.device=''", "left.device", "must name the left camera");
  ExpectRefused("camera.pixel_format=YUV422", "camera.pixel_format", "must be one of keep Mono8");
  ExpectRefused("camera.frame_rate_hz=0", "camera.frame_rate_hz", "0.1 to 1000 Hz");
  ExpectRefused("camera.width_px=640", "camera.height_px", "must be 0 as width_px is");
  ExpectRefused("camera.packet_size_bytes=100", "camera.packet_size_bytes", "at least 220");
  ExpectRefused("camera.trigger=action", "camera.ptp", "must be true");
  ExpectRefused("camera.fourcc=MJPEG", "camera.fourcc", "four letters");
  ExpectRefused("camera.num_buffers=1", "camera.num_buffers", "3 to 1000");
  ExpectRefused("image_format=png", "image_format", "raw jpeg");
  ExpectRefused("jpeg_quality=0", "jpeg_quality", "1 to 100");
  ExpectRefused("left.colour=red", "left.colour", "unknown key");
  EXPECT_THAT(
      [&] {
        LoadConfig<StereoCaptureConfig>("", {"camera.exposure=fixed", "camera.exposure_ms=40"});
      },
      ThrowsMessage<ConfigError>(HasSubstr("must be at most the period, 33.3333 ms")));
}

}  // namespace
}  // namespace visavis
