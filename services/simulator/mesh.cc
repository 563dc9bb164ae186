#include "services/simulator/mesh.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

#include "common/core/check.h"

namespace visavis {

void Mesh::ValidateOrThrow() const {
  VISAVIS_THROW_UNLESS(!triangles.empty(), triangles.size());
  VISAVIS_THROW_UNLESS(normals.size() == vertices.size(), normals.size());
  VISAVIS_THROW_UNLESS(uv.size() == vertices.size(), uv.size());
  VISAVIS_THROW_UNLESS(head_weight.empty() || head_weight.size() == vertices.size(),
                       head_weight.size());
  for (const auto& triangle : triangles) {
    for (const std::uint32_t index : triangle) {
      VISAVIS_THROW_UNLESS(index < vertices.size(), index);
    }
  }
  for (const auto& vertex : vertices) {
    VISAVIS_THROW_UNLESS(vertex.allFinite(), vertex.transpose());
  }
}

void ComputeNormals(Mesh* mesh) {
  const std::size_t n = mesh->vertices.size();
  std::vector<Eigen::Vector3f> sums(n, Eigen::Vector3f::Zero());
  for (const auto& [a, b, c] : mesh->triangles) {
    const Eigen::Vector3f& p = mesh->vertices[a];
    const Eigen::Vector3f area = (mesh->vertices[b] - p).cross(mesh->vertices[c] - p);
    for (const std::uint32_t index : {a, b, c}) sums[index] += area;
  }
  // Runs of equal places in sorted order share one sum.
  std::vector<std::size_t> order(n);
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto place = [mesh](std::size_t i) {
    const Eigen::Vector3f& p = mesh->vertices[i];
    return std::make_tuple(p.x(), p.y(), p.z());
  };
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return place(a) < place(b); });
  mesh->normals.assign(n, Eigen::Vector3f::UnitZ());
  for (std::size_t begin = 0; begin < n;) {
    std::size_t end = begin;
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();
    for (; end < n && place(order[end]) == place(order[begin]); ++end) sum += sums[order[end]];
    for (; begin < end; ++begin) {
      if (sum.norm() > 0) mesh->normals[order[begin]] = sum.normalized();
    }
  }
}

Mesh MakeGrid(int columns, int rows) {
  VISAVIS_THROW_UNLESS(columns >= 1, columns);
  VISAVIS_THROW_UNLESS(rows >= 1, rows);
  Mesh mesh;
  const int stride = columns + 1;
  const auto count = static_cast<std::size_t>(stride * (rows + 1));
  mesh.vertices.resize(count);
  mesh.normals.assign(count, Eigen::Vector3f::UnitZ());
  mesh.uv.reserve(count);
  for (int j = 0; j <= rows; ++j) {
    for (int i = 0; i <= columns; ++i) {
      mesh.uv.emplace_back(static_cast<float>(i) / static_cast<float>(columns),
                           static_cast<float>(j) / static_cast<float>(rows));
      if (i == columns || j == rows) continue;
      const auto a = static_cast<std::uint32_t>(j * stride + i), b = a + 1;
      const auto c = a + static_cast<std::uint32_t>(stride), d = c + 1;
      mesh.triangles.push_back({a, c, b});
      mesh.triangles.push_back({b, c, d});
    }
  }
  return mesh;
}

Mesh MakeSphere(double radius_m, int columns, int rows) {
  VISAVIS_THROW_UNLESS(radius_m > 0, radius_m);
  Mesh mesh = MakeGrid(columns, rows);
  for (std::size_t k = 0; k < mesh.vertices.size(); ++k) {
    // u from -x over the front (-z) to +x and round the back; v from the top (-y) down.
    const double azimuth = 2 * M_PI * (mesh.uv[k].x() - 0.5), polar = M_PI * mesh.uv[k].y();
    const Eigen::Vector3d n(std::sin(polar) * std::sin(azimuth), -std::cos(polar),
                            -std::sin(polar) * std::cos(azimuth));
    mesh.vertices[k] = (radius_m * n).cast<float>();
    mesh.normals[k] = n.cast<float>();
  }
  return mesh;
}

}  // namespace visavis
