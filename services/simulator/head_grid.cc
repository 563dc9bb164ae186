#include "services/simulator/head_grid.h"

#include <algorithm>
#include <cmath>

#include "services/simulator/procedural_noise.h"

namespace visavis {
namespace {

using Eigen::Vector3d;

constexpr double kDegree = M_PI / 180;

/// Unsigned azimuth [deg] about the vertical: 0 at the face, 180 at the back.
double Azimuth(const Vector3d& p) { return std::atan2(std::abs(p.x()), -p.z()) / kDegree; }

/// Ray of grid point (u, v): from an axis inside the head that follows the neck down.
void GridRay(double u, double v, Vector3d* origin, Vector3d* direction) {
  static const Profile front{{0, -90},   {0.10, -55}, {0.18, -33}, {0.62, 45},
                             {0.72, 60}, {0.78, 60},  {0.86, 45},  {1, 5}};
  static const Profile back{{0, -90}, {0.18, -42}, {0.62, 12}, {0.72, 24}, {0.86, 22}, {1, 5}};
  static const Profile down{{0, 15}, {0.70, 15}, {0.78, 42}, {0.86, 100}, {1, 222}};
  const double s = u - 0.5;
  const double azimuth = 2 * M_PI * s - 0.52 * std::sin(2 * M_PI * s);
  const double blend = SmoothStep(45, 130, std::abs(azimuth) / kDegree);
  const double elevation = kDegree * (front(v) + (back(v) - front(v)) * blend);
  const double y = down(v);
  *origin = {0, y, -10 + 0.19 * (y - 15)};
  *direction = {std::cos(elevation) * std::sin(azimuth), std::sin(elevation),
                -std::cos(elevation) * std::cos(azimuth)};
}

}  // namespace

Vector3d HeadGrid::Interpolate(const std::vector<Vector3d>& points, double u, double v) const {
  const double x = std::clamp(u, 0.0, 1.0) * columns, y = std::clamp(v, 0.0, 1.0) * rows;
  const int i = std::min(static_cast<int>(x), columns - 1),
            j = std::min(static_cast<int>(y), rows - 1);
  const double a = x - i, b = y - j;
  const Vector3d* p = points.data() + j * (columns + 1) + i;
  const Vector3d* q = p + columns + 1;
  return (1 - b) * ((1 - a) * p[0] + a * p[1]) + b * ((1 - a) * q[0] + a * q[1]);
}

double InsideHairline(const Subject& subject, const Vector3d& p, bool ragged) {
  const HairStyle& hair = subject.hair;
  if (hair.kind == HairStyle::Kind::kBald) return -100;
  const double azimuth = Azimuth(p);
  if (hair.kind == HairStyle::Kind::kBeanie) return -30 + 0.35 * (azimuth - 90) - p.y() + 22;
  // The hairline's y over the azimuth: forehead, temple, sideburn, over the ear, nape.
  static const Profile line{{0, -55},  {14, -56}, {30, -60}, {42, -50}, {50, -34},
                            {60, -8},  {66, 10},  {70, 34},  {82, 36},  {85, 14},
                            {108, 12}, {116, 50}, {128, 88}, {180, 96}};
  const double temple = hair.temple_mm * std::exp(-std::pow((azimuth - 32) / 12, 2));
  const double receding = hair.hairline_mm * SmoothStep(62, 40, azimuth);
  double inside = line(azimuth) - temple - receding - p.y();
  // Across the steep parts of the line the distance is less than that along y.
  if (azimuth > 40 && azimuth < 90) inside = std::clamp(inside, -60.0, 60.0) * 0.7;
  if (ragged) {
    inside += hair.raggedness_mm * (FractalNoise(0.11 * p, 2, subject.seed + 5) +
                                    0.8 * Noise(0.45 * p, subject.seed + 6));
  }
  return inside;
}

double InsideBeard(const Subject& subject, const Vector3d& p) {
  if (subject.hair.beard <= 0 || p.z() > 20) return -100;
  const double x = std::abs(p.x());
  // Below a line from the ear over the cheek to the corner of the mouth; and the moustache.
  const double cheek = p.y() - (62 + 26 * SmoothStep(62, 28, x));
  const double moustache = std::min(p.y() - 74.0, 31.0 - x);
  const double neck = 156 - p.y() + 0.25 * p.z();
  double inside = std::min(std::max(cheek, moustache), neck);
  const double lips = std::hypot((p.x()) / 25.5, (p.y() - 92.5) / 9.5);
  inside = std::min(inside, 9 * (lips - 1));
  inside = std::min(inside, 0.7 * (6 - p.z()));
  return inside + 2.0 * FractalNoise(0.12 * p, 2, subject.seed + 9);
}

double HairThickness(const Subject& subject, const Vector3d& p) {
  const HairStyle& hair = subject.hair;
  double thickness = 0;
  const double inside = InsideHairline(subject, p, false);
  if (inside > 0) {
    const double top = SmoothStep(10, -55, p.y());
    const double full = hair.sides_mm + (hair.thickness_mm - hair.sides_mm) * top;
    const double edge = hair.kind == HairStyle::Kind::kBeanie ? 2.0 : 14.0;
    thickness = full * std::pow(std::min(inside / edge, 1.0), 0.6);
    if (hair.kind == HairStyle::Kind::kBeanie) {
      thickness += 2.0 * SmoothStep(34, 31, inside);  // the turned-up rim
      thickness += 9 * SmoothStep(-80, -95, p.y());
    } else {
      const double lock = hair.curl > 0.5 ? 0.09 : 0.045;
      thickness *= 1 + 0.22 * FractalNoise(lock * p, 2, subject.seed + 7);
    }
  }
  const double beard = InsideBeard(subject, p);
  if (beard > 0 && hair.beard > 0.5) {
    thickness = std::max(thickness, 6.0 * (hair.beard - 0.5) * 2 * std::min(beard / 14, 1.0));
  }
  return thickness;
}

HeadGrid BuildHeadGrid(const Subject& subject, const SkinSurface& surface, int columns, int rows) {
  HeadGrid grid{columns, rows, {}, {}};
  for (int j = 0; j <= rows; ++j) {
    for (int i = 0; i < columns; ++i) {
      Vector3d origin, direction;
      GridRay(static_cast<double>(i) / columns, static_cast<double>(j) / rows, &origin, &direction);
      grid.skin.push_back(surface.Outermost(origin, direction));
    }
    grid.skin.push_back(grid.skin_at(0, j));
  }
  for (const Vector3d& p : grid.skin) {
    const double thickness = HairThickness(subject, p);
    grid.outer.push_back(p);
    if (thickness <= 0) continue;
    constexpr double h = 0.5;  // [mm]
    const double d = surface.Distance(p);
    const Vector3d gradient(surface.Distance(p + Vector3d(h, 0, 0)) - d,
                            surface.Distance(p + Vector3d(0, h, 0)) - d,
                            surface.Distance(p + Vector3d(0, 0, h)) - d);
    grid.outer.back() += thickness * gradient.normalized();
  }
  return grid;
}

}  // namespace visavis
