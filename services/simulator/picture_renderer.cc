#include "services/simulator/picture_renderer.h"

#include <algorithm>
#include <cmath>

#include "common/core/check.h"

namespace visavis {
namespace {

constexpr float kFar_m = 20;
constexpr float kDepthEdge_m = 0.006f;  ///< neighbouring pixels further apart are an edge

}  // namespace

PictureRenderer::PictureRenderer(const Pinhole& camera, int edge_samples)
    : camera_(camera),
      tiles_x_((camera.width + kTile - 1) / kTile),
      tiles_y_((camera.height + kTile - 1) / kTile) {
  camera.ValidateOrThrow();
  VISAVIS_THROW_UNLESS(edge_samples == 1 || edge_samples == 2 || edge_samples == 4 ||
                           edge_samples == 8 || edge_samples == 16,
                       edge_samples);
  const auto count =
      static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height);
  // Tiles at the right and lower border may reach beyond the picture: so do the rays.
  ray_x_.resize(static_cast<std::size_t>(tiles_x_ * tiles_y_ * kTilePixels));
  ray_y_.resize(ray_x_.size());
  for (int y = 0; y < tiles_y_ * kTile; ++y) {
    for (int x = 0; x < tiles_x_ * kTile; ++x) {
      const Eigen::Vector3d ray = Unproject(camera, {x, y});
      ray_x_[RayIndex(x, y)] = static_cast<float>(ray.x());
      ray_y_[RayIndex(x, y)] = static_cast<float>(ray.y());
    }
  }
  tile_mask_.resize(static_cast<std::size_t>(tiles_x_ * tiles_y_));
  tile_drawn_.resize(tile_mask_.size());
  samples_.resize(count);
  edges_.reserve(count / 8);
  // Hammersley's points: as many distinct rows and columns as samples.
  for (int k = 0; k < edge_samples; ++k) {
    float reversed = 0, digit = 0.5f;
    for (int bits = k; bits > 0; bits /= 2, digit /= 2)
      reversed += digit * static_cast<float>(bits % 2);
    const float half = 0.5f / static_cast<float>(edge_samples);
    offsets_.emplace_back(static_cast<float>(k) / static_cast<float>(edge_samples) + half - 0.5f,
                          reversed + half - 0.5f);
  }
}

void PictureRenderer::Render(const SceneView& scene, const RigidTransform& X_SC,
                             const RgbView& picture, std::uint8_t* labels, HeadPixels* pixels) {
  VISAVIS_THROW_UNLESS(picture.width == camera_.width && picture.height == camera_.height,
                       picture.width);
  VISAVIS_THROW_UNLESS(picture.stride >= 3 * picture.width, picture.stride);
  VISAVIS_THROW_UNLESS(scene.actors.size() <= 8, scene.actors.size());
  R_SC_ = X_SC.linear().cast<float>();
  p_SC_ = X_SC.translation().cast<float>();
  shaders_.clear();
  for (const Actor* actor : scene.actors) {
    shaders_.emplace_back(*actor, *scene.light, X_SC, static_cast<float>(1 / camera_.fx));
  }
  if (pixels != nullptr) *pixels = {};
  HeadPixels* const count = scene.has_head ? pixels : nullptr;
  MarkTiles(scene, X_SC);
  for (int j = 0; j < tiles_y_; ++j) {
    for (int i = 0; i < tiles_x_; ++i) RenderTile(scene, i, j, picture, labels, count);
  }
  if (offsets_.size() > 1) {
    FindEdges();
    SmoothEdges(scene, picture);
  }
  if (count != nullptr) CountOutside(scene, count);
}

void PictureRenderer::MarkTiles(const SceneView& scene, const RigidTransform& X_SC) {
  std::fill(tile_mask_.begin(), tile_mask_.end(), std::uint8_t{0});
  constexpr float kMargin_px = 2;
  for (std::size_t k = 0; k < scene.actors.size(); ++k) {
    const Actor& actor = *scene.actors[k];
    const RigidTransform X_CO = X_SC.inverse() * actor.X_SO();
    for (std::size_t part = 0; part < actor.parts().size(); ++part) {
      projected_.clear();
      for (const Eigen::Vector3f& vertex : actor.vertices(part)) {
        const Projection p = Project(camera_, X_CO * vertex.cast<double>());
        projected_.push_back(p.valid ? Eigen::Vector2f(p.uv.cast<float>())
                                     : Eigen::Vector2f::Constant(std::nanf("")));
      }
      for (const auto& [a, b, c] : actor.parts()[part].mesh->triangles) {
        const Eigen::Vector2f low = projected_[a].cwiseMin(projected_[b]).cwiseMin(projected_[c]);
        const Eigen::Vector2f high = projected_[a].cwiseMax(projected_[b]).cwiseMax(projected_[c]);
        if (!(high.x() > -kMargin_px && high.y() > -kMargin_px &&
              low.x() < static_cast<float>(camera_.width) + kMargin_px &&
              low.y() < static_cast<float>(camera_.height) + kMargin_px)) {
          continue;
        }
        const auto tile = [](float px, int count) {
          return std::clamp(static_cast<int>(px) / kTile, 0, count - 1);
        };
        const int x0 = tile(low.x() - kMargin_px, tiles_x_),
                  x1 = tile(high.x() + kMargin_px, tiles_x_);
        const int y0 = tile(low.y() - kMargin_px, tiles_y_),
                  y1 = tile(high.y() + kMargin_px, tiles_y_);
        for (int y = y0; y <= y1; ++y) {
          for (int x = x0; x <= x1; ++x) {
            tile_mask_[static_cast<std::size_t>(y * tiles_x_ + x)] |=
                static_cast<std::uint8_t>(1u << k);
          }
        }
      }
    }
  }
}

