#pragma once

#include <vector>

#include "services/recogniser/refined/pose_equations.h"

namespace visavis {

/// Where the head's frame lies on a learned face. Texture tells how the head moves, to a fraction
/// of a millimetre, but keeps for ever the error of the pose it was learned at; what the generic
/// model says is not as fine, but right in the mean over many views. So the views' generic
/// equations are bundled, each direction of view once, and the frame is moved to where they agree
/// best.
class HeadAnchor {
 public:
  HeadAnchor();

  void Forget();
  /// Takes in what one frame's generic model says (PoseRefiner::Generic) under a pose whose view
  /// direction in M is @p direction (unit).
  void Add(const Eigen::Vector3d& direction, const PoseEquations& generic);
  /// The correction X_MN of the frame, after Add(); a small one. Tells the bundle that it is done.
  RigidTransform Correct();
  int views() const { return static_cast<int>(views_.size()); }

 private:
  struct View {
    Eigen::Vector3d direction;
    PoseEquations mean;
    int count;
  };
  std::vector<View> views_;
};

}  // namespace visavis
