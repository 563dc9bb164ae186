#include "services/simulator/ray_scene.h"

#include <gtest/gtest.h>

#include "services/simulator/mesh.h"

namespace visavis {
namespace {

RayScene SphereScene(double radius) {
  const Mesh sphere = MakeSphere(radius, 192, 96);
  RayScene scene;
  scene.Add(sphere.vertices, sphere.triangles);
  scene.Commit();
  return scene;
}

/// Rays along z at heights 0, 5, 10 ... mm, looking as far as @p far.
RayBatch Rays(int count, float far) {
  RayBatch batch;
  batch.size = count;
  for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
    batch.dx[i] = 0;
    batch.dy[i] = 0.005f * static_cast<float>(i);
    batch.dz[i] = 1;
    batch.t[i] = far;
  }
  return batch;
}

TEST(RaySceneTest, HitsASphereWhereAnalysisSays) {
  const RayScene scene = SphereScene(0.1);
  RayBatch batch = Rays(30, 10);
  scene.Intersect({0, 0, -1}, &batch);
  for (std::size_t i = 0; i < 30; ++i) {
    // |o + t d| = r
    const double dy = static_cast<double>(batch.dy[i]), a = 1 + dy * dy;
    const double discriminant = 1 - a * (1 - 0.01);
    if (std::abs(discriminant) < 3e-4) continue;  // grazing: the mesh has facets
    EXPECT_EQ(batch.hit[i], discriminant > 0) << i;
    if (batch.hit[i] == 0) continue;
    EXPECT_NEAR(static_cast<double>(batch.t[i]), (1 - std::sqrt(discriminant)) / a, 2e-3);
  }
}

TEST(RaySceneTest, ANearerHitIsKept) {
  const RayScene scene = SphereScene(0.1);
  RayBatch batch = Rays(3, 0.5f);
  scene.Intersect({0, 0, -1}, &batch);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(batch.hit[i], 0);
    EXPECT_EQ(batch.t[i], 0.5f);
  }
}

TEST(RaySceneTest, TellsMeshAndTriangleAndWhereInIt) {
  const std::vector<Eigen::Vector3f> square{{-1, -1, 2}, {1, -1, 2}, {-1, 1, 2}, {1, 1, 2}};
  RayScene scene;
  scene.Add({{-9, -9, 3}, {9, -9, 3}, {0, 9, 3}}, {{0, 2, 1}});
  scene.Add(square, {{0, 2, 1}, {1, 2, 3}});
  scene.Commit();
  RayBatch batch = Rays(1, 10);
  batch.dx[0] = 0.3f;
  batch.dy[0] = 0.4f;
  scene.Intersect({0, 0, 0}, &batch);
  ASSERT_EQ(batch.hit[0], 1);
  EXPECT_EQ(batch.mesh[0], 1u);
  EXPECT_EQ(batch.triangle[0], 1u);
  const Eigen::Vector3f p =
      (1 - batch.u[0] - batch.v[0]) * square[1] + batch.u[0] * square[2] + batch.v[0] * square[3];
  EXPECT_LT((p - Eigen::Vector3f(0.6f, 0.8f, 2)).norm(), 1e-5f);
}

TEST(RaySceneTest, MovedVerticesAreSeenAfterCommit) {
  Mesh sphere = MakeSphere(0.1, 24, 12);
  RayScene scene;
  scene.Add(sphere.vertices, sphere.triangles);
  scene.Commit();
  for (auto& vertex : sphere.vertices) vertex.z() += 1;
  scene.SetVertices(0, sphere.vertices);
  scene.Commit();
  RayBatch batch = Rays(1, 10);
  scene.Intersect({0, 0, -1}, &batch);
  EXPECT_NEAR(batch.t[0], 1.9f, 1e-3f);
  EXPECT_THROW(scene.SetVertices(0, {}), std::invalid_argument);
  EXPECT_THROW(scene.SetVertices(7, sphere.vertices), std::invalid_argument);
}

TEST(RaySceneTest, OccludeClearsTheBitsOfRaysThatHit) {
  const RayScene scene = SphereScene(0.1);
  std::array<Eigen::Vector3f, RayScene::kFan> fan;
  fan.fill(Eigen::Vector3f::UnitX());
  fan[2] = fan[5] = Eigen::Vector3f::UnitZ();
  unsigned open = 0xf7;  // ray 3 is not asked
  scene.Occlude({0, 0, -1}, fan, 10, &open);
  EXPECT_EQ(open, 0xf7u & ~0x24u);
  open = 0xff;
  scene.Occlude({0, 0, -1}, fan, 0.5f, &open);
  EXPECT_EQ(open, 0xffu);
}

}  // namespace
}  // namespace visavis
