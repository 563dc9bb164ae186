#pragma once

#include <cstdint>
#include <vector>

#include "common/geometry/pinhole.h"
#include "services/simulator/actor.h"
#include "services/simulator/background.h"
#include "services/simulator/colour.h"
#include "services/simulator/rgb_view.h"
#include "services/simulator/shader.h"

namespace visavis {

/// Everything in front of the cameras at one time.
struct SceneView {
  std::vector<const Actor*> actors;  ///< at most 8; the first is the head if there is one
  bool has_head{false};
  const Background* background;
  const Lighting* light;
};

/// How much of the head a camera sees, in pixels.
struct HeadPixels {
  std::int64_t head{0}, head_visible{0};  ///< head without neck: if nothing hid or cut it; and seen
  std::int64_t face{0}, face_visible{0};

  double head_share() const {
    return head > 0 ? static_cast<double>(head_visible) / static_cast<double>(head) : 0;
  }
  double face_share() const {
    return face > 0 ? static_cast<double>(face_visible) / static_cast<double>(face) : 0;
  }
};

/// One camera's ray tracer: a ray a pixel within the projected bounds of the actors, the background
/// by lookup elsewhere, @p edge_samples rays where neighbouring pixels see different surfaces.
/// Buffers are allocated once; not thread-safe.
class PictureRenderer {
 public:
  /// @p edge_samples: 1 (no smoothing), 2, 4, 8 or 16.
  PictureRenderer(const Pinhole& camera, int edge_samples);

  /// Renders what the camera at @p X_SC sees.
  /// @param labels  if not null: width x height, the Label at each pixel's centre
  /// @param pixels  if not null: what is seen of the first actor, if it is the head
  void Render(const SceneView& scene, const RigidTransform& X_SC, const RgbView& picture,
              std::uint8_t* labels, HeadPixels* pixels);

 private:
  struct Sample {
    std::uint32_t surface{0};  ///< (actor + 1) << 8 | mesh; 0: background
    float depth{20};           ///< [m]; 20: background
  };

  void MarkTiles(const SceneView& scene, const RigidTransform& X_SC);
  void RenderTile(const SceneView& scene, int tile_x, int tile_y, const RgbView& picture,
                  std::uint8_t* labels, HeadPixels* pixels);
  /// The tile at pixel (x0, y0), without any actor.
  void RenderBackgroundTile(const SceneView& scene, int x0, int y0, const RgbView& picture);
  /// Traces batch_ through all actors of @p mask; owner_[i]: the actor hit, or -1.
  void Trace(const SceneView& scene, unsigned mask, HeadPixels* pixels);
  void FindEdges();
  void SmoothEdges(const SceneView& scene, const RgbView& picture);
  void CountOutside(const SceneView& scene, HeadPixels* pixels);
  /// Looks the batch's misses up in the background, into background_.
  void LookUpMisses(const SceneView& scene);
  /// Shades the batch's hits into shaded_.
  void ShadeHits();

  static constexpr int kTile = 8, kTilePixels = kTile * kTile;

  /// Column and row in its tile of the tile's pixel @p i: rows of 4 x 2 blocks, what a packet of
  /// eight rays sees.
  static constexpr int TileColumn(int i) { return i / 8 % 2 * 4 + i % 4; }
  static constexpr int TileRow(int i) { return i / 16 * 2 + i / 4 % 2; }
  /// Place of a pixel's ray in ray_x_ and ray_y_.
  std::size_t RayIndex(int x, int y) const {
    const int tile = y / kTile * tiles_x_ + x / kTile, column = x % kTile, row = y % kTile;
    return static_cast<std::size_t>(tile * kTilePixels + row / 2 * 16 + column / 4 * 8 +
                                    row % 2 * 4 + column % 4);
  }

  Pinhole camera_;
  ResponseCurve response_;
  int tiles_x_, tiles_y_;
  std::vector<float> ray_x_, ray_y_;     ///< direction in C of each pixel, z = 1; tile by tile
  std::vector<std::uint8_t> tile_mask_;  ///< bit k: actor k may be seen
  std::vector<std::uint8_t>
      tile_drawn_;  ///< 1: samples_ of the tile hold surfaces, of this picture or an earlier one
  std::vector<Sample> samples_;
  std::vector<int> edges_;                ///< pixel indices
  std::vector<Eigen::Vector2f> offsets_;  ///< [px] of the edge samples
  std::vector<Shader> shaders_;
  std::vector<Eigen::Vector2f> projected_;
  Eigen::Matrix3f R_SC_;
  Eigen::Vector3f p_SC_;
  RayBatch batch_;
  std::array<float, RayBatch::kMax> x_, y_;  ///< the batch's directions in C
  std::array<std::int8_t, RayBatch::kMax> owner_;
  ShadedBatch shaded_;
  std::array<std::uint32_t, RayBatch::kMax> background_;
};

}  // namespace visavis
