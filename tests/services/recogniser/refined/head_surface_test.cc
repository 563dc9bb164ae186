#include "services/recogniser/refined/head_surface.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "common/core/random.h"

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

Vector3f Mirrored(const Vector3f& p) { return {-p.x(), p.y(), p.z()}; }

float Degrees(const Vector3f& a, const Vector3f& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b)) * static_cast<float>(180 / M_PI);
}

TEST(HeadSurfaceTest, TheRadiusIsThatOfAnAdultHeadInEveryDirection) {
  const HeadSurface head{HeadShape{}};
  Random random(1);
  for (int i = 0; i < 2000; ++i) {
    const float r = head.Radius(RandomDirection(&random));
    EXPECT_GT(r, 0.055f);
    EXPECT_LT(r, 0.150f);
  }
}

TEST(HeadSurfaceTest, BreadthHeightAndDepthAreThoseOfItsBodiesAndHair) {
  HeadShape shape;
  const HeadSurface head(shape);
  EXPECT_NEAR(head.Radius({1, 0, 0}), shape.cranium.x() + shape.hair, 0.001f);
  EXPECT_NEAR(head.Radius({0, -1, 0}),
              shape.cranium.y() - shape.cranium_centre.y() + 1.6f * shape.hair, 0.003f);
  EXPECT_NEAR(head.Radius({0, 0, 1}),
              shape.cranium.z() + shape.cranium_centre.z() + 1.4f * shape.hair, 0.001f);
  shape.hair = 0;
  EXPECT_NEAR(HeadSurface(shape).Radius({0, 0, 1}), shape.cranium.z() + shape.cranium_centre.z(),
              0.0005f);
}

TEST(HeadSurfaceTest, TheRadiusIsContinuous) {
  const HeadSurface head{HeadShape{}};
  Random random(2);
  for (int i = 0; i < 2000; ++i) {
    const Vector3f d = RandomDirection(&random);
    const Vector3f aside = (d + 1e-4f * RandomDirection(&random)).normalized();
    // 0.1 mrad aside: 10 um at a head's size, steeper under the nose alone.
    EXPECT_NEAR(head.Radius(d), head.Radius(aside), 6e-5f) << d.transpose();
  }
}

TEST(HeadSurfaceTest, TheRadiusIsContinuousAlongTheNose) {
  const HeadSurface head{HeadShape{}};
  const auto radius = [&](float angle) {
    return head.Radius({0, std::sin(angle), -std::cos(angle)});
  };
  for (float angle = -0.4f; angle < 1.0f; angle += 0.0005f) {
    EXPECT_NEAR(radius(angle), radius(angle + 0.0005f), 0.0003f) << angle << " rad below";
  }
}

TEST(HeadSurfaceTest, LeftAndRightAreAlike) {
  const HeadSurface head{HeadShape{}};
  Random random(3);
  for (int i = 0; i < 500; ++i) {
    const Vector3f d = RandomDirection(&random);
    EXPECT_NEAR(head.Radius(d), head.Radius(Mirrored(d)), 1e-6f);
    EXPECT_NEAR(head.HairSide(d), head.HairSide(Mirrored(d)), 1e-7f);
    EXPECT_LT(Degrees(Mirrored(head.NormalAt(d)), head.NormalAt(Mirrored(d))), 0.1f);
  }
}

// Eq. 23: the plane C_h, tilted back from the horizontal about x.
TEST(HeadSurfaceTest, HairSideIsTheDistanceFromTheTiltedPlane) {
  HeadShape shape;
  shape.hair_tilt_rad = 0.6f;
  shape.hair_offset = -0.03f;
  const HeadSurface head(shape);
  const Vector3f n(0, -std::sin(0.6f), std::cos(0.6f));
  const Vector3f p = head.Onto({0, -0.6f, -0.8f}), normal = head.NormalAt(p);
  EXPECT_LT((head.IntoHair(p) - (n - normal * normal.dot(n)).normalized()).norm(), 1e-5f);
  const Vector3f on_plane = -0.03f * n + 0.07f * n.unitOrthogonal();
  EXPECT_NEAR(head.HairSide(on_plane), 0, 1e-7f);
  EXPECT_NEAR(head.HairSide(on_plane + 0.012f * n), 0.012f, 1e-7f);
  EXPECT_NEAR(head.HairSide(on_plane - 0.012f * n), -0.012f, 1e-7f);
}

