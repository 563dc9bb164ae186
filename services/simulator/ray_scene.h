#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <memory>
#include <vector>

namespace visavis {

/// Up to 64 rays from one origin and what they hit, as arrays (a tile of the picture).
struct RayBatch {
  static constexpr int kMax = 64;
  int size{0};
  alignas(64) std::array<float, kMax> dx, dy, dz;  ///< directions in the scene's frame, any length
  /// In: how far to look, in lengths of the direction. Out: the nearest hit's distance.
  alignas(64) std::array<float, kMax> t;
  alignas(64) std::array<float, kMax> u,
      v;  ///< barycentric, of the triangle's second and third vertex
  alignas(64) std::array<std::uint32_t, kMax> mesh, triangle;
  alignas(64) std::array<std::uint8_t, kMax> hit;  ///< 1 where this call found one nearer than t
};

/// Rays against some triangle meshes in a common frame (Embree 3). Not thread-safe.
class RayScene {
 public:
  /// Takes no ownership of anything; the arrays are copied.
  RayScene();
  ~RayScene();
  RayScene(RayScene&&) noexcept;
  RayScene& operator=(RayScene&&) noexcept;

  /// Adds a mesh; its index is the number of those added before. Call Commit afterwards.
  void Add(const std::vector<Eigen::Vector3f>& vertices,
           const std::vector<std::array<std::uint32_t, 3>>& triangles);

  /// Replaces the vertices of mesh @p index, as many as it has. Call Commit afterwards.
  void SetVertices(int index, const std::vector<Eigen::Vector3f>& vertices);

  void Commit();

  /// Traces the batch; rays that hit nothing nearer keep their t.
  void Intersect(const Eigen::Vector3f& origin, RayBatch* batch) const;

  /// Of the eight rays from @p origin along the unit vectors @p directions, clears in @p open the
  /// bits of those that hit something within @p far_m; looks only at rays whose bit is set.
  static constexpr int kFan = 8;
  void Occlude(const Eigen::Vector3f& origin, const std::array<Eigen::Vector3f, kFan>& directions,
               float far_m, unsigned* open) const;

 private:
  struct Handles;
  std::unique_ptr<Handles> handles_;
};

}  // namespace visavis
