#include <algorithm>
#include <cmath>

#include "services/simulator/head_grid.h"
#include "services/simulator/paint.h"
#include "services/simulator/procedural_noise.h"

namespace visavis {
namespace {

using Eigen::Vector3d;

Paint PaintKnit(const Subject& subject, const Vector3d& p, double u, double v) {
  // Ribs along v; stitches across.
  const double rib = std::cos(2 * M_PI * 90 * u),
               stitch = std::cos(2 * M_PI * (170 * v + 0.5 * (rib > 0)));
  Paint paint;
  paint.label = Label::kHair;
  paint.colour = subject.hair.colour *
                 (0.86 + 0.12 * rib + 0.05 * stitch + 0.05 * FractalNoise(0.3 * p, 2, 77));
  paint.height_mm = 0.5 * rib + 0.15 * stitch;
  return paint;
}

}  // namespace

Paint PaintStrands(const Subject& subject, double across_mm, double along_mm) {
  const HairStyle& hair = subject.hair;
  const double curl = hair.curl;
  // Curls bend the strands by a noise of a few millimetres.
  const Vector3d q(0.12 * across_mm, 0.12 * along_mm, 3);
  const double bend = (1.0 + 9.0 * curl) * FractalNoise(0.6 * q, 2, subject.seed + 41);
  const double a = across_mm + bend, l = along_mm * (0.07 + 0.35 * curl);
  const double lock = Noise({0.16 * a, 0.6 * l, 1}, subject.seed + 42);
  const double strand = Noise({0.75 * a, l, 2}, subject.seed + 43);
  const double fine = Noise({2.2 * a, 1.3 * l, 3}, subject.seed + 44);
  Paint paint;
  paint.label = Label::kHair;
  double shade = 0.80 + 0.24 * lock + 0.26 * strand + 0.20 * fine;
  if (curl > 0.5) {
    const CellDistances cell = CellNoise(0.42 * a, 0.42 * along_mm, subject.seed + 45);
    shade *= 0.55 + 0.75 * SmoothStep(0.75, 0.1, cell.nearest);
  }
  paint.colour = hair.colour * std::max(shade, 0.15);
  const double grey_strand = SmoothStep(0.75 - 1.5 * hair.grey, 1.05 - 1.5 * hair.grey,
                                        0.5 * (fine + strand) + 0.4 * lock);
  paint.Blend(Srgb(0.68, 0.67, 0.66) * (0.75 + 0.3 * strand),
              grey_strand * std::min(1.0, 2.5 * hair.grey));
  paint.gloss = (0.16 + 0.10 * strand + 0.08 * fine) * (1 - 0.8 * curl);
  paint.height_mm = 0.9 * lock + 0.55 * strand + 0.16 * fine;
  return paint;
}

bool IsCoveredByHair(const Subject& subject, const Vector3d& p) {
  const bool beanie = subject.hair.kind == HairStyle::Kind::kBeanie;
  // The ragged edge reaches in by less than four times its amplitude.
  return InsideHairline(subject, p, false) > (beanie ? 0 : 12 + 4 * subject.hair.raggedness_mm);
}

void PaintHair(const Subject& subject, const Vector3d& p, double u, double v, Paint* paint) {
  const HairStyle& hair = subject.hair;
  const double inside = InsideHairline(subject, p, hair.kind != HairStyle::Kind::kBeanie);
  // Strands fan out from the crown: across is measured round the head.
  const double azimuth = std::atan2(p.x(), -p.z());
  const double across =
      85 * azimuth + hair.parting * 0.9 * (p.y() + 90) + 25 * Noise(0.012 * p, subject.seed + 46);
  const double along = p.y() + 0.4 * p.z();
  if (hair.kind == HairStyle::Kind::kBeanie) {
    if (inside > 0) *paint = PaintKnit(subject, p, u, v);
    return;
  }
  if (inside > -6) {
    const Paint strands = PaintStrands(subject, across, along);
    // Thin at the edge, where skin shines through between strands.
    const double edge = inside / 7 + 0.35 * strands.height_mm;
    const double alpha = SmoothStep(-0.35, 0.75, edge);
    paint->Blend(strands.colour, alpha);
    paint->gloss += (strands.gloss - paint->gloss) * alpha;
    paint->height_mm += alpha * strands.height_mm;
    if (alpha > 0.5) paint->label = Label::kHair;
  }
  const double beard = InsideBeard(subject, p);
  if (beard > -3 && paint->label != Label::kHair) {
    Paint strands = PaintStrands(subject, 95 * azimuth + 200, 0.6 * p.y());
    if (hair.beard <= 0.5) {  // stubble: dots, no strands
      strands.height_mm = 0.8 * Noise(1.1 * p, subject.seed + 47);
      strands.colour = hair.colour;
    }
    const double dense = SmoothStep(-3, 7, beard) * hair.beard;
    const double alpha = std::clamp(dense * (0.9 + 0.5 * strands.height_mm), 0.0, 1.0);
    paint->Blend(strands.colour, hair.beard > 0.5 ? alpha : 0.5 * alpha);
    paint->gloss *= 1 - 0.7 * alpha;
    if (hair.beard > 0.5) {
      paint->height_mm += 0.7 * alpha * strands.height_mm;
      if (alpha > 0.6 && paint->label == Label::kSkin) paint->label = Label::kHair;
    }
  }
}

}  // namespace visavis
