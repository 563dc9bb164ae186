#pragma once

#include <string>
#include <vector>

#include "common/geometry/rigid_transform.h"

namespace visavis {

/// The constant transform between the head frame T of the truth and M of the recogniser's model:
/// where a head's origin lies is a matter of definition.
struct HeadOffset {
  RigidTransform X_TM{RigidTransform::Identity()};  ///< pose of M in T
  std::string source;  ///< where it comes from: a file, or the log it was fitted on
  int num_frames{0};   ///< that it was fitted on
  double rms_m{0};     ///< of the frames that the fit counted as good
  double rms_rad{0};
};

/// A pair that tells of the offset.
struct TruthAndEstimate {
  RigidTransform X_CT;  ///< truth
  RigidTransform X_CM;  ///< estimate
};

/// Robust least squares: X_TM minimises the sum over the pairs of Tukey's biweight of
/// |p_TM,i - p_TM| and of the angle between R_TM,i and R_TM, where X_TM,i = X_CT,i^-1 X_CM,i.
/// The scales follow from the median residuals, so that up to half of the pairs may be wrong.
/// @throws std::invalid_argument with fewer than kMinPairs pairs.
HeadOffset FitHeadOffset(const std::vector<TruthAndEstimate>& pairs);
inline constexpr int kMinPairs = 5;

/// The estimate as a pose of the truth's head frame: X_CT = X_CM X_TM^-1.
inline RigidTransform RemoveOffset(const RigidTransform& X_CM, const HeadOffset& offset) {
  return X_CM * offset.X_TM.inverse();
}

/// Writes and reads the file of --fit-head-offset and --head-offset (JSON).
/// @throws std::runtime_error where it cannot be written.
void SaveHeadOffset(const HeadOffset& offset, const std::string& file);
/// @throws std::invalid_argument naming file, key, value and rule.
HeadOffset LoadHeadOffset(const std::string& file);

}  // namespace visavis
