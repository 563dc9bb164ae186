#include "services/simulator/bake.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace visavis {
namespace {

std::uint8_t EncodeSigned(double x) {
  return static_cast<std::uint8_t>(std::lround(std::clamp(128 + 64 * x, 1.0, 255.0)));
}

std::uint8_t EncodeUnit(double x) {
  return static_cast<std::uint8_t>(std::lround(255 * std::clamp(x, 0.0, 1.0)));
}

std::uint8_t EncodeAlbedo(double srgb) {
  return EncodeUnit(std::sqrt(LinearFromSrgb(std::clamp(srgb, 0.0, 1.0))));
}

/// Minus the gradient of a height on the surface with tangents @p tu, @p tv, slopes limited to 1.
Eigen::Vector3d NormalChange(const Eigen::Vector3d& tu, const Eigen::Vector3d& tv, double hu,
                             double hv) {
  const double uu = tu.squaredNorm(), vv = tv.squaredNorm(), uv = tu.dot(tv);
  const double det = uu * vv - uv * uv;
  if (!(det > 1e-12)) return Eigen::Vector3d::Zero();
  const Eigen::Vector3d gradient = (tu * (hu * vv - hv * uv) + tv * (hv * uu - hu * uv)) / det;
  return -gradient / std::max(1.0, gradient.norm());
}

}  // namespace

Texel EncodeTexel(const Paint& paint, const Eigen::Vector3d& normal_change) {
  Texel texel;
  texel.red = EncodeAlbedo(paint.colour.x());
  texel.green = EncodeAlbedo(paint.colour.y());
  texel.blue = EncodeAlbedo(paint.colour.z());
  texel.gloss = EncodeUnit(paint.gloss);
  texel.dx = EncodeSigned(normal_change.x());
  texel.dy = EncodeSigned(normal_change.y());
  texel.dz = EncodeSigned(normal_change.z());
  texel.label = paint.label;
  return texel;
}

Texture BakeTexture(const PaintedSurface& surface, int width, int height) {
  Texture texture(width, height);
  const auto size = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  std::vector<Eigen::Vector3f> position(size);
  std::vector<float> relief(size);
  std::vector<Paint> paints(size);
  for (int j = 0; j < height; ++j) {
    for (int i = 0; i < width; ++i) {
      const double u = (i + 0.5) / width, v = (j + 0.5) / height;
      const auto k = static_cast<std::size_t>(j * width + i);
      position[k] = surface.position_mm(u, v).cast<float>();
      paints[k] = surface.paint(u, v);
      relief[k] = static_cast<float>(paints[k].height_mm);
    }
  }
  for (int j = 0; j < height; ++j) {
    for (int i = 0; i < width; ++i) {
      const auto at = [&](int x, int y) {
        return static_cast<std::size_t>(std::clamp(y, 0, height - 1) * width +
                                        std::clamp(x, 0, width - 1));
      };
      const std::size_t left = at(i - 1, j), right = at(i + 1, j), up = at(i, j - 1),
                        down = at(i, j + 1);
      const Eigen::Vector3d change = NormalChange((position[right] - position[left]).cast<double>(),
                                                  (position[down] - position[up]).cast<double>(),
                                                  static_cast<double>(relief[right] - relief[left]),
                                                  static_cast<double>(relief[down] - relief[up]));
      texture.at(i, j) = EncodeTexel(paints[at(i, j)], change);
    }
  }
  texture.BuildLevels();
  return texture;
}

Texture UniformTexture(const Srgb& colour, double gloss, Label label) {
  Paint paint;
  paint.colour = colour;
  paint.gloss = gloss;
  paint.label = label;
  Texture texture(2, 2);
  for (int k = 0; k < 4; ++k)
    texture.at(k % 2, k / 2) = EncodeTexel(paint, Eigen::Vector3d::Zero());
  texture.BuildLevels();
  return texture;
}

}  // namespace visavis
