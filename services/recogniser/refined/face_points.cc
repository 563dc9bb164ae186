#include "services/recogniser/refined/face_points.h"

#include <algorithm>
#include <cmath>

namespace visavis {
namespace {

using Eigen::Vector3f;

// The drawing of a face seen from the front: 1 mm a cell, the origin of M in the middle column.
constexpr int kColumns = 161, kRows = 201, kMiddle = 80, kTop = 50;

constexpr float kOnSurface_m = 2e-7f;
constexpr float kHighest_m = -0.037f, kLowest_m = 0.109f;  ///< rows of points, y in M

class Drawing {
 public:
  Drawing() : cells_(static_cast<std::size_t>(kColumns) * kRows) {}

  /// Darkens where @p inside(x_mm, y_mm) to at least @p darkness.
  template <typename Inside>
  void Fill(float darkness, const Inside& inside) {
    for (int j = 0; j < kRows; ++j) {
      for (int i = 0; i < kColumns; ++i) {
        if (!inside(static_cast<float>(i - kMiddle), static_cast<float>(j - kTop))) continue;
        float& cell = cells_[Index(i, j)];
        cell = std::min(cell, -darkness);
      }
    }
  }

  Drawing Blurred(float sigma_mm) const {
    const int radius = static_cast<int>(std::ceil(3 * sigma_mm));
    std::vector<float> weights;
    float sum = 0;
    for (int k = -radius; k <= radius; ++k) {
      const float x = static_cast<float>(k) / sigma_mm;
      weights.push_back(std::exp(-0.5f * x * x));
      sum += weights.back();
    }
    for (float& w : weights) w /= sum;
    const float* weight = weights.data() + radius;  // weight[k] of k = -radius ... radius
    // Sums of whole rows, cell by cell: the order of a cell's own sum stays.
    Drawing rows, both;
    std::vector<float> padded(static_cast<std::size_t>(kColumns + 2 * radius));
    for (int j = 0; j < kRows; ++j) {
      for (int i = -radius; i < kColumns + radius; ++i) {
        padded[static_cast<std::size_t>(i + radius)] = Cell(i, j);
      }
      for (int k = -radius; k <= radius; ++k) {
        AddRow(weight[k], padded.data() + radius + k, &rows.cells_[Index(0, j)]);
      }
    }
    for (int j = 0; j < kRows; ++j) {
      for (int k = -radius; k <= radius; ++k) {
        const int from = std::clamp(j + k, 0, kRows - 1);
        AddRow(weight[k], &rows.cells_[Index(0, from)], &both.cells_[Index(0, j)]);
      }
    }
    return both;
  }

  float At(const Vector3f& p) const {
    return Cell(static_cast<int>(std::lround(1000 * p.x())) + kMiddle,
                static_cast<int>(std::lround(1000 * p.y())) + kTop);
  }

