#include "services/simulator/actor.h"

#include <algorithm>
#include <cmath>

namespace visavis {
namespace {

constexpr float kStandOff_m = 0.0025f;  ///< rays start so far off the surface

/// Orthonormal tangents of a unit vector.
void Tangents(const Eigen::Vector3f& n, Eigen::Vector3f* a, Eigen::Vector3f* b) {
  *a = n.cross(std::abs(n.x()) < 0.8f ? Eigen::Vector3f::UnitX() : Eigen::Vector3f::UnitY())
           .normalized();
  *b = n.cross(*a);
}

/// Ray of O as a ray of another actor's frame.
struct Transfer {
  Eigen::Matrix3f R;
  Eigen::Vector3f p;
  const RayScene* rays;
};

std::vector<Transfer> Transfers(const Actor& to, const std::vector<const Actor*>& others) {
  std::vector<Transfer> result;
  for (const Actor* other : others) {
    const RigidTransform X = other->X_SO().inverse() * to.X_SO();
    result.push_back({X.linear().cast<float>(), X.translation().cast<float>(), &other->rays()});
  }
  return result;
}

bool AnyOccludes(const RayScene& own, const std::vector<Transfer>& others,
                 const Eigen::Vector3f& from, const Eigen::Vector3f& direction, float far_m) {
  if (own.Occluded(from, direction, 0, far_m)) return true;
  for (const Transfer& other : others) {
    if (other.rays->Occluded(other.R * from + other.p, other.R * direction, 0, far_m)) return true;
  }
  return false;
}

}  // namespace

Actor::Actor(const std::vector<Part>& parts, bool bystander) : bystander_(bystander) {
  for (const Part& part : parts) {
    const Mesh& mesh = part.mesh;
    ShadePart shade{&mesh, &part.texture, {}, {}, {}};
    for (std::size_t k = 0; k < mesh.vertices.size(); ++k) {
      const Eigen::Vector3f& n = mesh.normals[k];
      shade.vertices.push_back({n.x(), n.y(), n.z(), mesh.uv[k].x(), mesh.uv[k].y(), 1, 1, 0});
    }
    const Eigen::Vector2f size(static_cast<float>(part.texture.width()),
                               static_cast<float>(part.texture.height()));
    for (const auto& [a, b, c] : mesh.triangles) {
      const float area =
          (mesh.vertices[b] - mesh.vertices[a]).cross(mesh.vertices[c] - mesh.vertices[a]).norm();
      const Eigen::Vector2f e = (mesh.uv[b] - mesh.uv[a]).cwiseProduct(size),
                            f = (mesh.uv[c] - mesh.uv[a]).cwiseProduct(size);
      const float texels = std::abs(e.x() * f.y() - e.y() * f.x());
      shade.texels_per_m.push_back(std::sqrt(texels / std::max(area, 1e-9f)));
      const Eigen::Vector2f middle = (mesh.uv[a] + mesh.uv[b] + mesh.uv[c]) / 3;
      shade.labels.push_back(part.texture.Sample(middle.x(), middle.y(), 0).label);
    }
    parts_.push_back(std::move(shade));
    vertices_.push_back(mesh.vertices);
    rays_.Add(mesh.vertices, mesh.triangles);
  }
  rays_.Commit();
}

void Actor::Bend(const RigidTransform& X_OB) {
  if (X_OB.matrix() == X_OB_.matrix()) return;
  X_OB_ = X_OB;
  const Eigen::Matrix3f R = X_OB.linear().cast<float>();
  const Eigen::Vector3f p = X_OB.translation().cast<float>();
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    const Mesh& mesh = *parts_[i].mesh;
    if (mesh.head_weight.empty()) continue;
    for (std::size_t k = 0; k < mesh.vertices.size(); ++k) {
      const float w = mesh.head_weight[k];
      if (w == 1) continue;
      vertices_[i][k] = w * mesh.vertices[k] + (1 - w) * (R * mesh.vertices[k] + p);
      parts_[i].vertices[k].normal() =
          (w * mesh.normals[k] + (1 - w) * (R * mesh.normals[k])).normalized();
    }
    rays_.SetVertices(static_cast<int>(i), vertices_[i]);
  }
  rays_.Commit();
}

void Actor::ComputeOpenness(const std::vector<const Actor*>& others, int rays) {
  const std::vector<Transfer> transfers = Transfers(*this, others);
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    for (std::size_t k = 0; k < vertices_[i].size(); ++k) {
      ShadeVertex& vertex = parts_[i].vertices[k];
      Eigen::Vector3f a, b;
      Tangents(vertex.normal(), &a, &b);
      const Eigen::Vector3f from = vertices_[i][k] + kStandOff_m * vertex.normal();
      int open = 0;
      for (int r = 0; r < rays; ++r) {
        // Cosine-weighted spiral: every ray counts alike.
        const double radius = std::sqrt((r + 0.5) / rays), angle = 2.399963229728653 * r;
        const auto x = static_cast<float>(radius * std::cos(angle)),
                   y = static_cast<float>(radius * std::sin(angle));
        const auto z = static_cast<float>(std::sqrt(1 - radius * radius));
        open += !AnyOccludes(rays_, transfers, from, x * a + y * b + z * vertex.normal(), 0.35f);
      }
      vertex.openness = static_cast<float>(open) / static_cast<float>(rays);
    }
  }
}

void Actor::ComputeKeyLight(const Lighting& light, const std::vector<const Actor*>& others) {
  const std::vector<Transfer> transfers = Transfers(*this, others);
  const Eigen::Vector3f to_light =
      X_SO_.linear().transpose().cast<float>() * light.key_direction.normalized();
  Eigen::Vector3f a, b;
  Tangents(to_light, &a, &b);
  constexpr int kSamples = 8;
  std::vector<Eigen::Vector3f> directions;
  for (int r = 0; r < kSamples; ++r) {
    const double radius = light.key_radius * std::sqrt((r + 0.5) / kSamples),
                 angle = 2.399963229728653 * r;
    directions.push_back((to_light + static_cast<float>(radius * std::cos(angle)) * a +
                          static_cast<float>(radius * std::sin(angle)) * b)
                             .normalized());
  }
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    for (std::size_t k = 0; k < vertices_[i].size(); ++k) {
      ShadeVertex& vertex = parts_[i].vertices[k];
      vertex.key = 0;
      if (vertex.normal().dot(to_light) < -0.35f) continue;
      const Eigen::Vector3f from = vertices_[i][k] + kStandOff_m * vertex.normal();
      int open = 0;
      for (const Eigen::Vector3f& direction : directions) {
        open += !AnyOccludes(rays_, transfers, from, direction, 2.0f);
      }
      vertex.key = static_cast<float>(open) / kSamples;
    }
  }
}

}  // namespace visavis
