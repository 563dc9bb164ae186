#pragma once

#include <memory>
#include <vector>

#include "common/geometry/rigid_transform.h"
#include "services/simulator/figure.h"
#include "services/simulator/lighting.h"
#include "services/simulator/ray_scene.h"

namespace visavis {

/// A rigid group of parts with a pose in the scene S: one ray scene in the group's own frame O.
class Actor {
 public:
  /// What shading needs of a vertex, in O.
  struct alignas(32) ShadeVertex {
    float nx, ny, nz;  ///< normal
    float u, v;        ///< texture coordinates
    float openness;    ///< share of the surroundings' light that arrives, 0 to 1
    float key;         ///< share of the key light that arrives, 0 to 1
    float unused;

    Eigen::Map<Eigen::Vector3f> normal() { return Eigen::Map<Eigen::Vector3f>(&nx); }
  };
  static_assert(sizeof(ShadeVertex) == 32);

  /// @p wa a + @p wb b + @p wc c, all eight numbers at once.
  static ShadeVertex Mix(const ShadeVertex& a, const ShadeVertex& b, const ShadeVertex& c, float wa,
                         float wb, float wc) {
    using Eight = Eigen::Map<const Eigen::Array<float, 8, 1>, Eigen::Aligned32>;
    ShadeVertex mixed;
    Eigen::Map<Eigen::Array<float, 8, 1>, Eigen::Aligned32>(&mixed.nx) =
        wa * Eight(&a.nx) + wb * Eight(&b.nx) + wc * Eight(&c.nx);
    return mixed;
  }

  struct ShadePart {
    const Mesh* mesh;
    const Texture* texture;
    std::vector<ShadeVertex> vertices;
    std::vector<float> texels_per_m;  ///< a triangle
    std::vector<Label> labels;        ///< a triangle, at its centroid
  };

  /// @p parts must outlive the actor. Labels are shown as they are in the textures or, if
  /// @p bystander, all as Label::kBystander.
  Actor(const std::vector<Part>& parts, bool bystander);

  const RayScene& rays() const { return rays_; }
  const std::vector<ShadePart>& parts() const { return parts_; }
  bool bystander() const { return bystander_; }
  const RigidTransform& X_SO() const { return X_SO_; }
  void set_X_SO(const RigidTransform& X_SO) { X_SO_ = X_SO; }
  Label triangle_label(std::uint32_t part, std::uint32_t triangle) const {
    return parts_[part].labels[triangle];
  }
  /// Present vertices in O [m] of part @p i.
  const std::vector<Eigen::Vector3f>& vertices(std::size_t i) const { return vertices_[i]; }

  /// Bends the necks: vertices follow O by their head_weight, the rest X_OB of the body's frame B
  /// (whose coordinates equal O's while upright).
  void Bend(const RigidTransform& X_OB);

  /// Casts @p rays rays a vertex into the half space above it to find its openness, against
  /// @p others too.
  void ComputeOpenness(const std::vector<const Actor*>& others, int rays);

  /// Finds which vertices the key light reaches, with soft shadows thrown by this actor and
  /// @p others.
  void ComputeKeyLight(const Lighting& light, const std::vector<const Actor*>& others);

 private:
  std::vector<ShadePart> parts_;
  std::vector<std::vector<Eigen::Vector3f>> vertices_;
  RayScene rays_;
  RigidTransform X_SO_{RigidTransform::Identity()};
  RigidTransform X_OB_{RigidTransform::Identity()};
  bool bystander_;
};

}  // namespace visavis
