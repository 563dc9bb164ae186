#include "common/geometry/pinhole.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/core/random.h"
#include "common/geometry/head_angles.h"
#include "common/geometry/stereo_rig.h"

namespace visavis {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

Pinhole Camera() { return {640, 480, 800, 810, 319.5, 239.5, {}}; }

StereoRig Rig() {
  StereoRig rig{Camera(), Camera(), RigidTransform::Identity()};
  rig.X_CL.translation().x() = -0.15;
  return rig;
}

TEST(PinholeTest, ProjectsByDefinition) {
  const Projection p = Project(Camera(), {0.1, -0.2, 2.0});
  EXPECT_TRUE(p.valid);
  EXPECT_NEAR(p.uv.x(), 800 * 0.05 + 319.5, 1e-12);
  EXPECT_NEAR(p.uv.y(), 810 * -0.1 + 239.5, 1e-12);
}

TEST(PinholeTest, BehindTheCameraIsInvalid) {
  EXPECT_FALSE(Project(Camera(), {0, 0, 0}).valid);
  EXPECT_FALSE(Project(Camera(), {0, 0, -1}).valid);
}

TEST(PinholeTest, UnprojectInvertsProjectWithDistortion) {
  Pinhole camera = Camera();
  camera.distortion = {-0.2, 0.05, 0.001, -0.002, 0.01};
  Random random(1);
  for (int i = 0; i < 200; ++i) {
    const Eigen::Vector3d p(random.Uniform(-0.4, 0.4), random.Uniform(-0.3, 0.3), 1.0);
    EXPECT_LT((Unproject(camera, Project(camera, 3 * p).uv) - p).norm(), 1e-9);
  }
}

TEST(PinholeTest, RefusesBadIntrinsicsByName) {
  Pinhole camera = Camera();
  camera.fx = 0;
  EXPECT_THAT([&] { camera.ValidateOrThrow(); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("fx = 0")));
}

TEST(StereoRigTest, LeftSeesThePointShiftedByTheDisparity) {
  const RigidTransform X_CM = MakeTransform(Eigen::Matrix3d::Identity().eval(), {0, 0, 1});
  const Eigen::Vector3d p_M(0.02, 0.01, -0.05);
  const auto right = ProjectRight(Rig(), X_CM, p_M), left = ProjectLeft(Rig(), X_CM, p_M);
  EXPECT_NEAR(left.uv.x() - right.uv.x(), 800 * 0.15 / 0.95, 1e-9);
  EXPECT_NEAR(left.uv.y(), right.uv.y(), 1e-9);
}

TEST(StereoRigTest, RefusesABaselineInMillimetres) {
  StereoRig rig = Rig();
  rig.X_CL.translation().x() = -150;
  EXPECT_THAT([&] { rig.ValidateOrThrow(); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("baseline_m() = 150")));
}

}  // namespace
}  // namespace visavis
