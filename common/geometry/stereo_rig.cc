#include "common/geometry/stereo_rig.h"

#include <stdexcept>

#include "common/core/check.h"

namespace visavis {

void StereoRig::ValidateOrThrow() const {
  const auto camera = [](const char* name, const Pinhole& pinhole) {
    try {
      pinhole.ValidateOrThrow();
    } catch (const std::invalid_argument& e) {
      throw std::invalid_argument(std::string(name) + ": " + e.what());
    }
  };
  camera("right", right);
  camera("left", left);
  VISAVIS_THROW_UNLESS(X_CL.matrix().allFinite(), X_CL.matrix());
  // Metres; a baseline in millimetres would be 1000 times that.
  VISAVIS_THROW_UNLESS(baseline_m() >= 0.005 && baseline_m() <= 2.0, baseline_m());
}

Projection ProjectRight(const StereoRig& rig, const RigidTransform& X_CM,
                        const Eigen::Vector3d& p_M) {
  return Project(rig.right, X_CM * p_M);
}

Projection ProjectLeft(const StereoRig& rig, const RigidTransform& X_CM,
                       const Eigen::Vector3d& p_M) {
  return Project(rig.left, rig.X_CL.inverse() * (X_CM * p_M));
}

}  // namespace visavis
