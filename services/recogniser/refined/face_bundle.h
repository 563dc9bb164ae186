#pragma once

#include "services/recogniser/refined/face_frame.h"
#include "services/recogniser/refined/head_bundle.h"

namespace visavis {

/// How a bundle of a head's views went.
struct FaceBundle {
  HeadBundle::Agreement first, last;  ///< of the first round and of the last
  double likeness{0};                 ///< of the face, as LooksFit's
};

/// @p turns of @p rounds of @p bundle each; after each the head's frame goes where the face says
/// that it is (FaceFrame), but for a measured head. Once views are 20 deg apart, the shape that a
/// turn begins with is its prior, not the one that the bundle began with.
FaceBundle BundleFace(const FaceFrame& finder, int turns, int rounds, HeadBundle* bundle);

}  // namespace visavis
