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

constexpr int kFan = RayScene::kFan;
using Fan = std::array<Eigen::Vector3f, kFan>;

/// How many of the fan's rays meet nothing.
int CountOpen(const RayScene& own, const std::vector<Transfer>& others, const Eigen::Vector3f& from,
              const Fan& fan, float far_m) {
  unsigned open = (1u << kFan) - 1;
  own.Occlude(from, fan, far_m, &open);
  for (const Transfer& other : others) {
    if (open == 0) break;
    Fan turned;
    for (std::size_t k = 0; k < kFan; ++k) turned[k] = other.R * fan[k];
    other.rays->Occlude(other.R * from + other.p, turned, far_m, &open);
  }
  int count = 0;
  for (; open != 0; open &= open - 1) ++count;
  return count;
}

/// Direction @p r of @p count within a disc of the given radius about @p axis, evenly spread.
Eigen::Vector3f Spread(int r, int count, double disc, const Eigen::Vector3f& axis,
                       const Eigen::Vector3f& a, const Eigen::Vector3f& b) {
  const double radius = disc * std::sqrt((r + 0.5) / count), angle = 2.399963229728653 * r;
  return static_cast<float>(radius * std::cos(angle)) * a +
         static_cast<float>(radius * std::sin(angle)) * b +
         static_cast<float>(std::sqrt(1 - radius * radius)) * axis;
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
      shade.labels.push_back(Texture::Fetch(part.texture.Locate(middle.x(), middle.y(), 0)).label);
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
  const int fans = std::max(rays / kFan, 1);
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    for (std::size_t k = 0; k < vertices_[i].size(); ++k) {
      ShadeVertex& vertex = parts_[i].vertices[k];
      const Eigen::Vector3f normal = vertex.normal();
      Eigen::Vector3f a, b;
      Tangents(normal, &a, &b);
      int open = 0;
      for (int f = 0; f < fans; ++f) {
        // Cosine-weighted: every ray counts alike.
        Fan fan;
        for (int r = 0; r < kFan; ++r) {
          fan[static_cast<std::size_t>(r)] = Spread(f * kFan + r, fans * kFan, 1, normal, a, b);
        }
        open += CountOpen(rays_, transfers, vertices_[i][k] + kStandOff_m * normal, fan, 0.35f);
      }
      vertex.openness = static_cast<float>(open) / static_cast<float>(fans * kFan);
    }
  }
}

void Actor::ComputeKeyLight(const Lighting& light, const std::vector<const Actor*>& others) {
  const std::vector<Transfer> transfers = Transfers(*this, others);
  const Eigen::Vector3f to_light =
      X_SO_.linear().transpose().cast<float>() * light.key_direction.normalized();
  Eigen::Vector3f a, b;
  Tangents(to_light, &a, &b);
  Fan fan;
  for (int r = 0; r < kFan; ++r) {
    fan[static_cast<std::size_t>(r)] =
        Spread(r, kFan, static_cast<double>(light.key_radius), to_light, a, b);
  }
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    for (std::size_t k = 0; k < vertices_[i].size(); ++k) {
      ShadeVertex& vertex = parts_[i].vertices[k];
      vertex.key = 0;
      if (vertex.normal().dot(to_light) < -0.35f) continue;
      const Eigen::Vector3f from = vertices_[i][k] + kStandOff_m * vertex.normal();
      vertex.key = static_cast<float>(CountOpen(rays_, transfers, from, fan, 2.0f)) / kFan;
    }
  }
}

}  // namespace visavis
