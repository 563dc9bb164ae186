#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "common/core/random.h"
#include "services/calibrate_tool/board.h"
#include "tests/support/board_scene.h"
#include "visavis/images_t.hpp"

namespace visavis {

/// Renders a board as a camera with a slightly soft lens sees it, in grey with noise.
class BoardRenderer {
 public:
  BoardRenderer(const Board& board, const Pinhole& camera);

  /// @p X_KT  board in this camera. @p motion_px  of the picture along x while it was taken.
  std::vector<std::uint8_t> Render(const RigidTransform& X_KT, double noise_sigma, Random* random,
                                   double motion_px = 0) const;

  const Pinhole& camera() const { return camera_; }

 private:
  float Shade(double x_m, double y_m) const;

  const Board& board_;
  const Pinhole camera_;
  const int columns_, rows_;           // of the half-pixel grid
  std::vector<Eigen::Vector2f> rays_;  // x, y at z = 1
  int map_width_, map_height_;
  double pixels_per_m_;
  std::vector<std::uint8_t> map_;  // the board itself, black and white
};

/// Both cameras of a scene.
class PairRenderer {
 public:
  explicit PairRenderer(const BoardScene& scene)
      : scene_(scene), right_(scene.board, scene.rig.right), left_(scene.board, scene.rig.left) {}
  images_t Render(const RigidTransform& X_CT, std::int64_t utime_us, Random* random,
                  double motion_px = 0) const;

 private:
  const BoardScene& scene_;
  const BoardRenderer right_, left_;
};

}  // namespace visavis
