#include "services/simulator/shader.h"

#include <algorithm>
#include <cmath>

namespace visavis {
namespace {

/// How a kind of surface answers to light.
struct Response {
  float wrap_red, wrap_green, wrap_blue;  ///< light that creeps round into the shade
  float wide_light, middle_light,
      narrow_light;  ///< weights of highlights with exponents 4, 16, 128
};

constexpr Response kSkinResponse{0.26f, 0.12f, 0.08f, 0, 1.0f, 0};
constexpr Response kHairResponse{0.10f, 0.10f, 0.10f, 0, 1.2f, 0};
constexpr Response kEyeResponse{0.20f, 0.15f, 0.15f, 0, 0, 1.6f};
constexpr Response kClothResponse{0.10f, 0.10f, 0.10f, 0.6f, 0, 0};

const Response& ResponseOf(Label label) {
  static constexpr std::array<const Response*, kNumLabels> kResponses = {
      &kClothResponse, &kSkinResponse, &kSkinResponse, &kHairResponse, &kClothResponse,
      &kEyeResponse,   &kHairResponse, &kHairResponse, &kSkinResponse, &kSkinResponse,
      &kSkinResponse,  &kSkinResponse, &kClothResponse};
  return *kResponses[static_cast<std::size_t>(label)];
}

inline float Squared(float x) { return x * x; }

}  // namespace

/// The hit points, quantity by quantity, so that loops over them vectorise.
struct Shader::Points {
  using Values = std::array<float, RayBatch::kMax>;
  alignas(64) Values nx, ny, nz;  ///< not yet unit
  alignas(64) Values vx, vy, vz;  ///< towards the camera, not yet unit
  alignas(64) Values openness, key;
  alignas(64) Values red, green, blue, gloss;  ///< in: albedo; out: radiance
  alignas(64) Values wrap_red, wrap_green, wrap_blue, wide, middle, narrow;
};

Shader::Shader(const Actor& actor, const Lighting& light, const RigidTransform& X_SC,
               float pixel_angle_rad)
    : actor_(&actor), light_(light), pixel_angle_rad_(pixel_angle_rad) {
  const RigidTransform X_OC = actor.X_SO().inverse() * X_SC;
  R_OC_ = X_OC.linear().cast<float>();
  p_OC_ = X_OC.translation().cast<float>();
  const Eigen::Matrix3f R_OS = actor.X_SO().linear().transpose().cast<float>();
  light_.key_direction = R_OS * light.key_direction.normalized();
  light_.fill_direction = R_OS * light.fill_direction.normalized();
  up_ = R_OS * -Eigen::Vector3f::UnitY();
}

[[gnu::target_clones("avx2", "default")]] void Shader::Gather(const RayBatch& batch, const float* x,
                                                              const float* y,
                                                              const std::uint8_t* rays, int count,
                                                              Points* points, Label* labels) const {
  const Eigen::Matrix3f& R = R_OC_;
  std::array<Texture::Tap, RayBatch::kMax> taps;
  // Triangles, vertices and texels are spread over more memory than the caches near the core hold:
  // each is asked for one loop before it is used.
  for (int k = 0; k < count; ++k) {
    const auto i = static_cast<std::size_t>(rays[k]);
    const Actor::ShadePart& part = actor_->parts()[batch.mesh[i]];
    __builtin_prefetch(&part.mesh->triangles[batch.triangle[i]]);
    __builtin_prefetch(&part.texels_per_m[batch.triangle[i]]);
  }
  for (int k = 0; k < count; ++k) {
    const auto i = static_cast<std::size_t>(rays[k]);
    const Actor::ShadePart& part = actor_->parts()[batch.mesh[i]];
    for (const std::uint32_t vertex : part.mesh->triangles[batch.triangle[i]]) {
      __builtin_prefetch(&part.vertices[vertex]);
    }
  }
  for (int k = 0; k < count; ++k) {
    const auto i = static_cast<std::size_t>(rays[k]), o = static_cast<std::size_t>(k);
    const Actor::ShadePart& part = actor_->parts()[batch.mesh[i]];
    const std::uint32_t triangle = batch.triangle[i];
    const auto& [ia, ib, ic] = part.mesh->triangles[triangle];
    const float v = batch.u[i], w = batch.v[i], u = 1 - v - w;
    // Normal, texture coordinates, openness and key light at once.
    const Actor::ShadeVertex mixed =
        Actor::Mix(part.vertices[ia], part.vertices[ib], part.vertices[ic], u, v, w);
    const float footprint = batch.t[i] * pixel_angle_rad_ * part.texels_per_m[triangle];
    const int level = footprint > 1 ? std::ilogb(footprint * 1.25f) : 0;
    taps[o] = part.texture->Locate(mixed.u, mixed.v, level);
    Texture::Prefetch(taps[o]);
    points->nx[o] = mixed.nx;
    points->ny[o] = mixed.ny;
    points->nz[o] = mixed.nz;
    points->vx[o] = -(R(0, 0) * x[i] + R(0, 1) * y[i] + R(0, 2));
    points->vy[o] = -(R(1, 0) * x[i] + R(1, 1) * y[i] + R(1, 2));
    points->vz[o] = -(R(2, 0) * x[i] + R(2, 1) * y[i] + R(2, 2));
    points->openness[o] = mixed.openness;
    points->key[o] = mixed.key;
  }
  for (int k = 0; k < count; ++k) {
    const auto o = static_cast<std::size_t>(k);
    const Texel texel = Texture::Fetch(taps[o]);
    constexpr float kSlope = 1.0f / 64, kUnit = 1.0f / 255;
    points->nx[o] += kSlope * static_cast<float>(texel.dx - 128);
    points->ny[o] += kSlope * static_cast<float>(texel.dy - 128);
    points->nz[o] += kSlope * static_cast<float>(texel.dz - 128);
    points->red[o] = Squared(kUnit * static_cast<float>(texel.red));
    points->green[o] = Squared(kUnit * static_cast<float>(texel.green));
    points->blue[o] = Squared(kUnit * static_cast<float>(texel.blue));
    points->gloss[o] = kUnit * static_cast<float>(texel.gloss);
    labels[rays[k]] = actor_->bystander() ? Label::kBystander : texel.label;
    const Response& response = ResponseOf(texel.label);
    points->wrap_red[o] = response.wrap_red;
    points->wrap_green[o] = response.wrap_green;
    points->wrap_blue[o] = response.wrap_blue;
    points->wide[o] = response.wide_light;
    points->middle[o] = response.middle_light;
    points->narrow[o] = response.narrow_light;
  }
}

[[gnu::target_clones("avx2", "default")]] void Shader::Illuminate(Points* p, int count) const {
  const Eigen::Vector3f l = light_.key_direction, f = light_.fill_direction, up = up_;
  const Eigen::Vector3f key_colour = light_.key, fill_colour = light_.fill, sky = light_.sky,
                        ground = light_.ground;
  for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
    float nx = p->nx[i], ny = p->ny[i], nz = p->nz[i], vx = p->vx[i], vy = p->vy[i], vz = p->vz[i];
    const float n_scale = 1 / std::sqrt(nx * nx + ny * ny + nz * nz + 1e-12f),
                v_scale = 1 / std::sqrt(vx * vx + vy * vy + vz * vz);
    nx *= n_scale, ny *= n_scale, nz *= n_scale;
    vx *= v_scale, vy *= v_scale, vz *= v_scale;
    // Relief, or the rear side of a thin surface, may face away: mirrored.
    const float n_v = nx * vx + ny * vy + nz * vz, away = 2 * std::min(n_v, 0.0f);
    nx -= away * vx, ny -= away * vy, nz -= away * vz;

    const float open = p->openness[i], key = p->key[i];
    const float n_key = nx * l.x() + ny * l.y() + nz * l.z();
    const float n_fill = std::max(nx * f.x() + ny * f.y() + nz * f.z(), 0.0f) * open;
    const float n_up = 0.5f + 0.5f * (nx * up.x() + ny * up.y() + nz * up.z());

    const auto highlight = [&](const Eigen::Vector3f& d) {
      const float hx = d.x() + vx, hy = d.y() + vy, hz = d.z() + vz;
      const float h2 = Squared(std::max(nx * hx + ny * hy + nz * hz, 0.0f)) /
                       (hx * hx + hy * hy + hz * hz + 1e-12f);
      const float h4 = h2 * h2, h16 = Squared(h4 * h4), h32 = h16 * h16;
      return p->wide[i] * h4 + p->middle[i] * h16 + p->narrow[i] * Squared(Squared(h32));
    };
    const float graze = 1 - std::abs(n_v);
    const float shine = p->wide[i] + p->middle[i] + p->narrow[i];
    const float specular =
        p->gloss[i] *
        (1.6f * key * key_colour.y() * highlight(l) + 1.2f * open * fill_colour.y() * highlight(f) +
         0.9f * open * sky.y() * shine * Squared(Squared(graze)) * graze);
    const auto channel = [&](int c, float albedo, float wrap) {
      // Light reflected among the walls of a hollow brightens it, in the surface's own colour.
      const float opened = open / (1 - albedo * (1 - open));
      const float ambient = ground[c] + (sky[c] - ground[c]) * n_up;
      const float direct = key * std::max((n_key + wrap) / (1 + wrap), 0.0f);
      return albedo * (ambient * opened + key_colour[c] * direct + fill_colour[c] * n_fill) +
             specular;
    };
    p->red[i] = channel(0, p->red[i], p->wrap_red[i]);
    p->green[i] = channel(1, p->green[i], p->wrap_green[i]);
    p->blue[i] = channel(2, p->blue[i], p->wrap_blue[i]);
  }
}

void Shader::Shade(const RayBatch& batch, const float* x, const float* y, const std::uint8_t* rays,
                   int count, ShadedBatch* shaded) const {
  Points points;
  Gather(batch, x, y, rays, count, &points, shaded->label.data());
  Illuminate(&points, count);
  for (int k = 0; k < count; ++k) {
    const std::size_t i = rays[k], o = static_cast<std::size_t>(k);
    shaded->red[i] = points.red[o];
    shaded->green[i] = points.green[o];
    shaded->blue[i] = points.blue[o];
  }
}

}  // namespace visavis
