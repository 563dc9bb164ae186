#pragma once

#include <string>
#include <vector>

#include "common/geometry/rigid_transform.h"

namespace visavis {

struct HandEyeStart {
  RigidTransform X_HC, X_BT;
  std::string method;
};

/// The best of OpenCV's closed forms for X_BH X_HC X_CT = X_BT: that with the least scatter of the
/// board's place. @throws std::invalid_argument where the hands are not turned about two axes.
HandEyeStart StartHandEye(const std::vector<RigidTransform>& X_BH,
                          const std::vector<RigidTransform>& X_CT);

}  // namespace visavis
