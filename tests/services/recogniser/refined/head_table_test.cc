#include "services/recogniser/refined/head_table.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "services/recogniser/refined/head_geometry.h"
#include "services/recogniser/refined/head_mesh.h"
#include "tests/support/mesh_scene.h"

namespace visavis {
namespace {

using Eigen::Vector3f;

HeadTable SphereOf(float radius_m, int level) {
  HeadTable table;
  table.radii_m.assign(Icosphere(level).vertices().size(), radius_m);
  return table;
}

TEST(HeadTableTest, WrongNumbersOfEntriesAndRadiiOfNoHeadAreRefused) {
  HeadTable table = SphereOf(0.1f, 2);
  EXPECT_NO_THROW(table.ValidateOrThrow());
  table.radii_m.pop_back();
  EXPECT_THROW(TabulatedHead{table}, std::invalid_argument);
  for (const float bad : {0.0f, -0.1f, 0.5f, std::numeric_limits<float>::quiet_NaN()}) {
    table = SphereOf(0.1f, 2);
    table.radii_m[7] = bad;
    EXPECT_THROW(TabulatedHead{table}, std::invalid_argument) << bad;
  }
  table = SphereOf(0.1f, 2);
  table.hair_side_m.assign(3, 0);
  EXPECT_THROW(TabulatedHead{table}, std::invalid_argument);
}

TEST(HeadTableTest, ASphereIsOneInEveryDirection) {
  const TabulatedHead head(SphereOf(0.1f, 3));
  const Icosphere sphere(2);
  for (const Vector3f& d : sphere.vertices()) {
    const Vector3f askew = (d + Vector3f(0.03f, -0.02f, 0.05f)).normalized();
    EXPECT_NEAR(head.Radius(askew), 0.1f, 1e-6f);
    EXPECT_GT(head.Normal(askew).dot(askew), 0.9999f);
  }
}

TEST(HeadTableTest, TheGenericAdultFromATableIsTheAnalyticOneToATenthOfAMillimetreOffTheNose) {
  const HeadSurface& analytic = SharedAdultHead().surface;
  const HeadSurface tabulated(analytic.shape(), TableOf(analytic, 5));
  double sum = 0;
  int n = 0;
  const Icosphere sphere(3);
  for (const Vector3f& v : sphere.vertices()) {
    const Vector3f d = (v + Vector3f(0.011f, 0.017f, -0.005f)).normalized();
    const float r = analytic.Radius(d), other = tabulated.Radius(d);
    sum += std::abs(static_cast<double>(r - other));
    ++n;
    EXPECT_NEAR(r, other, 0.003f) << d.transpose();
    EXPECT_NEAR(analytic.HairSide(r * d), tabulated.HairSide(r * d), 0.003f) << d.transpose();
  }
  EXPECT_LT(sum / n, 1e-4);
}

TEST(HeadTableTest, HairlineAndPartsOfATableAreThoseOfThePlaneItWasMadeFrom) {
  const HeadSurface& analytic = SharedAdultHead().surface;
  const HeadSurface tabulated(analytic.shape(), TableOf(analytic, 5));
  const Hairline plane = HairlineOf(analytic, 33), table = HairlineOf(tabulated, 33);
  ASSERT_EQ(plane.points.size(), table.points.size());
  for (std::size_t i = 0; i < plane.points.size(); ++i) {
    EXPECT_LT((plane.points[i] - table.points[i]).norm(), 0.001f);
    EXPECT_GT(plane.into_hair[i].dot(table.into_hair[i]), 0.95f);
  }
  EXPECT_EQ(MeshOf(analytic, 4).parts, MeshOf(tabulated, 4).parts);
}

TEST(HeadTableTest, ABaldHeadHasNoHairline) {
  HeadTable table = TableOf(SharedAdultHead().surface, 4);
  for (float& side : table.hair_side_m) side = -0.05f;
  const HeadSurface bald(HeadShape{}, table);
  EXPECT_TRUE(HairlineOf(bald, 33).points.empty());
  const HeadMesh mesh = MeshOf(bald, 3);
  for (const HeadPart part : mesh.parts) EXPECT_NE(part, HeadPart::kHair);
}

}  // namespace
}  // namespace visavis
