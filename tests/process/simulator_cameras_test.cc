// The simulator as two GigE Vision cameras, the capture before them, the recogniser behind it.
#include <gtest/gtest.h>

#include <cstdlib>
#include <functional>
#include <map>
#include <memory>

#include "common/bus/channels.h"
#include "common/bus/lcm_bus.h"
#include "common/convert/pose_message.h"
#include "common/core/clock.h"
#include "tests/support/child_process.h"
#include "tests/support/network.h"
#include "tests/support/private_network.h"
#include "tests/support/temporary_folder.h"
#include "visavis/images_t.hpp"
#include "visavis/service_status_t.hpp"

namespace visavis {
namespace {

using std::chrono::seconds;

/// The three programs on an LCM network of this test's own, and what they say.
class SimulatorCamerasTest : public ::testing::Test {
 protected:
  void SetUp() override {
    const std::string reason = EnterPrivateNetwork();
    if (!reason.empty()) GTEST_SKIP() << reason;
    url_ = TestLcmUrl(0, "&recv_buf_size=4194304");
    bus_ = std::make_unique<LcmBus>(url_, "");
    bus_->Subscribe<head_pose_t>(kHeadPoseChannel, [this](const head_pose_t& m) { pose_ = m; });
    bus_->Subscribe<head_pose_t>(kHeadPoseTruthChannel,
                                 [this](const head_pose_t& m) { truth_[m.utime] = m; });
    bus_->Subscribe<service_status_t>(kServiceStatusChannel, [this](const service_status_t& m) {
      if (m.service == "stereo_capture") capture_ = m;
      if (m.service == "simulator") simulator_status_ = m;
    });
  }

  std::unique_ptr<ChildProcess> Start(const std::string& name, std::vector<std::string> flags) {
    const char* folder = std::getenv("VISAVIS_BIN_DIR");
    flags.insert(flags.begin(), {std::string(folder ? folder : "build/bin") + "/visavis-" + name,
                                 "--lcm-url", url_});
    return std::make_unique<ChildProcess>(flags);
  }

  void StartAll(const std::vector<std::string>& settings) {
    std::vector<std::string> flags{"--scenario", "shuttle_x", "--subject", "adult_e"};
    std::vector<std::string> all{"cameras=gige", "export_rig=" + (folder_ / "rig.yaml"),
                                 "scene.texture_size=512", "scene.edge_samples=1",
                                 "frame_rate_hz=15"};
    all.insert(all.end(), settings.begin(), settings.end());
    for (const std::string& setting : all) flags.insert(flags.end(), {"--set", setting});
    simulator_ = Start("simulator", flags);
    ASSERT_TRUE(simulator_->WaitForOutput("running", seconds(60))) << simulator_->Err();
    recogniser_ = Start("recogniser", {});
    capture_process_ =
        Start("stereo-capture",
              {"--left", "127.0.0.1", "--right", "127.0.0.2", "--rig", folder_ / "rig.yaml",
               "--set", "camera.frame_rate_hz=15", "--set", "camera.stall_ms=800"});
  }

  bool Receive(double within_s, const std::function<bool()>& done) {
    const double end_s = MonotonicSeconds() + within_s;
    while (MonotonicSeconds() < end_s) {
      if (done()) return true;
      bus_->HandleOne(10);
    }
    return done();
  }

  /// Distance [m] from the newest pose to a truth within 1 ms of it; nothing: not TRACKING, or no
  /// such truth has come.
  std::optional<double> Error() const {
    if (!pose_ || pose_->status != head_pose_t::STATUS_TRACKING) return std::nullopt;
    const auto truth = truth_.lower_bound(pose_->utime - 1000);
    if (truth == truth_.end() || truth->first > pose_->utime + 1000) return std::nullopt;
    return (FromMessage(truth->second).translation() - FromMessage(*pose_).translation()).norm();
  }

  /// What has been heard, for who reads of a failure.
  std::string Heard() const {
    std::string text = std::to_string(truth_.size()) + " truths, ";
    text += pose_ ? "a pose of status " + std::to_string(pose_->status) : "no pose";
    text += ", capture: " + capture_.state_text;
    for (std::size_t i = 0; i < capture_.counter_names.size(); ++i) {
      text += ", " + capture_.counter_names[i] + " " + std::to_string(capture_.counters[i]);
    }
    return text;
  }

  /// Whether the simulator says that the fault lasts.
  bool FaultTold() const {
    return simulator_status_.state == service_status_t::STATE_DEGRADED &&
           simulator_status_.state_text.find("right: die") != std::string::npos;
  }

  std::int64_t Connects(const std::string& camera) const {
    for (std::size_t i = 0; i < capture_.counter_names.size(); ++i) {
      if (capture_.counter_names[i] == camera + "_connects") return capture_.counters[i];
    }
    return 0;
  }

  const TemporaryFolder folder_;
  std::string url_;
  std::unique_ptr<LcmBus> bus_;
  std::unique_ptr<ChildProcess> simulator_, recogniser_, capture_process_;
  std::optional<head_pose_t> pose_;
  std::map<std::int64_t, head_pose_t> truth_;
  service_status_t capture_{}, simulator_status_{};
};

TEST_F(SimulatorCamerasTest, TheHeadIsTrackedAgainAfterACameraDiedAndReturned) {
  StartAll({"gige.faults=[{camera: right, fault: die, at_s: 12, for_s: 2}]"});
  ASSERT_TRUE(Receive(30, [&] { return Error() && *Error() < 0.015; })) << Heard();
  ASSERT_FALSE(FaultTold()) << "the head was found too late for this test";

  ASSERT_TRUE(Receive(30, [&] { return FaultTold(); }));
  const std::int64_t connects = Connects("right");
  ASSERT_TRUE(Receive(30, [&] { return !FaultTold() && Connects("right") > connects; })) << Heard();
  const std::int64_t back_us = capture_.utime;
  EXPECT_TRUE(Receive(30, [&] { return Error() && *Error() < 0.015 && pose_->utime > back_us; }));
}

}  // namespace
}  // namespace visavis
