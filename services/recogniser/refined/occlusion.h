#pragma once

#include <array>

#include "services/recogniser/refined/face_texture.h"

namespace visavis {

/// Finds parts of the face, some 3 cm wide, that show something else than @p texture has there: a
/// hand, a cup. Their points are no longer seen in the @p samples of the eyes (null: an eye that
/// sees nothing). An eye that sees nothing for certain is judged by the light that the other sees.
/// Where most of what both see would go, it is the pose that is wrong, or the face, and nothing is
/// changed. @return the share of the points seen before that was hidden.
double HideOccluded(const FaceTexture& texture, Band band,
                    const std::array<FaceSamples*, 2>& samples);

/// Of the parts of a face of which some are hidden, keeps those that show beyond doubt what
/// @p texture has there: the rest, at the edge of what hides it or plain, may mislead.
void KeepCertain(const FaceTexture& texture, Band band, const std::array<FaceSamples*, 2>& samples);

}  // namespace visavis
