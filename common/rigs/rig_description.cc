#include "common/rigs/rig_description.h"

#include "common/core/check.h"

namespace visavis {

void RigDescription::ValidateOrThrow() const {
  rig.ValidateOrThrow();
  if (X_HC) {
    const double hand_eye_m = X_HC->translation().norm();
    VISAVIS_THROW_UNLESS(hand_eye_m <= 3.0, hand_eye_m);  // a value in millimetres is above that
  }
  if (!arm) return;
  VISAVIS_THROW_UNLESS(!arm->urdf.empty(), arm->urdf);
  VISAVIS_THROW_UNLESS(!arm->base_link.empty(), arm->base_link);
  VISAVIS_THROW_UNLESS(!arm->tip_link.empty() && arm->tip_link != arm->base_link, arm->tip_link);
}

}  // namespace visavis
