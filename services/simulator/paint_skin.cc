#include <algorithm>
#include <cmath>

#include "services/simulator/paint.h"
#include "services/simulator/procedural_noise.h"

namespace visavis {
namespace {

using Eigen::Vector3d;

/// Gaussian spot on the face, mirrored: centre and radii in x and y [mm].
double Spot(const Vector3d& p, double x, double y, double rx, double ry) {
  const double a = (std::abs(p.x()) - x) / rx, b = (p.y() - y) / ry;
  const double d2 = a * a + b * b;
  return d2 < 14 ? std::exp(-d2) : 0;
}

/// A crease: 1 on the line, falling off over @p width.
double Crease(double distance, double width) {
  const double t = distance / width;
  return std::abs(t) < 3.5 ? std::exp(-t * t) : 0;
}

void PaintWrinkles(const Subject& subject, const Vector3d& p, Paint* paint) {
  const double age = subject.complexion.age, x = std::abs(p.x());
  double depth = 0;
  if (p.z() > -35) return;
  // Forehead, crow's feet, beside nose and mouth, under the eyes.
  const double wave = p.y() + 2.0 * Noise(0.03 * p, subject.seed + 21);
  depth += 0.5 * SmoothStep(-48, -38, p.y()) * SmoothStep(-6, -14, p.y()) * SmoothStep(48, 25, x) *
           std::pow(0.5 + 0.5 * std::cos(2 * M_PI * wave / 9.5), 6);
  const double fold_x = 20 + 0.36 * (p.y() - 64);
  depth += 1.2 * Crease(x - fold_x, 1.6) * SmoothStep(62, 70, p.y()) * SmoothStep(96, 84, p.y());
  depth += 0.7 * Crease(p.y() - 32 - 0.012 * (x - 26) * (x - 26), 1.3) * SmoothStep(44, 34, x) *
           SmoothStep(14, 19, x);
  depth += 0.5 * Crease(std::fmod(std::abs(p.y() - 22), 4.5) - 2.2, 0.7) * SmoothStep(49, 52, x) *
           SmoothStep(64, 56, x) * SmoothStep(12, 6, std::abs(p.y() - 22));
  const double visible = age * (0.3 + 0.7 * age);
  paint->height_mm -= 0.9 * visible * depth;
  paint->colour *= 1 - 0.22 * visible * std::min(depth, 1.3);
}

}  // namespace

Paint PaintSkin(const Subject& subject, const Vector3d& p) {
  const Complexion& c = subject.complexion;
  Paint paint;
  paint.label = p.y() > 139 || (p.z() > -10 && p.y() > 112) ? Label::kNeck : Label::kSkin;
  paint.colour = c.skin;
  // Mottling from palms' breadth down to pores.
  const double wide = Noise(0.03 * p, subject.seed + 11);
  const double middle = FractalNoise(0.16 * p, 2, subject.seed + 12);
  const double fine = Noise(0.9 * p, subject.seed + 13);
  paint.colour *= 1 + (0.02 + 0.03 * c.age) * middle + 0.02 * wide + 0.022 * fine;
  paint.height_mm = 0.035 * fine + 0.05 * c.age * middle;
  paint.gloss = 0.045 + 0.012 * wide;
  if (p.z() > 0) return paint;

  // Blood under the skin: cheeks, nose, chin, corners of the eyes; scaled by the skin's lightness.
  const double light = std::clamp(c.skin.mean() / 0.65, 0.25, 1.1);
  const double red = Spot(p, 38, 56, 19, 17) * (0.8 + 0.5 * middle) +
                     0.55 * Spot(p, 0, 58, 13, 13) + 0.45 * Spot(p, 0, 122, 16, 10) +
                     0.5 * Spot(p, 16, 24, 6, 7) + 0.3 * Spot(p, 13, 66, 8, 8);
  const double amount = 0.085 * c.redness * light * std::min(red, 1.2);
  paint.colour =
      paint.colour.cwiseProduct(Srgb(1 + 0.12 * amount, 1 - 1.05 * amount, 1 - 0.95 * amount));
  // Yellower forehead, shade under the eyes and round the sockets.
  const double forehead = SmoothStep(0, -25, p.y());
  paint.colour = paint.colour.cwiseProduct(Srgb(1, 1 + 0.015 * forehead, 1 - 0.02 * forehead));
  const double tired = (0.55 + 0.5 * c.age) * Spot(p, 26, 33, 13, 4.5) +
                       0.5 * Spot(p, 15, 22, 5, 9) + 0.45 * Spot(p, 31, 14, 16, 5);
  paint.colour =
      paint.colour.cwiseProduct(Srgb(1 - 0.14 * tired, 1 - 0.20 * tired, 1 - 0.17 * tired));
  // Shine on nose, forehead and cheekbones.
  paint.gloss += 0.05 * Spot(p, 0, 54, 9, 16) + 0.035 * Spot(p, 0, -28, 40, 18) +
                 0.025 * Spot(p, 42, 38, 14, 10);
  if (c.freckles > 0) {
    const CellDistances cell =
        CellNoise(25 * std::atan2(p.x(), -p.z()), 0.28 * p.y(), subject.seed + 14);
    const double size = 0.10 + 0.14 * (cell.nearest_hash % 97) / 97.0;
    const double where = Spot(p, 24, 46, 30, 24) + 0.22;
    const double dot = SmoothStep(size + 0.10, size, cell.nearest) * where * c.freckles * 0.42;
    paint.colour = paint.colour.cwiseProduct(Srgb(1 - 0.6 * dot, 1 - 0.9 * dot, 1 - dot));
  }
  PaintWrinkles(subject, p, &paint);
  return paint;
}

}  // namespace visavis
