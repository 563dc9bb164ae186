#pragma once

#include "common/mesh/label.h"
#include "services/simulator/colour.h"
#include "services/simulator/subject.h"

namespace visavis {

/// What a point of a surface looks like.
struct Paint {
  Srgb colour{0.5, 0.5, 0.5};
  double gloss{0};      ///< strength of the specular reflection, 0 to 1
  double height_mm{0};  ///< relief finer than the mesh, outward
  Label label{Label::kBackground};

  /// Lays @p colour over with opacity @p alpha in [0, 1].
  void Blend(const Srgb& over, double alpha) { colour = MixColour(colour, over, alpha); }
};

/// Skin of face, head and neck with eyes, brows, lips and nostrils at @p p, average coordinates
/// [mm] of SkinSurface.
Paint PaintSkin(const Subject& subject, const Eigen::Vector3d& p);

/// Lays brows, eyes, lips and nostrils over the skin's @p paint at @p p.
void PaintFeatures(const Subject& subject, const Eigen::Vector3d& p, Paint* paint);

/// Whether PaintHair leaves nothing to be seen of what it is laid over.
bool IsCoveredByHair(const Subject& subject, const Eigen::Vector3d& p);

/// Lays hair, beard or cap over @p paint at @p p. (u, v) as in HeadGrid: strands run along v.
void PaintHair(const Subject& subject, const Eigen::Vector3d& p, double u, double v, Paint* paint);

/// Colour and relief of hair alone; @p across and @p along strands in mm.
Paint PaintStrands(const Subject& subject, double across_mm, double along_mm);

}  // namespace visavis