TEST(HeadSurfaceTest, TheCrownAndTheBackAreHairTheFaceIsNot) {
  const HeadSurface head{HeadShape{}};
  const HeadShape& s = head.shape();
  EXPECT_GT(head.HairSide(head.Onto({0, -1, 0})), 0);
  EXPECT_GT(head.HairSide(head.Onto({0, 0, 1})), 0);
  for (const Vector3f& p : {Vector3f(s.eye_x, s.eye_y, -0.09f), Vector3f(0, s.nostril_y, -0.1f),
                            Vector3f(0, s.mouth_y, -0.09f), Vector3f(0.03f, s.brow_y, -0.09f)}) {
    EXPECT_LT(head.HairSide(head.Onto(p)), -0.01f) << p.transpose();
  }
}

TEST(HeadSurfaceTest, TheNoseStandsOutAndTheEyesLieBack) {
  HeadShape plain;
  plain.nose = 0;
  const HeadSurface with{HeadShape{}}, without{plain};
  const HeadShape& s = with.shape();
  const Vector3f tip = Vector3f(0, s.nostril_y - 0.012f, -0.09f).normalized();
  EXPECT_GT(with.Radius(tip) - without.Radius(tip), 0.8f * s.nose);
  EXPECT_LT(with.Radius(tip) - without.Radius(tip), 1.01f * s.nose);
  const auto radius = [&](float y) {
    return with.Radius(Vector3f(s.eye_x, y, -0.085f).normalized());
  };
  EXPECT_LT(radius(s.eye_y), 0.5f * (radius(s.eye_y - 0.018f) + radius(s.eye_y + 0.018f)) - 0.002f);
}

TEST(HeadSurfaceTest, OntoKeepsTheDirectionAndIsIdempotent) {
  const HeadSurface head{HeadShape{}};
  Random random(4);
  for (int i = 0; i < 200; ++i) {
    const Vector3f d = 3 * RandomDirection(&random), p = head.Onto(d);
    EXPECT_LT(Degrees(p, d), 0.05f);
    EXPECT_NEAR(p.norm(), head.Radius(d.normalized()), 1e-6f);
    EXPECT_LT((head.Onto(p) - p).norm(), 1e-6f);
  }
}

/// Gradient of F(p) = |p| - Radius(p / |p|), which is zero on the surface, by central differences,
/// mean over a patch as wide as NormalAt() looks.
Vector3f NaiveNormal(const HeadSurface& head, const Vector3f& p) {
  const Vector3f d = p.normalized();
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (int k = 0; k < 3; ++k) {
    const auto level = [&](float step) {
      const Vector3f q = p + step * Vector3f::Unit(k);
      return static_cast<double>(q.norm() - head.Radius(q.normalized()));
    };
    const float h = 0.03f * p.norm();
    sum[k] = (level(h) - level(-h)) / (2 * static_cast<double>(h));
  }
  EXPECT_GT(sum.dot(d.cast<double>()), 0);
  return sum.normalized().cast<float>();
}

TEST(HeadSurfaceTest, NormalsPointOutwardsAndFitFiniteDifferences) {
  const HeadSurface head{HeadShape{}};
  Random random(5);
  std::vector<float> angles;
  for (int i = 0; i < 400; ++i) {
    const Vector3f p = head.Onto(RandomDirection(&random)), n = head.NormalAt(p);
    EXPECT_NEAR(n.norm(), 1, 1e-5f);
    EXPECT_GT(n.dot(p.normalized()), 0.3f);
    angles.push_back(Degrees(n, NaiveNormal(head, p)));
  }
  std::sort(angles.begin(), angles.end());
  EXPECT_LT(angles[angles.size() / 2], 0.3f);
  EXPECT_LT(angles[angles.size() * 95 / 100], 3.0f);  // nose and sockets bend within the patch
}

}  // namespace
}  // namespace visavis
