// What the program says to wrong flags, configurations and cameras: one line, and exit code 2.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>

#include "common/rigs/demo_rig.h"
#include "common/rigs/rig_file.h"
#include "tests/support/capture_test.h"
#include "tests/support/temporary_folder.h"

namespace visavis {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class CaptureUsageTest : public CaptureTest {
 protected:
  static ProcessResult Run(const std::vector<std::string>& settings,
                           const std::vector<std::string>& flags = {}) {
    const char* folder = std::getenv("VISAVIS_BIN_DIR");
    std::vector<std::string> args{std::string(folder ? folder : "build/bin") +
                                  "/visavis-stereo-capture"};
    args.insert(args.end(), flags.begin(), flags.end());
    for (const auto& setting : settings) args.insert(args.end(), {"--set", setting});
    return RunProcess(args, {"LCM_DEFAULT_URL=memq://"}, std::chrono::seconds(20));
  }

  static void ExpectRefused(const std::vector<std::string>& settings, const std::string& what) {
    const ProcessResult result = Run(settings);
    EXPECT_EQ(result.exit_code, 2) << what << result.err;
    EXPECT_THAT(result.err, HasSubstr(what));
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
  }
};

TEST_F(CaptureUsageTest, ConfigurationsThatCannotWorkAreRefusedWithKeyValueAndRule) {
  ExpectRefused({"tolerance_ms=17"}, "tolerance_ms: 17: must be below half a period, 16.6667 ms");
  ExpectRefused({"camera.frame_rate_hz=60", "tolerance_ms=8.4"},
                "tolerance_ms: 8.4: must be below");
  ExpectRefused({"left.device=RIGHT"}, "left.device: RIGHT: must be another camera");
  ExpectRefused({"rig_file=/nowhere.yaml"}, "rig_file: /nowhere.yaml: must be a file that exists");
  ExpectRefused({"source=folder", "folder=/nowhere"}, "folder: /nowhere: must be a file");
  ExpectRefused({"source=video", "left.device=/a.avi"}, "left.device: /a.avi: must be a video");
}

TEST_F(CaptureUsageTest, CamerasThatCannotDoWhatIsAskedEndTheStart) {
  const FakeCamera left(options_.left, nullptr), right(options_.right, nullptr);
  ExpectRefused({"camera.pixel_format=BGR8"},
                "camera.pixel_format: BGR8: this camera has BayerBG8");
  ExpectRefused({"camera.frame_rate_hz=1000", "camera.exposure=fixed", "camera.exposure_ms=0.002"},
                "camera.exposure_ms: 0.002: this camera takes 0.01 to");
  ExpectRefused({"camera.width_px=4000", "camera.height_px=240"},
                "camera.width_px: 4000: this camera takes 1 to 2048 px");
  ExpectRefused({"camera.trigger=line", "camera.trigger_line=Line7"},
                "needs the trigger source Line7, this camera has Line0 Software");
  ExpectRefused({"camera.ptp=true"}, "has neither PtpEnable nor GevIEEE1588");
  ExpectRefused({"left.features={Sparkle: 3}"}, "left camera: features.Sparkle: 3");

  const TemporaryFolder folder;
  SaveRigFile(DemoRig(), folder / "rig.yaml");
  ExpectRefused({"rig_file=" + (folder / "rig.yaml")},
                "rig_file: 640x480: this camera's pictures are 320x240");
}

TEST_F(CaptureUsageTest, ACameraThatIsNotThereEndsTheStartOnlyWhereItIsRequired) {
  ExpectRefused({"start=require"},
                "start: require: left camera: left.device: LEFT: no such camera");
}

TEST_F(CaptureUsageTest, TwoCamerasOfOneSerialAreRefused) {
  options_.right.serial = "LEFT";
  const FakeCamera left(options_.left, nullptr), right(options_.right, nullptr);
  ExpectRefused({}, "left.device: LEFT: 2 cameras answer to it (Aravis Fake LEFT at 127.0.0.");
}

TEST_F(CaptureUsageTest, TheListTellsEachCameraAndWhatItSupports) {
  EXPECT_THAT(Run({}, {"--list"}).out, HasSubstr("no GigE Vision or USB3 Vision camera answers"));
  const FakeCamera left(options_.left, nullptr), right(options_.right, nullptr);
  const ProcessResult result = Run({}, {"--list"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.out,
              AllOf(HasSubstr("Aravis Fake LEFT at 127.0.0.1\n"),
                    HasSubstr("Aravis Fake RIGHT at 127.0.0.2\n"),
                    HasSubstr("pixel_format: BayerBG8 BayerGB8 BayerGR8 BayerRG8 Mono8 RGB8"),
                    HasSubstr("frame_rate_hz: 0.1 to 1000"), HasSubstr("exposure_ms: 0.01 to"),
                    HasSubstr("trigger sources: Line0 Software"), HasSubstr("ptp: no")));
  EXPECT_THAT(result.err, IsEmpty());
}

TEST_F(CaptureUsageTest, ItStopsCleanlyWithAndWithoutCameras) {
  for (const bool powered : {false, true}) {
    CaptureHarness::Options options = options_;
    options.power_left = options.power_right = powered;
    CaptureHarness harness(options);
    ASSERT_TRUE(harness.process().WaitForOutput("running", std::chrono::seconds(10)));
    harness.process().Signal(SIGTERM);
    EXPECT_EQ(harness.process().Wait(std::chrono::seconds(6)), 0) << powered;
  }
}

}  // namespace
}  // namespace visavis