void PictureRenderer::Trace(const SceneView& scene, unsigned mask, HeadPixels* pixels) {
  const int n = batch_.size;
  for (int i = 0; i < n; ++i) {
    batch_.t[static_cast<std::size_t>(i)] = kFar_m;
    owner_[static_cast<std::size_t>(i)] = -1;
  }
  for (std::size_t k = 0; k < scene.actors.size(); ++k) {
    if ((mask >> k & 1) == 0) continue;
    const Eigen::Matrix3f& R = shaders_[k].R_OC();
    for (std::size_t i = 0; i < static_cast<std::size_t>(n); ++i) {
      batch_.dx[i] = R(0, 0) * x_[i] + R(0, 1) * y_[i] + R(0, 2);
      batch_.dy[i] = R(1, 0) * x_[i] + R(1, 1) * y_[i] + R(1, 2);
      batch_.dz[i] = R(2, 0) * x_[i] + R(2, 1) * y_[i] + R(2, 2);
    }
    scene.actors[k]->rays().Intersect(shaders_[k].p_OC(), &batch_);
    for (std::size_t i = 0; i < static_cast<std::size_t>(n); ++i) {
      if (!batch_.hit[i]) continue;
      owner_[i] = static_cast<std::int8_t>(k);
      if (pixels == nullptr || k > 0) continue;
      const Label label = scene.actors[0]->triangle_label(batch_.mesh[i], batch_.triangle[i]);
      pixels->head += IsHead(label);
      pixels->face += IsFace(label);
    }
  }
}

void PictureRenderer::LookUpMisses(const SceneView& scene) {
  constexpr int kRun = Background::kRun;
  for (int begin = 0; begin < batch_.size; begin += kRun) {
    bool any = false;
    for (int i = begin; i < begin + kRun; ++i) any |= owner_[static_cast<std::size_t>(i)] < 0;
    if (any)
      scene.background->Sample(p_SC_, R_SC_, x_.data() + begin, y_.data() + begin,
                               background_.data() + begin);
  }
}

void PictureRenderer::ShadeHits() {
  std::array<std::uint8_t, RayBatch::kMax> rays;
  for (std::size_t k = 0; k < shaders_.size(); ++k) {
    int count = 0;
    for (int i = 0; i < batch_.size; ++i) {
      rays[static_cast<std::size_t>(count)] = static_cast<std::uint8_t>(i);
      count += owner_[static_cast<std::size_t>(i)] == static_cast<int>(k);
    }
    if (count > 0) shaders_[k].Shade(batch_, x_.data(), y_.data(), rays.data(), count, &shaded_);
  }
}

