#pragma once

#include "services/recogniser/refined/face_texture.h"

namespace visavis {

/// Finds parts of the face, some 3 cm wide, that show something else than @p texture has there: a
/// hand, a cup. Their points are no longer seen in @p samples. Where most of what is seen
/// would go, it is the pose that is wrong, or the face, and nothing is changed. @return the share
/// of the points seen before that was hidden.
double HideOccluded(const FaceTexture& texture, Band band, FaceSamples* samples);

}  // namespace visavis
