// visavis-calibrate listening to live channels, the test as cameras.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <fstream>

#include "common/bus/channels.h"
#include "common/bus/lcm_bus.h"
#include "common/convert/image_message.h"
#include "common/image/image_decoder.h"
#include "common/rigs/rig_file.h"
#include "tests/support/board_pictures.h"
#include "tests/support/child_process.h"
#include "tests/support/environment.h"
#include "tests/support/network.h"
#include "tests/support/temporary_folder.h"

namespace visavis {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;

TEST(CalibrateProcessTest, LiveItGuidesAndCalibratesWhatThereIsWhenStopped) {
  if (!HasMulticastRoute()) GTEST_SKIP() << kNoMulticastRoute;
  const TemporaryFolder folder;
  BoardSpec spec;
  spec.columns = 9;
  spec.rows = 7;
  spec.square_mm = 60;
  spec.marker_mm = 45;
  std::ofstream(folder / "board.yaml")
      << "kind: charuco\ncolumns: 9\nrows: 7\nsquare_mm: 60\nmarker_mm: 45\n";
  const BoardScene scene = MakeBoardScene(spec, 10, 2);
  const PairRenderer renderer(scene);
  Random random(1);
  std::vector<images_t> pairs;
  JpegEncoder jpeg;  // small enough for any socket's buffer
  for (std::size_t i = 0; i < scene.X_CT.size(); ++i) {
    pairs.push_back(
        renderer.Render(scene.X_CT[i], 1'000'000 * static_cast<std::int64_t>(i + 1), &random));
    for (image_t& image : pairs.back().images) {
      const image_t raw = image;
      SetImage(jpeg.Encode(FromMessage(raw), 75), raw.utime, &image);
    }
  }

  const std::string url = TestLcmUrl();
  LcmBus bus(url, "");
  ChildProcess calibrate({Environment("VISAVIS_BIN_DIR") + "/visavis-calibrate", "stereo", "--live",
                          "--lcm-url", url, "--board", folder / "board.yaml", "-o",
                          folder / "rig.yaml", "--min-change-px", "10"});
  ASSERT_TRUE(calibrate.WaitForOutput("no stereo pair", 10s)) << calibrate.Err();
  // Its queue holds one pair, so one may be lost: then it comes again.
  const auto deadline = std::chrono::steady_clock::now() + 20s;
  for (std::size_t i = 0; !calibrate.WaitForOutput("10 views kept of", 150ms); ++i) {
    ASSERT_LT(std::chrono::steady_clock::now(), deadline) << calibrate.Out() << calibrate.Err();
    bus.Publish(kStereoImagesChannel, pairs[i % pairs.size()]);
  }
  EXPECT_THAT(calibrate.Out(), HasSubstr(" | right image: nothing yet at the "));
  calibrate.Signal(SIGINT);
  EXPECT_EQ(calibrate.Wait(20s), 0) << calibrate.Err();
  EXPECT_THAT(calibrate.Out(), HasSubstr("reprojection error 0.0"));
  const RigDescription rig = LoadRigFile(folder / "rig.yaml");
  EXPECT_NEAR(rig.rig.baseline_m(), scene.rig.baseline_m(), 3e-4);
}

TEST(CalibrateProcessTest, WithoutAnyPairItSaysSoWithExitCode2) {
  if (!HasMulticastRoute()) GTEST_SKIP() << kNoMulticastRoute;
  const TemporaryFolder folder;
  std::ofstream(folder / "board.yaml") << "columns: 9\nrows: 7\n";
  ChildProcess calibrate({Environment("VISAVIS_BIN_DIR") + "/visavis-calibrate", "stereo", "--live",
                          "--lcm-url", TestLcmUrl(1), "--board", folder / "board.yaml", "-o",
                          folder / "rig.yaml"});
  ASSERT_TRUE(calibrate.WaitForOutput("no stereo pair", 10s)) << calibrate.Err();
  calibrate.Signal(SIGTERM);
  EXPECT_EQ(calibrate.Wait(10s), 2);
  EXPECT_THAT(calibrate.Err(), HasSubstr("live: STEREO_IMAGES: missing: must hold stereo pairs"));
}

}  // namespace
}  // namespace visavis
