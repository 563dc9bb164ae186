#include "services/recogniser/refined/head_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "services/recogniser/refined/head_geometry.h"
#include "tests/support/mesh_scene.h"

namespace visavis {
namespace {

using Eigen::Vector3f;

const Vector3f& At(const HeadMesh& mesh, int i) {
  return mesh.vertices[static_cast<std::size_t>(i)];
}

/// The vertex nearest to @p p.
std::size_t Nearest(const HeadMesh& mesh, const Vector3f& p) {
  const auto it = std::min_element(mesh.vertices.begin(), mesh.vertices.end(),
                                   [&](const Vector3f& a, const Vector3f& b) {
                                     return (a - p).squaredNorm() < (b - p).squaredNorm();
                                   });
  return static_cast<std::size_t>(it - mesh.vertices.begin());
}

TEST(HeadMeshTest, LevelNHasTenTimesFourToTheNPlusTwoVertices) {
  const HeadSurface& surface = SharedAdultHead().surface;
  for (int level = 0, power = 1; level < 4; ++level, power *= 4) {
    const HeadMesh mesh = MeshOf(surface, level);
    const auto vertices = static_cast<std::size_t>(10 * power + 2);
    EXPECT_EQ(mesh.vertices.size(), vertices);
    EXPECT_EQ(mesh.triangles.size(), static_cast<std::size_t>(20 * power));
    EXPECT_EQ(mesh.edges.size(), static_cast<std::size_t>(30 * power));
    EXPECT_EQ(mesh.normals.size(), vertices);
    EXPECT_EQ(mesh.parts.size(), vertices);
    EXPECT_EQ(mesh.contour_weights.size(), vertices);
    EXPECT_EQ(mesh.coloured.size(), vertices);
  }
}

TEST(HeadMeshTest, IsClosedEachEdgeLiesInTwoTrianglesOnceInEachDirection) {
  const HeadMesh mesh = MeshOf(SharedAdultHead().surface, 3);
  std::map<std::pair<int, int>, int> directed;
  for (const auto& [a, b, c] : mesh.triangles) {
    ++directed[{a, b}];
    ++directed[{b, c}];
    ++directed[{c, a}];
  }
  std::set<std::pair<int, int>> undirected;
  for (const auto& [edge, times] : directed) {
    EXPECT_EQ(times, 1);
    EXPECT_EQ(directed.count({edge.second, edge.first}), 1u);
    undirected.insert(std::minmax(edge.first, edge.second));
  }
  std::set<std::pair<int, int>> listed;
  for (const auto& [a, b] : mesh.edges) listed.insert(std::minmax(a, b));
  EXPECT_EQ(listed.size(), mesh.edges.size());
  EXPECT_EQ(listed, undirected);
}

TEST(HeadMeshTest, VerticesLieOnTheSurface) {
  const SharedHead& head = SharedAdultHead();
  for (const Vector3f& v : head.mesh.vertices) {
    EXPECT_NEAR(v.norm(), head.surface.Radius(v.normalized()), 1e-6f);
  }
}

TEST(HeadMeshTest, NormalsAreUnitOutwardAndThoseOfTheSurface) {
  const SharedHead& head = SharedAdultHead();
  int askew = 0;
  for (std::size_t i = 0; i < head.mesh.vertices.size(); ++i) {
    const Vector3f &p = head.mesh.vertices[i], &n = head.mesh.normals[i];
    EXPECT_NEAR(n.norm(), 1, 1e-5f);
    EXPECT_GT(n.dot(p), 0);
    askew += n.dot(head.surface.NormalAt(p)) < 0.99f;
  }
  EXPECT_LT(askew, static_cast<int>(head.mesh.vertices.size() / 50));
}

TEST(HeadMeshTest, TrianglesEncloseTheVolumeOfAHead) {
  const HeadMesh& mesh = SharedAdultHead().mesh;
  double volume = 0;
  for (const auto& [a, b, c] : mesh.triangles) {
    volume += static_cast<double>(At(mesh, a).dot(At(mesh, b).cross(At(mesh, c)))) / 6;
  }
  EXPECT_GT(volume, 0.0025);  // 2.5 to 5 litres
  EXPECT_LT(volume, 0.005);
}

TEST(HeadMeshTest, PartsFollowThePlaneOfTheHair) {
  const SharedHead& head = SharedAdultHead();
  int features = 0;
  for (std::size_t i = 0; i < head.mesh.vertices.size(); ++i) {
    const bool hair = head.surface.HairSide(head.mesh.vertices[i]) > 0;
    EXPECT_EQ(head.mesh.parts[i] == HeadPart::kHair, hair);
    features += head.mesh.parts[i] == HeadPart::kFeature;
  }
  EXPECT_GT(features, 40);
}

TEST(HeadMeshTest, EyesBrowsNostrilsAndMouthAreFeaturesCheeksAndForeheadSkin) {
  const HeadMesh& mesh = SharedAdultHead().mesh;
  const HeadSurface& surface = SharedAdultHead().surface;
  const HeadShape& s = surface.shape();
  const auto part = [&](float x, float y) {
    return mesh.parts[Nearest(mesh, surface.Onto({x, y, -0.085f}))];
  };
  for (const float side : {-1.0f, 1.0f}) {
    EXPECT_EQ(part(side * s.eye_x, s.eye_y), HeadPart::kFeature);
    EXPECT_EQ(part(side * 0.033f, s.brow_y), HeadPart::kFeature);
    EXPECT_EQ(part(side * 0.035f, 0.055f), HeadPart::kSkin);
    EXPECT_EQ(part(side * 0.020f, -0.012f), HeadPart::kSkin);
  }
  EXPECT_EQ(part(0, s.nostril_y), HeadPart::kFeature);
  EXPECT_EQ(part(0, s.mouth_y), HeadPart::kFeature);
}

TEST(HeadMeshTest, ContoursDoNotCountAtEarsNapeAndBelowTheJaw) {
  const HeadMesh& mesh = SharedAdultHead().mesh;
  const HeadSurface& surface = SharedAdultHead().surface;
  const auto weight = [&](const Vector3f& towards) {
    return mesh.contour_weights[Nearest(mesh, surface.Onto(towards))];
  };
  for (const float side : {-1.0f, 1.0f}) {
    EXPECT_EQ(weight({side * 0.07f, 0.02f, 0.0f}), 0) << "ear";
    EXPECT_EQ(weight({side * 0.05f, 0.10f, -0.03f}), 0) << "below the jaw";
    EXPECT_EQ(weight({side * 0.07f, -0.04f, 0.0f}), 1) << "above the ear";
    EXPECT_EQ(weight({side * 0.06f, 0.04f, -0.06f}), 1) << "cheek";
  }
  EXPECT_EQ(weight({0, 0.07f, 0.07f}), 0) << "nape";
  EXPECT_EQ(weight({0, -0.09f, 0}), 1) << "crown";
}

TEST(HeadMeshTest, ContoursCountTheLessTheLessTheyAreKnown) {
  HeadTable table = TableOf(SharedAdultHead().surface, 3);
  const auto weight = [&](const Vector3f& towards) {
    const HeadSurface surface(HeadShape{}, table);
    const HeadMesh mesh = MeshOf(surface, 3);
    return mesh.contour_weights[Nearest(mesh, surface.Onto(towards))];
  };
  const Vector3f cheek(0.06f, 0.04f, -0.06f), crown(0, -0.09f, 0);
  table.sigma_m.clear();
  EXPECT_EQ(weight(cheek), 1);
  EXPECT_EQ(weight(crown), 1);
  table.sigma_m.assign(table.radii_m.size(), 0.003f);
  EXPECT_NEAR(weight(cheek), 0.8f, 1e-5f);
  EXPECT_LT(weight(crown), 0.5f);  // hair may be done in any way
  table.sigma_m.assign(table.radii_m.size(), 0.02f);
  EXPECT_LT(weight(cheek), 0.25f);
}

TEST(HeadMeshTest, NoColourIsTakenFromFeaturesNeckAndHairline) {
  const SharedHead& head = SharedAdultHead();
  int skin = 0, hair = 0;
  for (std::size_t i = 0; i < head.mesh.vertices.size(); ++i) {
    const Vector3f& p = head.mesh.vertices[i];
    if (!head.mesh.coloured[i]) continue;
    EXPECT_NE(head.mesh.parts[i], HeadPart::kFeature);
    EXPECT_LE(p.y(), 0.098f);
    EXPECT_GE(std::abs(head.surface.HairSide(p)), 0.006f);
    (head.mesh.parts[i] == HeadPart::kHair ? hair : skin) += 1;
  }
  EXPECT_GT(skin, 200);
  EXPECT_GT(hair, 500);
}

TEST(HeadMeshTest, LeftAndRightAreAlike) {
  const HeadMesh& mesh = SharedAdultHead().mesh;
  for (std::size_t i = 0; i < mesh.vertices.size(); i += 7) {
    const Vector3f& p = mesh.vertices[i];
    const std::size_t j = Nearest(mesh, {-p.x(), p.y(), p.z()});
    EXPECT_LT((mesh.vertices[j] - Vector3f(-p.x(), p.y(), p.z())).norm(), 2e-5f);
    EXPECT_EQ(mesh.parts[i], mesh.parts[j]);
    EXPECT_EQ(mesh.contour_weights[i], mesh.contour_weights[j]);
    EXPECT_EQ(mesh.coloured[i], mesh.coloured[j]);
  }
}

TEST(HairlineTest, PointsLieOnThePlaneAndOnTheSurface) {
  const HeadSurface& surface = SharedAdultHead().surface;
  const Hairline line = HairlineOf(surface, 33);
  ASSERT_EQ(line.points.size(), 33u);
  ASSERT_EQ(line.into_hair.size(), 33u);
  for (const Vector3f& p : line.points) {
    EXPECT_NEAR(surface.HairSide(p), 0, 2e-6f);
    EXPECT_NEAR(p.norm(), surface.Radius(p.normalized()), 1e-6f);
  }
}

TEST(HairlineTest, RunsFromTempleToTempleOverTheForehead) {
  const Hairline line = HairlineOf(SharedAdultHead().surface, 33);
  EXPECT_LT(line.points.front().x(), -0.05f);
  EXPECT_GT(line.points.back().x(), 0.05f);
  const Vector3f& middle = line.points[16];
  EXPECT_NEAR(middle.x(), 0, 1e-6f);
  EXPECT_LT(middle.y(), -0.02f);
  EXPECT_LT(middle.z(), -0.04f);
}

TEST(HairlineTest, DirectionsLieInTheSurfaceAndLeadIntoTheHair) {
  const HeadSurface& surface = SharedAdultHead().surface;
  const Hairline line = HairlineOf(surface, 21);
  for (std::size_t i = 0; i < line.points.size(); ++i) {
    const Vector3f &p = line.points[i], &d = line.into_hair[i];
    EXPECT_NEAR(d.norm(), 1, 1e-5f);
    EXPECT_NEAR(d.dot(surface.NormalAt(p)), 0, 1e-5f);
    EXPECT_GT(surface.HairSide(surface.Onto(p + 0.004f * d)), 0.001f);
    EXPECT_LT(surface.HairSide(surface.Onto(p - 0.004f * d)), -0.001f);
  }
}

TEST(HairlineTest, OnePointIsALineToo) {
  EXPECT_EQ(HairlineOf(SharedAdultHead().surface, 1).points.size(), 1u);
}

}  // namespace
}  // namespace visavis
