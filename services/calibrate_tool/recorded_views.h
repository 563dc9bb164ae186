#pragma once

#include <functional>
#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

#include "common/rigs/rig_description.h"
#include "services/calibrate_tool/arm_postures.h"
#include "services/calibrate_tool/pair_intake.h"

namespace visavis {

/// Where views come from, and how many.
struct ViewSource {
  std::string log;      ///< empty: live
  std::string lcm_url;  ///< of live channels
  std::string prefix;
  CollectorSettings collector;
};

/// What was seen, whole.
struct RecordedViews {
  std::vector<StereoView> views;
  ImageSizes sizes;
  std::string summary;
  std::optional<ArmPostures> postures;  ///< where an arm was given, or came with the rig
  std::optional<RigDescription> rig;    ///< of STEREO_RIG
};

/// Reads a log, or listens until there are views enough or @p stopped: then a line a second on
/// @p out says what to do next. @param arm  none: that of STEREO_RIG, if any
/// @throws std::invalid_argument where no pair came, or fewer than @p min_views are of use.
RecordedViews CollectViews(const Board& board, const ViewSource& source,
                           const std::optional<ArmDescription>& arm, int min_views,
                           const std::function<bool()>& stopped, std::ostream& out);

}  // namespace visavis
