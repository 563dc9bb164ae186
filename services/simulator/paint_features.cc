#include <algorithm>
#include <cmath>

#include "services/simulator/paint.h"
#include "services/simulator/procedural_noise.h"
#include "services/simulator/profile.h"

namespace visavis {
namespace {

using Eigen::Vector3d;

double Hash01(std::uint32_t h) { return static_cast<double>(h & 0xffff) / 65535.0; }

/// Strands of a brow: bent over to the outside, each drawn as a thin streak.
void PaintBrow(const Subject& subject, const Vector3d& p, Paint* paint) {
  static const Profile line{{10, 9.5}, {20, 7.0}, {34, 4.4}, {42, 4.6}, {54, 10.5}};
  static const Profile half_height{{10, 2.2}, {14, 3.7}, {24, 3.7}, {38, 2.8}, {54, 0.7}};
  const Complexion& c = subject.complexion;
  const double x = std::abs(p.x()) * 31 / (31 * subject.shape.interpupillary_mm / 62);
  if (c.brow_density <= 0 || x < 9 || x > 56) return;
  const double y = p.y() + c.brow_height_mm - line(x);
  const double across = y / half_height(x);
  const double ends = SmoothStep(9.5, 14, x) * SmoothStep(55.5, 49, x);
  const double body = SmoothStep(1.35, 0.45, std::abs(across)) * ends;
  if (body <= 0) return;
  // Inner hairs stand up, outer ones lie along the brow.
  const double slope = x < 18 ? -1.1 : -0.35;
  const Vector3d q(0.34 * x + (p.x() > 0 ? 0 : 50), 1.15 * (y - slope * x), 0);
  const double strands = 0.62 + 0.55 * FractalNoise(q, 2, subject.seed + 31);
  const double alpha = std::clamp(body * (0.35 + strands) * c.brow_density, 0.0, 1.0);
  paint->Blend(c.brow, 0.9 * alpha);
  paint->height_mm += 0.5 * body * c.brow_density * strands;
  if (alpha > 0.5) paint->label = Label::kBrow;
}

struct EyeFrame {
  double x, y;            ///< from the eye's centre [mm], x to the outer corner
  double upper, lower;    ///< lids' y at that x; equal outside the corners
  double inside_corners;  ///< 1 - |x| / half width
};

EyeFrame LocateInEye(const Subject& subject, const Vector3d& p) {
  const HeadMeasures& s = subject.shape;
  constexpr double kHalfWidth = 15.2;
  EyeFrame eye;
  eye.x = std::abs(p.x()) - 31 * s.interpupillary_mm / 62 * 137 / s.bizygomatic_mm;
  eye.y = p.y() - 22;
  const double t = eye.x / kHalfWidth;
  eye.inside_corners = 1 - std::abs(t);
  const double open = std::max(1 - t * t, 0.0);
  const double tilt = -0.5 * s.canthal_tilt_mm * t;
  // The upper lid's highest point lies inward of the middle, the lower's lowest outward.
  eye.upper = tilt - 0.52 * s.eye_opening_mm * std::pow(open, 0.72) * (1 - 0.10 * t);
  eye.lower = tilt + 0.46 * s.eye_opening_mm * std::pow(open, 0.85) * (1 + 0.15 * t);
  return eye;
}

void PaintEyeball(const Subject& subject, const EyeFrame& eye, Paint* paint) {
  const Complexion& c = subject.complexion;
  const double r = std::hypot(eye.x, eye.y + 0.5);
  paint->label = Label::kEye;
  paint->gloss = 0.5;
  paint->colour = Srgb(0.80, 0.76, 0.73);
  // Redder towards the corners, the caruncle at the inner one.
  paint->Blend(Srgb(0.72, 0.52, 0.47), 0.5 * SmoothStep(8, 15, std::abs(eye.x)));
  paint->Blend(Srgb(0.66, 0.40, 0.37), SmoothStep(-12.2, -13.8, eye.x));
  if (r < 6.4) {
    const double angle = std::atan2(eye.y + 0.5, eye.x);
    const double rays =
        Noise({6 * std::cos(angle), 6 * std::sin(angle), 0.25 * r}, subject.seed + 33);
    Srgb iris = c.iris * (1 + 0.25 * rays + 0.25 * SmoothStep(2, 5, r));
    iris = MixColour(iris, 0.35 * c.iris, SmoothStep(4.7, 5.9, r));
    paint->Blend(iris, SmoothStep(6.2, 5.6, r));
    paint->Blend(Srgb(0.02, 0.02, 0.02), SmoothStep(2.5, 1.9, r));
  }
  // The upper lid and its lashes shade the eyeball.
  paint->colour *= 1 - 0.55 * SmoothStep(3.6, 0.2, eye.y - eye.upper) -
                   0.12 * SmoothStep(1.2, 0.0, eye.lower - eye.y);
}

void PaintEye(const Subject& subject, const Vector3d& p, Paint* paint) {
  const EyeFrame eye = LocateInEye(subject, p);
  if (std::abs(eye.x) > 23 || std::abs(eye.y) > 17) return;
  const double above = eye.upper - eye.y, below = eye.y - eye.lower;
  const double near_corner = SmoothStep(-0.22, 0.04, eye.inside_corners);
  if (above < 0 && below < 0 && eye.inside_corners > 0) {
    PaintEyeball(subject, eye, paint);
    // The eyeball lies behind the lids' edges; the cornea bulges.
    const double r = std::hypot(eye.x, eye.y + 0.5);
    paint->height_mm =
        -1.1 * SmoothStep(0, 1.2, std::min(-above, -below)) + 1.3 * std::max(1 - r * r / 42, 0.0);
    return;
  }
  // Fold above the upper lid, and the lid's own sheen.
  const double fold_at = 3.4 + 1.2 * std::max(eye.inside_corners, 0.0);
  const double fold =
      std::exp(-std::pow((above - fold_at) / 0.75, 2)) * near_corner * subject.shape.lid_fold;
  paint->colour *= 1 - 0.34 * fold;
  paint->height_mm -= 0.7 * fold;
  // Lash line, drawn out beyond the outer corner; finer below.
  const double thick =
      (0.55 + 0.35 * subject.complexion.lashes + 0.4 * SmoothStep(-5, 12, eye.x)) *
      (0.85 + 0.3 * Noise({1.4 * eye.x, 0, p.x() > 0 ? 0.0 : 9.0}, subject.seed + 34));
  const double lash =
      above >= -0.2 && eye.x < 17.5 ? SmoothStep(thick + 0.5, thick - 0.3, above) * near_corner : 0;
  if (lash > 0 && below < 2) {
    paint->Blend(0.55 * subject.complexion.brow, 0.88 * lash);
    if (lash > 0.5) paint->label = Label::kLash;
  }
  const double lower = below >= 0 ? SmoothStep(1.5, 0.3, below) * near_corner : 0;
  paint->Blend(
      Srgb(0.52, 0.33, 0.29).cwiseProduct(0.4 * Srgb::Ones() + 0.75 * subject.complexion.skin),
      0.5 * lower);
}

void PaintLips(const Subject& subject, const Vector3d& p, Paint* paint) {
  const double mouth = subject.shape.mouth_breadth_mm / 51 * 137 / subject.shape.bizygomatic_mm;
  const double x = std::abs(p.x()) / mouth, full = subject.shape.lip_fullness;
  if (x > 29 || p.y() < 78 || p.y() > 110) return;
  static const Profile bow{{0, 6.0}, {5.5, 7.6}, {14, 5.0}, {25, 0.3}, {27, 0}};
  static const Profile lower_edge{{0, 9.2}, {8, 9.0}, {17, 6.0}, {25, 0.3}, {27, 0}};
  const double line = 91.8 + 0.6 * std::cos(0.25 * x) - 0.02 * x;
  const double up = line - p.y();
  const double scaled = 0.35 + 0.65 * full;
  const double upper_inside = bow(x) * scaled - up, lower_inside = lower_edge(x) * scaled + up;
  const double inside = up > 0 ? upper_inside : lower_inside;
  const double alpha = SmoothStep(-0.6, 1.0, inside) * SmoothStep(27, 24, x);
  if (alpha > 0) {
    const double ridges = Noise({0.9 * p.x(), 0.12 * p.y(), 0}, subject.seed + 36);
    Srgb lips = subject.complexion.lips * (1 + 0.09 * ridges);
    if (up > 0) lips *= 0.86;
    paint->Blend(lips, 0.85 * alpha);
    paint->gloss += (up > 0 ? 0.03 : 0.10) * alpha;
    paint->height_mm += 0.25 * alpha + 0.08 * ridges * alpha;
    if (alpha > 0.5) paint->label = Label::kLips;
  }
  const double gap = std::exp(-std::pow(up / 0.75, 2)) * SmoothStep(28, 25, x);
  paint->Blend(0.28 * subject.complexion.lips, 0.85 * gap);
  paint->height_mm -= 0.7 * gap;
}

void PaintNostril(const Subject& subject, const Vector3d& p, Paint* paint) {
  const double x = std::abs(p.x());
  if (p.y() < 58 || p.y() > 74 || p.z() > -90 || x > 20) return;
  const double wing = subject.shape.nose_breadth_mm / 35 * 137 / subject.shape.bizygomatic_mm;
  const double tip = subject.shape.nose_protrusion_mm - 20;
  const double a = (x - 6.8 * wing) / (3.0 * wing), b = (p.z() + 103.0 + 0.6 * tip) / 4.6;
  const double underside = SmoothStep(63.0, 65.0, p.y() + 0.12 * (p.z() + 103));
  const double hole = SmoothStep(1.35, 0.6, std::hypot(a, b)) * underside;
  paint->Blend(
      Srgb(0.13, 0.06, 0.05).cwiseProduct(0.5 * Srgb::Ones() + 0.6 * subject.complexion.skin),
      hole);
  paint->gloss *= 1 - hole;
  if (hole > 0.5) paint->label = Label::kNostril;
  // Groove round the wing.
  const double wing_r = (p - Vector3d(p.x() > 0 ? 11.2 * wing : -11.2 * wing, 62.5, -100.5)).norm();
  const double groove =
      std::exp(-std::pow((wing_r - 8.2) / 1.3, 2)) * SmoothStep(13 * wing, 16 * wing, x);
  paint->colour *= 1 - 0.22 * groove;
}

}  // namespace

void PaintFeatures(const Subject& subject, const Vector3d& p, Paint* paint) {
  if (p.z() > -40) return;
  if (p.y() > -15 && p.y() < 25) PaintBrow(subject, p, paint);
  if (p.y() > 0 && p.y() < 42) PaintEye(subject, p, paint);
  PaintLips(subject, p, paint);
  PaintNostril(subject, p, paint);
  // A few moles.
  const CellDistances cell = CellNoise(p.x() / 30, p.y() / 30, subject.seed + 38);
  if (Hash01(cell.nearest_hash) < 0.12 && cell.nearest * 30 < 0.9 && paint->label == Label::kSkin) {
    paint->Blend(0.45 * subject.complexion.skin, 0.7);
  }
}

}  // namespace visavis
