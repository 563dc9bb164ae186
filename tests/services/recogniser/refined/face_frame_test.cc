// FaceFrame: the frame of a face is found from its own looks and shape.
#include "services/recogniser/refined/face_frame.h"

#include <gtest/gtest.h>

#include <cmath>

#include "services/recogniser/refined/head_geometry.h"
#include "tests/support/mesh_scene.h"
#include "tests/support/stereo_scene.h"

namespace visavis {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

/// A head and a face on it, in a frame N of their own.
struct Head {
  HeadSurface surface;
  LearnedFace face;
};

/// The adult with features and a grain that is the same on both sides, told from N.
Head AdultIn(const RigidTransform& X_MN) {
  const HeadSurface& adult = SharedAdultHead().surface;
  const Eigen::Isometry3f X(X_MN.matrix().cast<float>()), X_back = X.inverse();
  HeadTable table = TableOf(adult, 4);
  const Icosphere sphere(4);
  for (std::size_t i = 0; i < table.radii_m.size(); ++i) {
    for (int k = 0; k < 8; ++k) {
      const Vector3f p_M = X * (table.radii_m[i] * sphere.vertices()[i]);
      table.radii_m[i] -= p_M.norm() - adult.Radius(p_M.normalized());
    }
  }
  Head head{HeadSurface(HeadShape{}, table), {}};
  const FacePoints& face = SharedAdultHead().face;
  for (std::size_t i = 0; i < face.size(); ++i) {
    const Vector3f& p = face.points[i];
    head.face.points.push_back(X_back * p);
    head.face.normals.push_back(X_back.linear() * face.normals[i]);
    const float grain = Grain(Vector3f(std::abs(p.x()), p.y(), p.z()));
    const AdultLooks::Place looks = TheAdult().looks.At(p.x(), p.y());
    for (const Band band : {kFineBand, kCoarseBand})
      head.face.value[band].push_back(10 * looks.mean[band] + grain);
  }
  return head;
}

RigidTransform Turned(double roll_deg, double yaw_deg, double pitch_deg) {
  return MakeTransform(RotationFromAngles(Vector3d(roll_deg, yaw_deg, pitch_deg) * (M_PI / 180)),
                       Vector3d::Zero());
}

class FaceFrameTest : public ::testing::TestWithParam<Vector3d> {
 protected:
  const FaceFrame frame_{TheAdult()};
};
INSTANTIATE_TEST_SUITE_P(RollYawPitch, FaceFrameTest,
                         ::testing::Values(Vector3d(0, 0, 0), Vector3d(0, 5, 0), Vector3d(-4, 0, 0),
                                           Vector3d(0, 0, 3), Vector3d(3, -5, -3)));

TEST_P(FaceFrameTest, IsFoundWhereASymmetricFaceIsToldInATurnedFrame) {
  const RigidTransform X_MN = Turned(GetParam()[0], GetParam()[1], GetParam()[2]);
  const Head head = AdultIn(X_MN);
  const auto [found, likeness] = frame_.Find(head.face, head.surface);
  const RigidTransform off = X_MN.inverse() * found;
  const Vector3d turned_deg = LogRotation(off.linear()) * (180 / M_PI);
  EXPECT_LT(std::abs(turned_deg.x()), 0.6);
  EXPECT_LT(std::abs(turned_deg.y()), 0.5);
  EXPECT_LT(std::abs(turned_deg.z()), 0.3);
  EXPECT_LT(off.translation().norm(), 0.0015);
  EXPECT_GT(likeness, 0.6);
}

TEST_P(FaceFrameTest, IsFoundFromNearByToo) {
  const Vector3d near = 0.6 * GetParam();
  const RigidTransform X_MN = Turned(near[0], near[1], near[2]);
  const Head head = AdultIn(X_MN);
  const auto [found, likeness] = frame_.FindNear(head.face, head.surface);
  const RigidTransform off = X_MN.inverse() * found;
  EXPECT_LT(LogRotation(off.linear()).norm() * (180 / M_PI), 0.8);
  EXPECT_LT(off.translation().norm(), 0.0015);
  EXPECT_GT(likeness, 0.6);
}

TEST_F(FaceFrameTest, IsFoundOnAFaceToldFromElsewhere) {
  for (const double up_m : {-0.02, 0.02}) {
    const RigidTransform X_MN =
        MakeTransform(Turned(0, 0, up_m > 0 ? 8 : -8).linear(), Vector3d(0, up_m, 0));
    const Head head = AdultIn(X_MN);
    const RigidTransform off = X_MN.inverse() * frame_.Find(head.face, head.surface).X_MN;
    EXPECT_LT(off.translation().norm(), 0.002) << up_m;
    EXPECT_LT(LogRotation(off.linear()).norm() * (180 / M_PI), 1) << up_m;
  }
}

TEST_F(FaceFrameTest, WhatIsNoFaceIsNotLikeOne) {
  Head head = AdultIn(RigidTransform::Identity());
  Random random(3);
  for (std::size_t i = 0; i < head.face.points.size(); ++i)
    head.face.value[kFineBand][i] = static_cast<float>(20 * random.Normal());
  EXPECT_LT(frame_.Find(head.face, head.surface).likeness, 0.1);
}

TEST_F(FaceFrameTest, TheFrameIsLeftWhereTheFaceTellsNothing) {
  const Head head = AdultIn(RigidTransform::Identity());
  const auto [found, likeness] = frame_.Find({}, head.surface);
  EXPECT_EQ(found.matrix(), Eigen::Matrix4d::Identity());
  EXPECT_EQ(likeness, 0);
}

TEST_F(FaceFrameTest, HalfAFaceStillTellsItsFrame) {
  const RigidTransform X_MN = Turned(2, 3, 0);
  Head head = AdultIn(X_MN);
  LearnedFace half;
  for (std::size_t i = 0; i < head.face.points.size(); ++i) {
    if (SharedAdultHead().face.points[i].x() > 0.02f) continue;
    half.points.push_back(head.face.points[i]);
    half.normals.push_back(head.face.normals[i]);
    for (const Band band : {kFineBand, kCoarseBand})
      half.value[band].push_back(head.face.value[band][i]);
  }
  const RigidTransform found = frame_.Find(half, head.surface).X_MN;
  EXPECT_LT(LogRotation((X_MN.inverse() * found).linear()).norm() * (180 / M_PI), 1.0);
}

}  // namespace
}  // namespace visavis