void PictureRenderer::RenderTile(const SceneView& scene, int tile_x, int tile_y,
                                 const RgbView& picture, std::uint8_t* labels, HeadPixels* pixels) {
  const auto tile = static_cast<std::size_t>(tile_y * tiles_x_ + tile_x);
  const unsigned mask = tile_mask_[tile];
  std::copy_n(ray_x_.data() + tile * kTilePixels, kTilePixels, x_.data());
  std::copy_n(ray_y_.data() + tile * kTilePixels, kTilePixels, y_.data());
  batch_.size = kTilePixels;
  const bool whole =
      (tile_x + 1) * kTile <= camera_.width && (tile_y + 1) * kTile <= camera_.height;
  if (mask == 0 && tile_drawn_[tile] == 0 && whole && labels == nullptr) {
    RenderBackgroundTile(scene, tile_x * kTile, tile_y * kTile, picture);
    return;
  }
  if (mask != 0) {
    Trace(scene, mask, pixels);
    ShadeHits();
  } else {
    owner_.fill(-1);
  }
  LookUpMisses(scene);
  const bool keep_samples = mask != 0 || tile_drawn_[tile] != 0;
  tile_drawn_[tile] = mask != 0;
  for (std::size_t i = 0; i < kTilePixels; ++i) {
    const int x = tile_x * kTile + TileColumn(static_cast<int>(i)),
              y = tile_y * kTile + TileRow(static_cast<int>(i));
    if (x >= camera_.width || y >= camera_.height) continue;
    const auto pixel = static_cast<std::size_t>(y * camera_.width + x);
    std::uint8_t* out = picture.data + static_cast<std::ptrdiff_t>(y) * picture.stride + 3 * x;
    Sample sample{0, kFar_m};
    Label label = Label::kBackground;
    if (owner_[i] < 0) {
      const std::uint32_t rgb = background_[i];
      out[0] = static_cast<std::uint8_t>(rgb);
      out[1] = static_cast<std::uint8_t>(rgb >> 8);
      out[2] = static_cast<std::uint8_t>(rgb >> 16);
    } else {
      out[0] = response_.Encode(shaded_.red[i]);
      out[1] = response_.Encode(shaded_.green[i]);
      out[2] = response_.Encode(shaded_.blue[i]);
      sample = {static_cast<std::uint32_t>(owner_[i] + 1) << 8 | batch_.mesh[i], batch_.t[i]};
      label = shaded_.label[i];
      if (owner_[i] == 0 && pixels != nullptr) {
        const Label part = scene.actors[0]->triangle_label(batch_.mesh[i], batch_.triangle[i]);
        pixels->head_visible += IsHead(part);
        pixels->face_visible += IsFace(part);
      }
    }
    if (keep_samples) samples_[pixel] = sample;
    if (labels != nullptr) labels[pixel] = static_cast<std::uint8_t>(label);
  }
}

void PictureRenderer::RenderBackgroundTile(const SceneView& scene, int x0, int y0,
                                           const RgbView& picture) {
  static_assert(Background::kRun == 8);  // a block of 4 x 2 pixels
  for (int block = 0; block < kTilePixels; block += 8) {
    scene.background->Sample(p_SC_, R_SC_, x_.data() + block, y_.data() + block,
                             background_.data() + block);
    for (int i = block; i < block + 8; i += 4) {
      std::uint8_t* out = picture.row(y0 + TileRow(i)) + 3 * (x0 + TileColumn(i));
      for (int k = 0; k < 4; ++k) {
        const std::uint32_t rgb = background_[static_cast<std::size_t>(i + k)];
        out[3 * k] = static_cast<std::uint8_t>(rgb);
        out[3 * k + 1] = static_cast<std::uint8_t>(rgb >> 8);
        out[3 * k + 2] = static_cast<std::uint8_t>(rgb >> 16);
      }
    }
  }
}

void PictureRenderer::FindEdges() {
  edges_.clear();
  const int w = camera_.width, h = camera_.height;
  // A pixel between two others in a row or column: another surface beside it, or a step in depth
  // (the slope of a surface seen at a grazing angle is none).
  const auto is_edge = [this](std::size_t before, std::size_t at, std::size_t after) {
    const Sample &p = samples_[before], &q = samples_[at], &r = samples_[after];
    return p.surface != q.surface || r.surface != q.surface ||
           std::abs(p.depth - 2 * q.depth + r.depth) > kDepthEdge_m;
  };
  for (int tile = 0; tile < tiles_x_ * tiles_y_; ++tile) {
    if (tile_mask_[static_cast<std::size_t>(tile)] == 0) continue;
    const int x0 = tile % tiles_x_ * kTile, y0 = tile / tiles_x_ * kTile;
    for (int y = y0; y < std::min(y0 + kTile, h); ++y) {
      const auto row = static_cast<std::size_t>(y * w);
      const auto up = static_cast<std::size_t>(std::max(y - 1, 0) * w);
      const auto down = static_cast<std::size_t>(std::min(y + 1, h - 1) * w);
      for (int x = x0; x < std::min(x0 + kTile, w); ++x) {
        const auto column = static_cast<std::size_t>(x);
        const auto left = static_cast<std::size_t>(std::max(x - 1, 0));
        const auto right = static_cast<std::size_t>(std::min(x + 1, w - 1));
        if (is_edge(row + left, row + column, row + right) ||
            is_edge(up + column, row + column, down + column)) {
          edges_.push_back(y * w + x);
        }
      }
    }
  }
}

