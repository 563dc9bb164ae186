#include "services/recogniser/refined/head_surface.h"

#include <gtest/gtest.h>

#include <cmath>

#include "common/core/random.h"
#include "services/recogniser/refined/adult_head.h"

namespace visavis {
namespace {

using Eigen::Vector3f;

Vector3f RandomDirection(Random* random) {
  Vector3f d;
  do {
    for (int k = 0; k < 3; ++k) d[k] = static_cast<float>(random->Uniform(-1, 1));
  } while (d.norm() > 1 || d.norm() < 0.1f);
  return d.normalized();
}

float Degrees(const Vector3f& a, const Vector3f& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b)) * static_cast<float>(180 / M_PI);
}

TEST(HeadSurfaceTest, TheRadiusIsContinuous) {
  const HeadSurface& head = TheAdult().surface;
  Random random(2);
  for (int i = 0; i < 2000; ++i) {
    const Vector3f d = RandomDirection(&random);
    const Vector3f aside = (d + 1e-4f * RandomDirection(&random)).normalized();
    // 0.1 mrad aside: 10 um at a head's size, steeper under the nose alone.
    EXPECT_NEAR(head.Radius(d), head.Radius(aside), 6e-5f) << d.transpose();
  }
}

// Eq. 23: the plane C_h, tilted back from the horizontal about x.
TEST(HeadSurfaceTest, HairSideIsTheDistanceFromTheTiltedPlane) {
  HeadShape shape;
  shape.hair_tilt_rad = 0.6f;
  shape.hair_offset = -0.03f;
  HeadTable round;
  round.radii_m.assign(642, 0.1f);
  const HeadSurface head(shape, round);
  const Vector3f n(0, -std::sin(0.6f), std::cos(0.6f));
  const Vector3f p = head.Onto({0, -0.6f, -0.8f}), normal = head.NormalAt(p);
  EXPECT_LT((head.IntoHair(p) - (n - normal * normal.dot(n)).normalized()).norm(), 1e-5f);
  const Vector3f on_plane = -0.03f * n + 0.07f * n.unitOrthogonal();
  EXPECT_NEAR(head.HairSide(on_plane), 0, 1e-7f);
  EXPECT_NEAR(head.HairSide(on_plane + 0.012f * n), 0.012f, 1e-7f);
  EXPECT_NEAR(head.HairSide(on_plane - 0.012f * n), -0.012f, 1e-7f);
}

TEST(HeadSurfaceTest, OntoKeepsTheDirectionAndIsIdempotent) {
  const HeadSurface& head = TheAdult().surface;
  Random random(4);
  for (int i = 0; i < 200; ++i) {
    const Vector3f d = 3 * RandomDirection(&random), p = head.Onto(d);
    EXPECT_LT(Degrees(p, d), 0.05f);
    EXPECT_NEAR(p.norm(), head.Radius(d.normalized()), 1e-6f);
    EXPECT_LT((head.Onto(p) - p).norm(), 1e-6f);
  }
}

}  // namespace
}  // namespace visavis
