#include "tests/support/board_pictures.h"

#include <algorithm>
#include <cmath>

#include "common/convert/image_message.h"

namespace visavis {
namespace {

constexpr int kMapSquare = 64;  // pixels of the map to a square's side
constexpr float kWhite = 215, kBlack = 35, kGround = 120;

}  // namespace

BoardRenderer::BoardRenderer(const Board& board, const Pinhole& camera)
    : board_(board),
      camera_(camera),
      columns_(2 * camera.width + 1),
      rows_(2 * camera.height + 1),
      map_width_(kMapSquare * board.spec().columns),
      map_height_(kMapSquare * board.spec().rows),
      pixels_per_m_(kMapSquare / (1e-3 * board.spec().square_mm)),
      map_(static_cast<std::size_t>(map_width_ * map_height_), 0) {
  for (int row = 0; row < rows_; ++row) {
    for (int column = 0; column < columns_; ++column) {
      const Eigen::Vector3d ray = Unproject(camera, {0.5 * (column - 1), 0.5 * (row - 1)});
      rays_.emplace_back(ray.head<2>().cast<float>());
    }
  }
  for (const BoardRect& r : board.black()) {
    const auto at = [this](double m) { return static_cast<int>(std::lround(m * pixels_per_m_)); };
    for (int y = at(r.y); y < at(r.y + r.height); ++y)
      for (int x = at(r.x); x < at(r.x + r.width); ++x)
        map_[static_cast<std::size_t>(y * map_width_ + x)] = 1;
  }
}

// Between the map's pixels, so that an edge lies where it is and not at the nearest sample.
float BoardRenderer::Shade(double x_m, double y_m) const {
  const double u = x_m * pixels_per_m_ - 0.5, v = y_m * pixels_per_m_ - 0.5;
  const int x = static_cast<int>(std::floor(u)), y = static_cast<int>(std::floor(v));
  if (x < -kMapSquare || y < -kMapSquare || x >= map_width_ + kMapSquare ||
      y >= map_height_ + kMapSquare)
    return kGround;
  const auto black = [this](int column, int row) {
    return column >= 0 && row >= 0 && column < map_width_ && row < map_height_ &&
           map_[static_cast<std::size_t>(row * map_width_ + column)] != 0;
  };
  const auto a = static_cast<float>(u - x), b = static_cast<float>(v - y);
  const float share = (1 - b) * ((1 - a) * static_cast<float>(black(x, y)) +
                                 a * static_cast<float>(black(x + 1, y))) +
                      b * ((1 - a) * static_cast<float>(black(x, y + 1)) +
                           a * static_cast<float>(black(x + 1, y + 1)));
  return kWhite + share * (kBlack - kWhite);
}

std::vector<std::uint8_t> BoardRenderer::Render(const RigidTransform& X_KT, double noise_sigma,
                                                Random* random, double motion_px) const {
  // Where a ray meets the board: p = s ray with (p - p_KT) . z_K = 0, then in T.
  const Eigen::Vector3d z = X_KT.linear().col(2), p = X_KT.translation();
  const double distance = z.dot(p);
  std::vector<float> grid(rays_.size());
  for (std::size_t i = 0; i < rays_.size(); ++i) {
    const Eigen::Vector3d ray(rays_[i].x(), rays_[i].y(), 1);
    const double s = distance / z.dot(ray);
    if (!(s > 0)) {
      grid[i] = kGround;
      continue;
    }
    const Eigen::Vector3d p_T = X_KT.linear().transpose() * (s * ray - p);
    grid[i] = Shade(p_T.x(), p_T.y());
  }
  const int reach = static_cast<int>(std::lround(motion_px));
  std::vector<std::uint8_t> picture;
  picture.reserve(static_cast<std::size_t>(camera_.width * camera_.height));
  for (int y = 0; y < camera_.height; ++y) {
    for (int x = 0; x < camera_.width; ++x) {
      double sum = 0, weights = 0;
      for (int dy = 0; dy <= 2; ++dy) {
        for (int dx = -reach; dx <= 2 + reach; ++dx) {
          const int column = std::clamp(2 * x + dx, 0, columns_ - 1);
          const double weight = (dy == 1 ? 2 : 1) * (reach > 0 ? 1 : (dx == 1 ? 2 : 1));
          sum += weight * grid[static_cast<std::size_t>((2 * y + dy) * columns_ + column)];
          weights += weight;
        }
      }
      const double value = sum / weights + noise_sigma * random->Normal();
      picture.push_back(static_cast<std::uint8_t>(std::clamp(value + 0.5, 0.0, 255.0)));
    }
  }
  return picture;
}

images_t PairRenderer::Render(const RigidTransform& X_CT, std::int64_t utime_us, Random* random,
                              double motion_px) const {
  images_t message{};
  message.utime = utime_us;
  message.n_images = 2;
  message.image_types = {images_t::LEFT, images_t::RIGHT};
  message.images.resize(2);
  const auto fill = [&](const BoardRenderer& renderer, const RigidTransform& X_KT, image_t* image) {
    const auto grey = renderer.Render(X_KT, 2, random, motion_px);
    SetImage({grey.data(), renderer.camera().width, renderer.camera().height,
              renderer.camera().width, grey.size(), PixelFormat::kGray},
             utime_us, image);
  };
  fill(left_, scene_.rig.X_CL.inverse() * X_CT, &message.images[0]);
  fill(right_, X_CT, &message.images[1]);
  return message;
}

}  // namespace visavis
