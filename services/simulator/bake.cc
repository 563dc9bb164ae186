#include "services/simulator/bake.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace visavis {
namespace {

std::uint8_t EncodeSigned(double x) {
  return static_cast<std::uint8_t>(std::clamp(128 + 64 * x, 1.0, 255.0) + 0.5);
}

std::uint8_t EncodeUnit(double x) {
  return static_cast<std::uint8_t>(255 * std::clamp(x, 0.0, 1.0) + 0.5);
}

/// 255 sqrt(linear reflectance) of an sRGB value, by table.
std::uint8_t EncodeAlbedo(double srgb) {
  static const std::array<std::uint8_t, 1024> kTable = [] {
    std::array<std::uint8_t, 1024> table;
    for (std::size_t i = 0; i < table.size(); ++i) {
      table[i] = EncodeUnit(std::sqrt(LinearFromSrgb(static_cast<double>(i) / 1023)));
    }
    return table;
  }();
  return kTable[static_cast<std::size_t>(1023 * std::clamp(srgb, 0.0, 1.0) + 0.5)];
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

void EncodeChange(const Eigen::Vector3d& change, Texel* texel) {
  texel->dx = EncodeSigned(change.x());
  texel->dy = EncodeSigned(change.y());
  texel->dz = EncodeSigned(change.z());
}

}  // namespace

Texel EncodeTexel(const Paint& paint) {
  Texel texel;
  texel.red = EncodeAlbedo(paint.colour.x());
  texel.green = EncodeAlbedo(paint.colour.y());
  texel.blue = EncodeAlbedo(paint.colour.z());
  texel.gloss = EncodeUnit(paint.gloss);
  texel.label = paint.label;
  return texel;
}

Texture BakeTexture(const PaintedSurface& surface, int width, int height) {
  Texture texture(width, height);
  // Places and relief of three rows: the one in work, above and below.
  struct Row {
    std::vector<Eigen::Vector3d> position;
    std::vector<double> relief;
  };
  std::array<Row, 3> rows;
  for (Row& row : rows) {
    row.position.resize(static_cast<std::size_t>(width));
    row.relief.resize(static_cast<std::size_t>(width));
  }
  const auto row_of = [&](int j) -> Row& { return rows[static_cast<std::size_t>(j % 3)]; };
  const auto paint_row = [&](int j) {
    Row& row = row_of(j);
    for (int i = 0; i < width; ++i) {
      const double u = (i + 0.5) / width, v = (j + 0.5) / height;
      const Paint paint = surface.paint(u, v);
      row.position[static_cast<std::size_t>(i)] = surface.position_mm(u, v);
      row.relief[static_cast<std::size_t>(i)] = paint.height_mm;
      texture.at(i, j) = EncodeTexel(paint);
    }
  };
  paint_row(0);
  for (int j = 0; j < height; ++j) {
    if (j + 1 < height) paint_row(j + 1);
    const Row &up = row_of(std::max(j - 1, 0)), &down = row_of(std::min(j + 1, height - 1)),
              &row = row_of(j);
    for (int i = 0; i < width; ++i) {
      const auto at = static_cast<std::size_t>(i),
                 left = static_cast<std::size_t>(std::max(i - 1, 0)),
                 right = static_cast<std::size_t>(std::min(i + 1, width - 1));
      EncodeChange(
          NormalChange(row.position[right] - row.position[left],
                       down.position[at] - up.position[at], row.relief[right] - row.relief[left],
                       down.relief[at] - up.relief[at]),
          &texture.at(i, j));
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
  for (int k = 0; k < 4; ++k) texture.at(k % 2, k / 2) = EncodeTexel(paint);
  texture.BuildLevels();
  return texture;
}

}  // namespace visavis