 private:
  static void AddRow(float weight, const float* from, float* to) {
    for (int i = 0; i < kColumns; ++i) to[i] += weight * from[i];
  }
  static std::size_t Index(int i, int j) {
    return static_cast<std::size_t>(j) * kColumns + static_cast<std::size_t>(i);
  }
  float Cell(int i, int j) const {
    i = std::clamp(i, 0, kColumns - 1);
    j = std::clamp(j, 0, kRows - 1);
    return cells_[Index(i, j)];
  }
  std::vector<float> cells_;
};

/// Inside of an ellipse.
bool In(float dx, float dy, float a, float b) { return dx * dx / (a * a) + dy * dy / (b * b) < 1; }

Drawing GenericFace(const HeadShape& shape) {
  Drawing face;
  const float eye_x = 1000 * shape.eye_x, eye_y = 1000 * shape.eye_y, brow_y = 1000 * shape.brow_y;
  const float nostril_y = 1000 * shape.nostril_y, mouth_y = 1000 * shape.mouth_y;
  const auto bow = [](float dx, float curvature) { return curvature * dx * dx; };
  face.Fill(1.0f, [&](float x, float y) {  // brows
    const float dx = std::abs(x) - 33;
    return std::abs(dx) < 18 && std::abs(y - brow_y - bow(dx, 0.0035f)) < 2.5f;
  });
  face.Fill(0.35f, [&](float x, float y) { return In(std::abs(x) - eye_x, y - eye_y, 14, 5); });
  face.Fill(1.0f, [&](float x, float y) { return In(std::abs(x) - eye_x, y - eye_y, 6, 6); });
  face.Fill(0.9f, [&](float x, float y) {  // upper lids
    const float dx = std::abs(x) - eye_x;
    return std::abs(dx) < 14 && std::abs(y - eye_y + 4 - bow(dx, 0.012f)) < 1.5f;
  });
  face.Fill(0.7f, [&](float x, float y) { return In(std::abs(x) - 7, y - nostril_y, 3, 3); });
  face.Fill(0.25f, [&](float x, float y) { return In(x, y - mouth_y, 23, 8); });  // lips
  face.Fill(0.7f,
            [&](float x, float y) { return std::abs(x) < 24 && std::abs(y - mouth_y) < 1.6f; });
  return face;
}

/// The surface at height @p y, seen from the axis x = z = 0 at @p azimuth (0: straight ahead).
Vector3f PointAt(const HeadSurface& surface, float y, float azimuth) {
  const float sine = std::sin(azimuth), cosine = std::cos(azimuth);
  Vector3f p;
  const auto beyond = [&](float rho) {
    p = {rho * sine, y, -rho * cosine};
    const float r = p.norm();
    return r - surface.Radius(p / r);
  };
  // Regula falsi; an end that stays twice counts half (the Illinois rule).
  float inside = 1e-3f, outside = 0.2f;
  float below = beyond(inside), above = beyond(outside);
  if (below >= 0) return (beyond(inside), p);
  int last = 0;
  for (int k = 0; k < 22; ++k) {
    const float rho = (inside * above - outside * below) / (above - below);
    const float off = beyond(rho);
    if (std::abs(off) < kOnSurface_m) break;
    const int side = off < 0 ? -1 : 1;
    (off < 0 ? inside : outside) = rho;
    (off < 0 ? below : above) = off;
    if (side == last) (off < 0 ? above : below) *= 0.5f;
    last = side;
  }
  return p;
}

}  // namespace

FacePoints FacePointsOf(const HeadSurface& surface, double spacing_m) {
  FacePoints face;
  const auto step = static_cast<float>(spacing_m);
  const Drawing drawing = GenericFace(surface.shape());
  const std::array<Drawing, 4> blurred = {drawing.Blurred(1.9f), drawing.Blurred(7.5f),
                                          drawing.Blurred(4.0f), drawing.Blurred(14.0f)};
  const int num_rows = static_cast<int>((kLowest_m - kHighest_m) / step) + 1;
  float y = kHighest_m;
  for (int row = 0; row < num_rows; ++row, y += step) {
    float azimuth = 0;
    for (int column = 0; azimuth < 1.35f; ++column) {
      const Vector3f right = PointAt(surface, y, azimuth);
      for (const float side : {1.0f, -1.0f}) {
        if (column == 0 && side < 0) continue;
        const Vector3f p = side > 0 ? right : PointAt(surface, y, -azimuth);
        const Vector3f n = surface.NormalAt(p);
        if (surface.HairSide(p) > -0.009f || n.z() > -0.05f) continue;
        const bool front = n.z() < -0.55f && p.z() < -0.030f && std::abs(p.x()) < 0.056f;
        face.points.push_back(p);
        face.normals.push_back(n);
        face.generic[kFineBand].push_back(front ? blurred[0].At(p) - blurred[1].At(p) : 0);
        face.generic[kCoarseBand].push_back(front ? blurred[2].At(p) - blurred[3].At(p) : 0);
        face.has_generic.push_back(front);
      }
      azimuth += step / std::max(std::hypot(right.x(), right.z()), 0.02f);
    }
  }
  return face;
}

}  // namespace visavis
