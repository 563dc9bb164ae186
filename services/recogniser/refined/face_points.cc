#include "services/recogniser/refined/face_points.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "services/recogniser/refined/adult_head.h"

namespace visavis {
namespace {

using Eigen::Vector3f;

constexpr float kOnSurface_m = 2e-7f;
constexpr float kHighest_m = -0.037f, kLowest_m = 0.109f;  ///< rows of points, y in M

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

/// Where the mean adult has what the head of @p shape has at (@p x, @p y): sideways in proportion
/// to the eyes, down piece by piece between the features.
Eigen::Vector2f OnTheAdult(const HeadShape& shape, float x, float y) {
  const HeadShape adult;
  const std::array<float, 4> from = {shape.brow_y, shape.eye_y, shape.nostril_y, shape.mouth_y};
  const std::array<float, 4> to = {adult.brow_y, adult.eye_y, adult.nostril_y, adult.mouth_y};
  const float aside = x * adult.eye_x / shape.eye_x;
  if (y <= from.front()) return {aside, y + to.front() - from.front()};
  if (y >= from.back()) return {aside, y + to.back() - from.back()};
  std::size_t k = 1;
  while (y > from[k]) ++k;
  const float share = (y - from[k - 1]) / (from[k] - from[k - 1]);
  return {aside, to[k - 1] + share * (to[k] - to[k - 1])};
}

}  // namespace

FacePoints FacePointsOf(const HeadSurface& surface, double spacing_m) {
  FacePoints face;
  const auto step = static_cast<float>(spacing_m);
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
        const Eigen::Vector2f on_adult = OnTheAdult(surface.shape(), p.x(), p.y());
        const AdultLooks::Place looks = TheAdult().looks.At(on_adult.x(), on_adult.y());
        const bool front =
            n.z() < -0.5f && p.z() < -0.030f && std::abs(p.x()) < 0.056f && looks.known;
        face.points.push_back(p);
        face.normals.push_back(n);
        for (std::size_t band = 0; band < kNumBands; ++band)
          face.generic[band].push_back(front ? looks.mean[band] : 0);
        face.has_generic.push_back(front);
        face.doubt.push_back(looks.doubt);
        face.modes.push_back(looks.modes);
      }
      azimuth += step / std::max(std::hypot(right.x(), right.z()), 0.02f);
    }
  }
  return face;
}

}  // namespace visavis
