// LogPlayer: every pair of a recording comes out once, in order, whatever becomes of its motion.
#include "services/recogniser/log_player.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>

#include "common/bus/channels.h"
#include "common/convert/pose_message.h"
#include "common/convert/rig_message.h"
#include "tests/services/recogniser/service_bench.h"
#include "tests/support/log_writing.h"

namespace visavis {
namespace {

constexpr int kPairs = 8;
constexpr std::int64_t kPeriod_us = 20'000;

/// When a camera pose is in the recording, by pair; in every recording a rig and kPairs pairs.
struct MotionCase {
  const char* name;
  std::function<bool(int)> has_motion;
  friend void PrintTo(const MotionCase& c, std::ostream* os) { *os << c.name; }
};

const MotionCase kMotionCases[] = {
    {"Always", [](int) { return true; }},
    {"Never", [](int) { return false; }},
    {"EndsEarly", [](int pair) { return pair < 3; }},
    {"StartsLate", [](int pair) { return pair > 4; }},
    {"HasAHole", [](int pair) { return pair < 3 || pair > 5; }},
};

class LogPlayerTest : public ::testing::TestWithParam<MotionCase> {
 protected:
  void SetUp() override {
    EventLogWriter writer(path_, EventLogWriter::Mode::kCreate);
    const RigDescription rig{TinyRig(), std::nullopt, std::nullopt};
    WriteMessage(kStereoRigChannel, ToMessage(rig, kBaseUs), &writer);
    for (int pair = 0; pair < kPairs; ++pair) {
      const std::int64_t t_us = (pair + 1) * kPeriod_us;
      WriteMessage(kStereoImagesChannel, PairAt(t_us, rig.rig), &writer);
      if (!GetParam().has_motion(pair)) continue;
      const RigidTransform X_WC =
          MakeTransform(Eigen::Matrix3d::Identity(), Eigen::Vector3d(0.01 * pair, 0, 0));
      WriteMessage(kCameraPoseChannel, ToMessage(X_WC, kBaseUs + t_us), &writer);
    }
    writer.Close();
  }

  TemporaryFolder folder_;
  const std::string path_ = folder_ / "recording.lcm";
};

INSTANTIATE_TEST_SUITE_P(Motion, LogPlayerTest, ::testing::ValuesIn(kMotionCases),
                         [](const auto& tested) { return std::string(tested.param.name); });

TEST_P(LogPlayerTest, HandsOutEveryPairOnceInOrder) {
  LogPlayer player(path_);
  std::vector<std::int64_t> times_us;
  while (const LogPlayer::Pair* pair = player.Next()) {
    times_us.push_back(pair->frame.utime_us - kBaseUs);
  }
  std::vector<std::int64_t> expected_us;
  for (int pair = 0; pair < kPairs; ++pair) expected_us.push_back((pair + 1) * kPeriod_us);
  EXPECT_THAT(times_us, ::testing::ElementsAreArray(expected_us));
}

TEST_P(LogPlayerTest, KnowsTheMotionBetweenPairsThatHaveIt) {
  LogPlayer player(path_);
  ASSERT_NE(player.Next(), nullptr);
  for (int i = 1; const LogPlayer::Pair* pair = player.Next(); ++i) {
    if (!GetParam().has_motion(i - 1) || !GetParam().has_motion(i)) continue;
    ASSERT_TRUE(pair->step.known) << i;
    EXPECT_NEAR(pair->step.X_C2C1.translation().x(), -0.01, 1e-9) << i;
  }
}

}  // namespace
}  // namespace visavis
