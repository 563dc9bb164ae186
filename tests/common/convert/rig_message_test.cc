#include "common/convert/rig_message.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "common/convert/message_error.h"
#include "common/core/random.h"

namespace visavis {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;
using ::testing::ThrowsMessage;

RigDescription WholeRig() {
  RigDescription d;
  d.rig.right = {640, 480, 800, 801, 319.5, 239.5, {0.1, -0.2, 0.001, 0.002, 0.05}};
  d.rig.left = {320, 240, 400, 401, 159.5, 119.5, {}};
  d.rig.X_CL = MakeTransform(ExpRotation({0.01, 0.02, -0.01}), {-0.15, 0.001, 0.002});
  d.X_HC = MakeTransform(ExpRotation({0, 0, 1}), {0.05, 0, 0.1});
  d.arm =
      ArmDescription{"<robot/>", "base", "hand", MakeTransform(ExpRotation({0, 1, 0}), {1, 2, 3})};
  return d;
}

void ExpectSame(const RigDescription& a, const RigDescription& b) {
  EXPECT_EQ(a.rig.right.distortion, b.rig.right.distortion);
  for (const auto& [p, q] : {std::pair{a.rig.right, b.rig.right}, {a.rig.left, b.rig.left}}) {
    EXPECT_EQ(p.width, q.width);
    EXPECT_EQ(p.height, q.height);
    EXPECT_EQ(p.fx, q.fx);
    EXPECT_EQ(p.fy, q.fy);
    EXPECT_EQ(p.cx, q.cx);
    EXPECT_EQ(p.cy, q.cy);
  }
  EXPECT_TRUE(a.rig.X_CL.isApprox(b.rig.X_CL, 1e-14));
  ASSERT_EQ(a.X_HC.has_value(), b.X_HC.has_value());
  if (a.X_HC) {
    EXPECT_TRUE(a.X_HC->isApprox(*b.X_HC, 1e-14));
  }
  ASSERT_EQ(a.arm.has_value(), b.arm.has_value());
  if (!a.arm) return;
  EXPECT_EQ(a.arm->urdf, b.arm->urdf);
  EXPECT_EQ(a.arm->base_link, b.arm->base_link);
  EXPECT_EQ(a.arm->tip_link, b.arm->tip_link);
  EXPECT_TRUE(a.arm->X_WB.isApprox(b.arm->X_WB, 1e-14));
}

TEST(RigMessageTest, AWholeRigMakesTheRoundTrip) {
  const stereo_rig_t m = ToMessage(WholeRig(), 12);
  EXPECT_EQ(m.utime, 12);
  ExpectSame(FromMessage(m), WholeRig());
}

TEST(RigMessageTest, CamerasAloneMakeTheRoundTripAndReadAsIdentityBesides) {
  RigDescription d = WholeRig();
  d.X_HC.reset();
  d.arm.reset();
  const stereo_rig_t m = ToMessage(d, 0);
  ExpectSame(FromMessage(m), d);
  EXPECT_FALSE(m.has_hand_eye);
  EXPECT_EQ(m.q_HC_wxyz[0], 1);
  EXPECT_EQ(m.q_WB_wxyz[0], 1);
}

TEST(RigMessageTest, ALyingFieldIsNamedWithValueAndRule) {
  const auto refusal = [](const std::function<void(stereo_rig_t*)>& spoil) {
    stereo_rig_t m = ToMessage(WholeRig(), 0);
    spoil(&m);
    try {
      FromMessage(m);
    } catch (const MessageError& e) {
      return std::string(e.what());
    }
    return std::string("taken");
  };
  EXPECT_EQ(refusal([](stereo_rig_t* m) { m->utime = -2; }),
            "stereo_rig_t.utime: -2: must be >= 0");
  EXPECT_THAT(refusal([](stereo_rig_t* m) { m->right.fx_px = 0; }),
              AllOf(StartsWith("stereo_rig_t: right: "), HasSubstr("fx = 0")));
  EXPECT_THAT(refusal([](stereo_rig_t* m) { m->left.width = -3; }),
              AllOf(StartsWith("stereo_rig_t: left: "), HasSubstr("width = -3")));
  EXPECT_THAT(refusal([](stereo_rig_t* m) { m->left.distortion[4] = std::nan(""); }),
              HasSubstr("k = nan"));
  EXPECT_THAT(refusal([](stereo_rig_t* m) { m->p_CL_m[0] = -150; }),
              HasSubstr("baseline_m() = 150"));
  EXPECT_THAT(refusal([](stereo_rig_t* m) { m->q_CL_wxyz[0] = 2; }),
              AllOf(StartsWith("stereo_rig_t.X_CL: "), HasSubstr("norm 1 within 0.001")));
  EXPECT_THAT(refusal([](stereo_rig_t* m) { m->p_HC_m[1] = 100; }), HasSubstr("hand_eye_m = 100"));
  EXPECT_THAT(refusal([](stereo_rig_t* m) { m->q_HC_wxyz[3] = std::nan(""); }),
              StartsWith("stereo_rig_t.X_HC: "));
  EXPECT_THAT(refusal([](stereo_rig_t* m) { m->p_WB_m[1] = std::nan(""); }),
              StartsWith("stereo_rig_t.X_WB: "));
  EXPECT_THAT(refusal([](stereo_rig_t* m) { m->arm_base_link.clear(); }), HasSubstr("base_link"));
  EXPECT_THAT(refusal([](stereo_rig_t* m) { m->arm_tip_link = "base"; }),
              HasSubstr("arm->tip_link = base"));
}

// Any numbers: never anything but a valid rig or a MessageError.
TEST(RigMessageTest, AnyNumbersAreTakenOrRefused) {
  Random random(4);
  int num_taken = 0, num_refused = 0;
  for (int i = 0; i < 5000; ++i) {
    stereo_rig_t m = ToMessage(WholeRig(), 0);
    double* const fields[] = {&m.right.fx_px,  &m.left.cy_px,   &m.right.distortion[1],
                              &m.p_CL_m[0],    &m.q_CL_wxyz[1], &m.p_HC_m[2],
                              &m.q_HC_wxyz[0], &m.p_WB_m[0],    &m.q_WB_wxyz[2]};
    const double odd[] = {std::nan(""), INFINITY, -INFINITY, 0, -1, 1e300, 1e-300, -1e9};
    *fields[random.Index(9)] = odd[random.Index(8)];
    try {
      const RigDescription taken = FromMessage(m);
      EXPECT_NO_THROW(taken.ValidateOrThrow());
      ++num_taken;
    } catch (const MessageError&) {
      ++num_refused;
    }
  }
  EXPECT_GT(num_taken, 100);
  EXPECT_GT(num_refused, 1000);
}

}  // namespace
}  // namespace visavis
