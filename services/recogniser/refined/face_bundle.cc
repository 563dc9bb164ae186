#include "services/recogniser/refined/face_bundle.h"

#include <algorithm>
#include <cmath>

namespace visavis {
namespace {

constexpr double kWidely_rad = 0.35;  ///< between two of the views

bool IsSeenWidely(const HeadBundle& bundle) {
  double least = 1;  // cosine
  for (std::size_t i = 0; i < bundle.num_views(); ++i) {
    for (std::size_t k = 0; k < i; ++k)
      least = std::min(least, TowardsCamera(bundle.pose(i)).dot(TowardsCamera(bundle.pose(k))));
  }
  return least < std::cos(kWidely_rad);
}

}  // namespace

FaceBundle BundleFace(const FaceFrame& finder, int turns, int rounds, HeadBundle* bundle) {
  FaceBundle result;
  for (int turn = 0; turn < turns; ++turn) {
    if (IsSeenWidely(*bundle)) bundle->Rebase();  // then nearness to the mean adult counts no more
    for (int round = 0; round < rounds; ++round) {
      result.last = bundle->Round();
      if (turn == 0 && round == 0) result.first = result.last;
    }
    const HeadGeometry head = bundle->Enrolled();
    // A measured head keeps its frame: asked is only how like a face it is about there.
    const FaceFrame::Found found = turn == 0 && !head.is_measured
                                       ? finder.Find(*head.face, head.surface)
                                       : finder.FindNear(*head.face, head.surface);
    if (!head.is_measured) bundle->MoveFrame(found.X_MN);
    result.likeness = found.likeness;
  }
  return result;
}

}  // namespace visavis