void PictureRenderer::SmoothEdges(const SceneView& scene, const RgbView& picture) {
  const int w = camera_.width, h = camera_.height;
  const auto samples = static_cast<int>(offsets_.size());
  const std::size_t per_batch = RayBatch::kMax / offsets_.size();
  const float scale = 1 / static_cast<float>(samples);
  for (std::size_t begin = 0; begin < edges_.size(); begin += per_batch) {
    const std::size_t end = std::min(begin + per_batch, edges_.size());
    batch_.size = static_cast<int>(end - begin) * samples;
    std::size_t i = 0;
    unsigned mask = 0;
    for (std::size_t e = begin; e < end; ++e) {
      const int x = edges_[e] % w, y = edges_[e] / w;
      mask |= tile_mask_[static_cast<std::size_t>(y / kTile * tiles_x_ + x / kTile)];
      // The ray's change along a pixel, from the neighbours.
      const int left = std::max(x - 1, 0), right = std::min(x + 1, w - 1);
      const int up = std::max(y - 1, 0), down = std::min(y + 1, h - 1);
      const auto slope = [&](const std::vector<float>& ray, std::size_t a, std::size_t b,
                             int distance) {
        return (ray[b] - ray[a]) / static_cast<float>(std::max(distance, 1));
      };
      const std::size_t at_left = RayIndex(left, y), at_right = RayIndex(right, y),
                        at_up = RayIndex(x, up), at_down = RayIndex(x, down),
                        pixel = RayIndex(x, y);
      const float xx = slope(ray_x_, at_left, at_right, right - left),
                  yx = slope(ray_y_, at_left, at_right, right - left);
      const float xy = slope(ray_x_, at_up, at_down, down - up),
                  yy = slope(ray_y_, at_up, at_down, down - up);
      for (const Eigen::Vector2f& offset : offsets_) {
        x_[i] = ray_x_[pixel] + offset.x() * xx + offset.y() * xy;
        y_[i] = ray_y_[pixel] + offset.x() * yx + offset.y() * yy;
        ++i;
      }
    }
    Trace(scene, mask, nullptr);
    ShadeHits();
    LookUpMisses(scene);
    i = 0;
    for (std::size_t e = begin; e < end; ++e) {
      float red = 0, green = 0, blue = 0;
      for (int s = 0; s < samples; ++s, ++i) {
        if (owner_[i] < 0) {
          const std::uint32_t rgb = background_[i];
          red += response_.Decode(static_cast<std::uint8_t>(rgb));
          green += response_.Decode(static_cast<std::uint8_t>(rgb >> 8));
          blue += response_.Decode(static_cast<std::uint8_t>(rgb >> 16));
        } else {
          red += shaded_.red[i];
          green += shaded_.green[i];
          blue += shaded_.blue[i];
        }
      }
      std::uint8_t* out = picture.data +
                          static_cast<std::ptrdiff_t>(edges_[e] / w) * picture.stride +
                          3 * (edges_[e] % w);
      out[0] = response_.Encode(red * scale);
      out[1] = response_.Encode(green * scale);
      out[2] = response_.Encode(blue * scale);
    }
  }
}

void PictureRenderer::CountOutside(const SceneView& scene, HeadPixels* pixels) {
  // The part of the head beyond the picture's borders, on a coarse lattice of rays.
  constexpr int kStep = 4;
  Eigen::Vector2d low(1e9, 1e9), high(-1e9, -1e9);
  const RigidTransform X_CO =
      MakeTransform(shaders_[0].R_OC().cast<double>().transpose().eval(), Eigen::Vector3d::Zero());
  const Eigen::Vector3d p_OC = shaders_[0].p_OC().cast<double>();
  for (std::size_t part = 0; part < scene.actors[0]->parts().size(); ++part) {
    for (const Eigen::Vector3f& vertex : scene.actors[0]->vertices(part)) {
      const Projection p = Project(camera_, X_CO * (vertex.cast<double>() - p_OC));
      if (!p.valid) continue;
      low = low.cwiseMin(p.uv);
      high = high.cwiseMax(p.uv);
    }
  }
  if (low.x() > 0 && low.y() > 0 && high.x() < camera_.width && high.y() < camera_.height) return;
  const auto clamped = [](double x) { return static_cast<int>(std::clamp(x, -4000.0, 8000.0)); };
  HeadPixels outside;
  batch_.size = 0;
  const auto flush = [&] {
    if (batch_.size > 0) Trace(scene, 1, &outside);
    batch_.size = 0;
  };
  for (int y = clamped(low.y()); y <= clamped(high.y()); y += kStep) {
    for (int x = clamped(low.x()); x <= clamped(high.x()); x += kStep) {
      if (x >= 0 && y >= 0 && x < tiles_x_ * kTile && y < tiles_y_ * kTile) continue;
      const Eigen::Vector3d ray = Unproject(camera_, {x, y});
      x_[static_cast<std::size_t>(batch_.size)] = static_cast<float>(ray.x());
      y_[static_cast<std::size_t>(batch_.size)] = static_cast<float>(ray.y());
      if (++batch_.size == RayBatch::kMax) flush();
    }
  }
  flush();
  pixels->head += outside.head * kStep * kStep;
  pixels->face += outside.face * kStep * kStep;
}

}  // namespace visavis
