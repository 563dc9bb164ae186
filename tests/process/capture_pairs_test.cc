// What two healthy cameras give.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "common/convert/image_message.h"
#include "common/image/image_decoder.h"
#include "common/rigs/demo_rig.h"
#include "common/rigs/rig_file.h"
#include "tests/support/capture_test.h"
#include "tests/support/temporary_folder.h"

namespace visavis {
namespace {

using CapturePairsTest = CaptureTest;

TEST_F(CapturePairsTest, MessagesCarrySizeTimeAndMetadataAndTheRigComesOnceASecond) {
  const TemporaryFolder folder;
  RigDescription rig = DemoRig();
  rig.rig.right.width = rig.rig.left.width = 320;
  rig.rig.right.height = rig.rig.left.height = 240;
  SaveRigFile(rig, folder / "rig.yaml");
  options_.settings = {"rig_file=" + (folder / "rig.yaml"), "camera.exposure=fixed",
                       "camera.exposure_ms=4", "camera.gain=fixed", "camera.gain_db=3"};
  CaptureHarness harness(options_);
  ASSERT_TRUE(harness.ReceivePairs(5, 10)) << harness.process().Err();
  const images_t& images = harness.last_images();
  const StereoImages pair = FromMessage(images, rig.rig);
  ASSERT_TRUE(pair.left && pair.right);
  EXPECT_EQ(pair.right->format, PixelFormat::kRgb);
  for (std::size_t i = 0; i < 2; ++i) {
    const image_t& image = images.images[i];
    EXPECT_EQ(FindMetadata(image, "seq"), harness.events().back().seq);
    EXPECT_EQ(FindMetadata(image, "exposure_us"), 4000);
    EXPECT_EQ(FindMetadata(image, "gain_db"), 3);
    EXPECT_TRUE(FindMetadata(image, "camera_us"));
    // What is the left one's time minus the right one's, by both messages' own words.
    EXPECT_EQ(FindMetadata(image, "skew_us"), images.images[0].utime - images.images[1].utime);
  }
  EXPECT_EQ(images.image_types, (std::vector<std::int16_t>{images_t::LEFT, images_t::RIGHT}));
  EXPECT_EQ(images.utime, images.images[1].utime);
  // The middle of an exposure that ended when the frame was sent, at a multiple of the period. The
  // map's error is the link's least delay, which a busy machine makes a few ms.
  const std::int64_t tick_us = *harness.events().back().right_tick * 33333;
  EXPECT_NEAR(static_cast<double>(images.utime - tick_us), -2000, 5000);
  EXPECT_TRUE(harness.Receive(3, [&] { return harness.num_rigs() >= 2; }));
}

TEST_F(CapturePairsTest, JpegAndBayerAreWhatTheConfigurationSays) {
  options_.settings = {"image_format=jpeg", "camera.pixel_format=BayerRG8", "jpeg_quality=80"};
  CaptureHarness harness(options_);
  ASSERT_TRUE(harness.Receive(10, [&] { return harness.events().size() > 3; }))
      << harness.process().Err();
  const ImageView image = FromMessage(harness.last_images().images[0]);
  EXPECT_EQ(image.format, PixelFormat::kJpeg);
  ImageDecoder decoder;
  EXPECT_EQ(decoder.Decode(image).width, 320);
}

TEST_F(CapturePairsTest, SoftwareTriggersExposeBothTogether) {
  options_.settings = {"camera.trigger=software"};
  CaptureHarness harness(options_);
  ASSERT_TRUE(harness.ReceivePairs(40, 10)) << harness.process().Err();
}

TEST_F(CapturePairsTest, DebiansOwnFakeCameraServesAsTheOtherOne) {
  const char* const program = "/usr/bin/arv-fake-gv-camera-0.8";
  if (access(program, X_OK) != 0) GTEST_SKIP() << "needs aravis-tools";
  options_.power_left = false;
  options_.settings = {"camera.width_px=320", "camera.height_px=240"};
  CaptureHarness harness(options_);
  ChildProcess peer({program, "-i", "127.0.0.1", "-s", "LEFT"});
  ASSERT_TRUE(harness.Receive(10, [&] { return harness.status().processed > 60; }))
      << harness.process().Err();
  EXPECT_TRUE(harness.Receive(2.5, [&] { return harness.Counter("pairs") > 30; }));
  EXPECT_EQ(harness.Counter("left_bad_frames") + harness.Counter("right_bad_frames"), 0);
}

TEST_F(CapturePairsTest, ACameraThatIsPoweredLateIsWaitedForAndJoins) {
  options_.power_left = false;
  CaptureHarness harness(options_);
  EXPECT_TRUE(harness.Receive(10, [&] { return CountSingles(harness, 0) > 10; }))
      << harness.process().Err();
  EXPECT_TRUE(harness.Receive(2.5, [&] {
    return harness.status().state_text.find("no such camera answers") != std::string::npos;
  }));
  harness.left().Return();
  EXPECT_TRUE(harness.ReceivePairs(10, 5));
}

}  // namespace
}  // namespace visavis
