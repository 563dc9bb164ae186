#pragma once

#include <string>

#include "common/rigs/rig_description.h"
#include "tests/support/board_scene.h"

namespace visavis {

/// A gantry that carries a wrist: x, y, z [m], then turns about z, y, x [rad]; six joints whose
/// values follow from the hand's pose by hand.
ArmDescription GantryArm();

/// Joints of the gantry whose hand is at @p X_BH: x y z Phi theta psi.
std::vector<double> GantryJoints(const RigidTransform& X_BH);

/// Writes a log of rendered pictures: the arm goes from view to view and rests there for a pair; in
/// every third it is also seen just before, moving (blurred). ARM_STATE at 100 Hz.
void WriteBoardLog(const BoardScene& scene, const std::string& path);

/// Time between two views [us]; the first one's pictures at rest come at kFirstViewUs.
inline constexpr std::int64_t kViewPeriodUs = 1'000'000, kFirstViewUs = 1'000'500'000;

}  // namespace visavis
