#include "services/simulator/head_shape.h"

#include <algorithm>
#include <cmath>

#include "common/core/check.h"
#include "services/simulator/procedural_noise.h"

namespace visavis {
namespace {

using Eigen::Vector3d;

// The average head: semi-axes of the cranium, and where its landmarks lie.
constexpr double kCraniumX = 76, kCraniumY = 93, kCraniumZ = 97.5;
constexpr double kAverageBreadth = 156, kAverageLength = 199;  // with what joins the cranium
constexpr double kMenton = 135, kUnderChin = 138.5, kSellion = 19, kSubnasale = 70;

double Square(double x) { return x * x; }

/// Gaussian bump of height 1 at @p centre and, mirrored, at -x; @p radius per axis.
double Mirrored(const Vector3d& p, const Vector3d& centre, const Vector3d& radius) {
  const Vector3d q(std::abs(p.x()), p.y(), p.z());
  return Bump((q - centre).cwiseQuotient(radius));
}

/// Distance to the superellipse of exponent @p n with half axes @p a, @p b, scaled to mm.
double Superellipse(double x, double z, double a, double b, double n) {
  const double g = std::pow(std::pow(std::abs(x) / a, n) + std::pow(std::abs(z) / b, n), 1 / n);
  return (g - 1) * std::min(a, b);
}

/// Distance to a capsule from @p a (radius @p ra) to @p b (radius @p rb).
double Capsule(const Vector3d& p, const Vector3d& a, const Vector3d& b, double ra, double rb) {
  const Vector3d ab = b - a;
  const double t = std::clamp((p - a).dot(ab) / ab.squaredNorm(), 0.0, 1.0);
  return (p - a - t * ab).norm() - (ra + t * (rb - ra));
}

}  // namespace

double SmoothMin(double a, double b, double k) {
  const double h = std::max(k - std::abs(a - b), 0.0) / k;
  return std::min(a, b) - h * h * k * 0.25;
}

void HeadMeasures::ValidateOrThrow() const {
  VISAVIS_THROW_UNLESS(breadth_mm >= 120 && breadth_mm <= 180, breadth_mm);
  VISAVIS_THROW_UNLESS(length_mm >= 150 && length_mm <= 230, length_mm);
  VISAVIS_THROW_UNLESS(height_mm >= 180 && height_mm <= 270, height_mm);
  VISAVIS_THROW_UNLESS(bizygomatic_mm >= 110 && bizygomatic_mm <= 165, bizygomatic_mm);
  VISAVIS_THROW_UNLESS(bigonial_mm >= 80 && bigonial_mm <= 135, bigonial_mm);
  VISAVIS_THROW_UNLESS(interpupillary_mm >= 50 && interpupillary_mm <= 75, interpupillary_mm);
  VISAVIS_THROW_UNLESS(eye_opening_mm >= 4 && eye_opening_mm <= 14, eye_opening_mm);
  VISAVIS_THROW_UNLESS(nose_length_mm >= 38 && nose_length_mm <= 64, nose_length_mm);
  VISAVIS_THROW_UNLESS(nose_breadth_mm >= 26 && nose_breadth_mm <= 50, nose_breadth_mm);
  VISAVIS_THROW_UNLESS(nose_protrusion_mm >= 10 && nose_protrusion_mm <= 30, nose_protrusion_mm);
  VISAVIS_THROW_UNLESS(mouth_breadth_mm >= 38 && mouth_breadth_mm <= 65, mouth_breadth_mm);
  VISAVIS_THROW_UNLESS(lip_fullness >= 0.3 && lip_fullness <= 2, lip_fullness);
  VISAVIS_THROW_UNLESS(neck_breadth_mm >= 85 && neck_breadth_mm <= 140, neck_breadth_mm);
  VISAVIS_THROW_UNLESS(ear_length_mm >= 50 && ear_length_mm <= 80, ear_length_mm);
  VISAVIS_THROW_UNLESS(ear_flare_deg >= 5 && ear_flare_deg <= 50, ear_flare_deg);
}

SkinSurface::SkinSurface(const HeadMeasures& shape)
    : shape_(shape),
      // Along y: depth before the axis, half width, z of the widest place, depth behind it.
      face_front_{{-60, 45},   {-30, 80}, {-8, 90},   {4, 93},   {19, 88},
                  {45, 90},    {70, 95},  {84, 97.5}, {92, 96},  {108, 92},
                  {120, 93.5}, {128, 91}, {133, 84},  {137, 66}, {139, 40}},
      face_half_width_{{-60, 30}, {-30, 52},  {-5, 60},  {20, 66},    {42, 68.5},
                       {60, 66},  {78, 60.5}, {95, 54},  {108, 46.5}, {118, 39},
                       {126, 31}, {132, 23},  {136, 14}, {139, 4}},
      face_centre_{{-30, -15}, {30, -15}, {75, -12}, {95, -20}, {115, -40}, {130, -60}, {139, -66}},
      face_back_{{-60, 22}, {-30, 50}, {60, 50}, {90, 32}, {110, 30}, {128, 24}, {139, 10}},
      y_to_M_{{-120, 0}, {200, 1}} {
  shape.ValidateOrThrow();
  // Vertex, eyes and chin share out the height as on the average head; the nose has its own length.
  const double s = shape.height_mm / (kCraniumY + kMenton);
  const double subnasale = s * kSellion + shape.nose_length_mm;
  y_to_M_ = Profile({{-120.0, -120 * s},
                     {-kCraniumY, -kCraniumY * s},
                     {0.0, 0.0},
                     {kSellion, kSellion * s},
                     {kSubnasale, subnasale},
                     {92.0, 0.66 * subnasale + 0.34 * kMenton * s},
                     {kMenton, kMenton * s},
                     {250.0, kMenton * s + 115}});
}

Vector3d SkinSurface::cranium_semi_axes_mm() const {
  return {kCraniumX * shape_.breadth_mm / kAverageBreadth,
          kCraniumY * shape_.height_mm / (kCraniumY + kMenton),
          kCraniumZ * shape_.length_mm / kAverageLength};
}

Vector3d SkinSurface::ToM(const Vector3d& p) const {
  // Breadth of the cranium above, of the face and neck (already in average mm) below.
  const double cranial = shape_.breadth_mm / kAverageBreadth;
  const double facial = shape_.bizygomatic_mm / 137;
  const double face = SmoothStep(-40, 25, p.y()) * SmoothStep(35, -25, p.z());
  return {p.x() * (cranial + (facial - cranial) * face), y_to_M_(p.y()),
          p.z() * shape_.length_mm / kAverageLength};
}

double SkinSurface::Cranium(const Vector3d& p) const {
  // Widest above the ears, narrower at the forehead.
  const double half_width =
      kCraniumX * (1 - 0.17 * Square(std::clamp((18 - p.z()) / 112, 0.0, 1.0)));
  // Behind the face the skull recedes, so that eyes and root of the nose lie deep.
  const double depth = kCraniumZ - (p.z() < 0 ? 10 * SmoothStep(-12, 26, p.y()) : 0);
  const double n = 2.2;
  const double g =
      std::pow(std::pow(std::abs(p.x()) / half_width, n) +
                   std::pow(std::abs(p.y()) / kCraniumY, n) + std::pow(std::abs(p.z()) / depth, n),
               1 / n);
  return (g - 1) * kCraniumX;
}

double SkinSurface::Face(const Vector3d& p) const {
  if (p.y() < -60) return 40;  // well inside the cranium
  const double jaw =
      SmoothStep(55, 95, p.y()) * (shape_.bigonial_mm / 107 * 137 / shape_.bizygomatic_mm - 1);
  const double half_width = face_half_width_(p.y()) * (1 + jaw);
  const double centre = face_centre_(p.y());
  const double front = face_front_(p.y()) + shape_.chin_mm * SmoothStep(98, 120, p.y()) + centre;
  const double depth = p.z() < centre ? front : face_back_(p.y());
  const double n = p.z() < centre ? 2.0 + 0.25 * SmoothStep(95, 125, p.y()) : 2.3;
  const double round = Superellipse(p.x(), p.z() - centre, half_width, std::max(depth, 2.0), n);
  return std::max(round, p.y() - kUnderChin);
}

double SkinSurface::Neck(const Vector3d& p) const {
  const double half = shape_.neck_breadth_mm / 2 * 137 / shape_.bizygomatic_mm;
  // Leans forward; widens into the shoulders.
  const double flare = 1 + 0.35 * SmoothStep(165, 235, p.y());
  const double centre = 22 + 0.16 * (p.y() - 110);
  double d = Superellipse(p.x(), p.z() - centre, half * flare, (half + 3) * flare, 2.1);
  // Larynx and the two muscles from behind the ears to the collarbones.
  d -= 2.0 * Mirrored(p, {0, 158, -34}, {9, 14, 14});
  const double t = std::clamp((p.y() - 90) / 120, 0.0, 1.0);
  const Vector3d muscle(48 - 34 * t, p.y(), 20 - 42 * t);
  d -= 2.0 * Mirrored(p, muscle, {10, 1e3, 16});
  return std::max(d, 60 - p.y());
}

double SkinSurface::Nose(const Vector3d& p) const {
  const double wing = shape_.nose_breadth_mm / 35 * 137 / shape_.bizygomatic_mm;
  const double tip = shape_.nose_protrusion_mm - 20, bridge = shape_.nose_bridge_mm;
  const double base = -95;  // face at subnasale
  double d = Capsule(p, {0, 14, base + 12 - 0.5 * bridge}, {0, 38, base - 4 - bridge}, 7.5, 8.0);
  d = SmoothMin(d, Capsule(p, {0, 38, base - 4 - bridge}, {0, 57, base - 13 - tip}, 8.0, 9.6), 4);
  const Vector3d q(std::abs(p.x()), p.y(), p.z());
  const double alae = (q - Vector3d(11.2 * wing, 62.5, base - 5.5 - 0.4 * tip)).norm() - 6.6;
  d = SmoothMin(d, alae, 5.5);
  // Columella, down to the upper lip.
  return SmoothMin(d, Capsule(p, {0, 64, base - 13 - tip}, {0, 69, base - 1}, 4.2, 4.0), 5);
}

double SkinSurface::Relief(const Vector3d& p) const {
  if (p.z() > 0) return 0;
  // Positive carves, negative builds up [mm].
  const double lips = shape_.lip_fullness, mouth = shape_.mouth_breadth_mm / 51;
  double d = 0;
  d += 3.2 * Mirrored(p, {31, 16, -85}, {17, 9, 30});    // orbits
  d += 5.5 * Mirrored(p, {14.5, 19, -92}, {7, 10, 20});  // beside the root of the nose
  d += 2.5 * Mirrored(p, {31, 34, -85}, {16, 5, 30});    // under the lower lid
  d += 2.5 * Mirrored(p, {60, -8, -55}, {18, 26, 30});   // temples
  d -= shape_.brow_ridge_mm * Mirrored(p, {22, 4, -95}, {20, 7, 18});
  d -= 3.0 * Mirrored(p, {45, 43, -72}, {16, 12, 22});  // cheekbones
  d -= (shape_.cheek_mm - 2.0) * Mirrored(p, {42, 80, -66}, {18, 20, 26});
  d += 1.3 * Mirrored(p, {21 + 0.4 * (p.y() - 66), 80, -92}, {3.5, 17, 18});  // nasolabial
  d += 1.2 * Mirrored(p, {0, 77, -98}, {3.2, 6, 10});                         // philtrum
  d -= 2.4 * lips * Mirrored(p, {6 * mouth, 86.5, -98}, {15 * mouth, 4.2, 12});
  d -= 3.2 * lips * Mirrored(p, {0, 98.0, -98}, {17 * mouth, 5.0, 12});
  d += 2.6 * Mirrored(p, {0, 91.6, -98}, {24 * mouth, 2.0, 18});  // between the lips
  d += 2.0 * Mirrored(p, {27 * mouth, 92, -88}, {4, 4, 12});      // corners of the mouth
  d += 2.6 * Mirrored(p, {0, 108.5, -96}, {17, 4.5, 14});         // above the chin
  d -= 3.2 * Mirrored(p, {0, 121, -94}, {13, 9, 14});
  return d;
}

double SkinSurface::Distance(const Vector3d& p) const {
  const double skull = SmoothMin(Cranium(p), Face(p), 22);
  double d = SmoothMin(skull, Neck(p), 14);
  if (p.z() < 0) {
    d += Relief(p);
    // Lids over the eyeball.
    const Vector3d q(std::abs(p.x()), p.y(), p.z());
    const double x = 31 * shape_.interpupillary_mm / 62 * 137 / shape_.bizygomatic_mm;
    d = SmoothMin(d, (q - Vector3d(x, 22, -71.5)).norm() - 13.2, 4);
    d = SmoothMin(d, Nose(p), 6);
  }
  return d;
}

Vector3d SkinSurface::Outermost(const Vector3d& origin, const Vector3d& direction) const {
  double outside = 185, inside = 0;
  while (outside > 1) {
    const double d = Distance(origin + outside * direction);
    if (d <= 0) {
      inside = outside;
      outside += 4.0;
      break;
    }
    outside -= std::clamp(0.5 * d, 0.6, 4.0);
  }
  for (int i = 0; i < 22; ++i) {
    const double middle = 0.5 * (inside + outside);
    (Distance(origin + middle * direction) <= 0 ? inside : outside) = middle;
  }
  return origin + inside * direction;
}

}  // namespace visavis
