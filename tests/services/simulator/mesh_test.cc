#include "services/simulator/mesh.h"

#include <gtest/gtest.h>

namespace visavis {
namespace {

TEST(MeshTest, SphereHasItsRadiusAndOutwardTriangles) {
  const Mesh sphere = MakeSphere(0.1, 24, 12);
  sphere.ValidateOrThrow();
  for (std::size_t i = 0; i < sphere.vertices.size(); ++i) {
    EXPECT_NEAR(sphere.vertices[i].norm(), 0.1f, 1e-6f);
    EXPECT_NEAR(sphere.normals[i].dot(sphere.vertices[i]), 0.1f, 1e-6f);
  }
  for (const auto& [a, b, c] : sphere.triangles) {
    const Eigen::Vector3f &p = sphere.vertices[a], &q = sphere.vertices[b], &r = sphere.vertices[c];
    const Eigen::Vector3f area = (q - p).cross(r - p);
    EXPECT_GE(area.dot(p + q + r), -1e-9f);
  }
}

TEST(MeshTest, ComputedNormalsOfASphereAreRadialAlsoAtTheSeam) {
  Mesh sphere = MakeSphere(0.1, 48, 24);
  const auto exact = sphere.normals;
  // The seam's two columns must be the same places to the bit.
  for (int j = 0; j <= 24; ++j)
    sphere.vertices[static_cast<std::size_t>(j * 49 + 48)] =
        sphere.vertices[static_cast<std::size_t>(j * 49)];
  ComputeNormals(&sphere);
  for (std::size_t i = 49; i + 49 < exact.size(); ++i) {
    EXPECT_GT(sphere.normals[i].dot(exact[i]), 0.995f) << i;
  }
}

TEST(MeshTest, RefusesAnIndexOutOfRange) {
  Mesh mesh = MakeSphere(0.1, 6, 4);
  mesh.triangles.push_back({0, 1, 1000});
  EXPECT_THROW(mesh.ValidateOrThrow(), std::invalid_argument);
}

TEST(MeshTest, RefusesACoordinateThatIsNotFinite) {
  Mesh mesh = MakeSphere(0.1, 6, 4);
  mesh.vertices[3].x() = std::nanf("");
  EXPECT_THROW(mesh.ValidateOrThrow(), std::invalid_argument);
}

}  // namespace
}  // namespace visavis
