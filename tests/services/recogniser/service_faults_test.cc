// What is wrong with the cameras is told, and is never a wrong pose that says TRACKING.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "services/recogniser/refined/head_geometry.h"
#include "tests/services/recogniser/service_bench.h"
#include "tests/support/mesh_scene.h"
#include "tests/support/stereo_scene.h"

namespace visavis {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

class ServiceFaultsTest : public ::testing::Test {
 protected:
  explicit ServiceFaultsTest(int confirm_frames = 1)
      : scene_(TestRig()), bench_(Config(confirm_frames)) {
    bench_.SendRig({TestRig(), std::nullopt, std::nullopt});
  }
  static RecogniserConfig Config(int confirm_frames) {
    RecogniserConfig config;
    config.ego_motion = "none";
    config.refined.evidence.confirm_frames = confirm_frames;
    return config;
  }
  /// A pair with noise of its own, the head at @p phi.
  images_t Pair(const Vector6d& phi) {
    scene_.Show(TransformFromPhi(phi), FeaturedHead);
    images_t pair = PairOf({0, scene_.picture(0), scene_.picture(1)}, 33'333 * ++frames_);
    for (image_t& image : pair.images) {
      for (std::uint8_t& byte : image.data) {
        byte = static_cast<std::uint8_t>(std::clamp(byte + random_.Index(7) - 3, 0, 255));
      }
    }
    return pair;
  }
  head_pose_t Send(const images_t& pair) {
    bench_.Send("STEREO_IMAGES", pair, pair.utime - kBaseUs);
    return bench_.Poses().back();
  }
  static double ErrorMm(const head_pose_t& pose, const Vector6d& phi) {
    const Eigen::Vector3d p_CR(pose.p_CM_m[0], pose.p_CM_m[1], pose.p_CM_m[2]);
    return 1e3 * (p_CR - TransformFromPhi(phi) * AdultOrigin()).norm();
  }

  Random random_{1};
  MeshScene scene_;
  ServiceBench bench_;
  std::int64_t frames_{0};
  const Vector6d place_{PhiOf(40, -20, 1000, 4, -8, 5)};
};

TEST_F(ServiceFaultsTest, SwappedEyesAreToldAndNeverTracked) {
  for (int i = 0; i < 20; ++i) {
    images_t pair = Pair(place_);
    std::swap(pair.image_types[0], pair.image_types[1]);
    EXPECT_NE(Send(pair).status, head_pose_t::STATUS_TRACKING);
  }
  service_status_t status = bench_.Status();
  EXPECT_THAT(status.last_error, HasSubstr("images of left and right camera are swapped"));
  EXPECT_EQ(status.state, service_status_t::STATE_DEGRADED);
  EXPECT_GT(CounterOf(status, "pairs_with_swapped_images"), 0);
  for (int i = 0; i < 3; ++i) Send(Pair(place_));  // mended
  EXPECT_EQ(Send(Pair(place_)).status, head_pose_t::STATUS_TRACKING);
  EXPECT_EQ(bench_.Status().state, service_status_t::STATE_RUNNING);
}

TEST_F(ServiceFaultsTest, AResetTakesTheComplaintsBack) {
  Send(Pair(place_));
  const images_t stuck = Pair(place_);
  Send(stuck);
  images_t pair = Pair(place_);
  pair.images[0] = stuck.images[0];
  Send(pair);
  ASSERT_EQ(bench_.Status().state, service_status_t::STATE_DEGRADED);
  recogniser_command_t reset{};
  reset.reset = true;
  bench_.Send("RECOGNISER_COMMAND", reset, 33'333 * frames_);
  EXPECT_EQ(bench_.Status().state, service_status_t::STATE_RUNNING);
}

class SlowFaultsTest : public ServiceFaultsTest {
 protected:
  SlowFaultsTest() : ServiceFaultsTest(3) {}
};

// The exchanged pair is searched from nothing each time: one good frame must do there.
TEST_F(SlowFaultsTest, SwappedEyesAreToldThoughAFaceMustBeSeenSeveralTimes) {
  for (int i = 0; i < 20; ++i) {
    images_t pair = Pair(place_);
    std::swap(pair.image_types[0], pair.image_types[1]);
    EXPECT_NE(Send(pair).status, head_pose_t::STATUS_TRACKING);
  }
  EXPECT_THAT(bench_.Status().last_error, HasSubstr("left and right camera are swapped"));
  for (int i = 0; i < 2; ++i) EXPECT_NE(Send(Pair(place_)).status, head_pose_t::STATUS_TRACKING);
  EXPECT_EQ(Send(Pair(place_)).status, head_pose_t::STATUS_TRACKING);
  EXPECT_EQ(bench_.Status().state, service_status_t::STATE_RUNNING);
}

TEST_F(ServiceFaultsTest, AnEmptyRoomIsNotTakenForSwappedEyes) {
  for (int i = 0; i < 20; ++i) Send(Pair(PhiOf(3000, 0, 1000, 0, 0, 0)));
  const service_status_t status = bench_.Status();
  EXPECT_THAT(status.last_error, Not(HasSubstr("swapped")));
  EXPECT_EQ(CounterOf(status, "pairs_with_swapped_images"), 0);
}

TEST_F(ServiceFaultsTest, AStuckCameraIsToldAndItsPictureNotUsed) {
  for (int i = 0; i < 4; ++i) Send(Pair(place_));
  const images_t stuck = Pair(place_);
  Send(stuck);
  for (int i = 1; i <= 10; ++i) {
    const Vector6d phi = place_ + i * PhiOf(4, 1, 0, 0, 0, 0);
    images_t pair = Pair(phi);
    pair.images[0] = stuck.images[0];  // the left one, its old time with it
    const head_pose_t pose = Send(pair);
    EXPECT_EQ(pose.status, head_pose_t::STATUS_TRACKING) << i;
    EXPECT_LT(ErrorMm(pose, phi), 15) << i;
  }
  const service_status_t status = bench_.Status();
  EXPECT_THAT(status.last_error, HasSubstr("images of the left camera are stale"));
  EXPECT_EQ(CounterOf(status, "pairs_with_stale_left_image"), 10);
  EXPECT_EQ(CounterOf(status, "pairs_with_stale_right_image"), 0);
  EXPECT_EQ(status.state, service_status_t::STATE_DEGRADED);
}

TEST_F(ServiceFaultsTest, AStillPictureOfBothCamerasIsTrackedWithoutComplaint) {
  images_t pair = Pair(place_);
  for (int i = 0; i < 5; ++i) {
    pair.utime += 33'333;
    Send(pair);
  }
  EXPECT_EQ(bench_.Poses().back().status, head_pose_t::STATUS_TRACKING);
  EXPECT_EQ(bench_.Status().state, service_status_t::STATE_RUNNING);
}

}  // namespace
}  // namespace visavis
