#pragma once

#include <string>

#include "services/recogniser/enrol/view_selection.h"
#include "services/recogniser/recogniser_config.h"
#include "services/recogniser/refined/head_bundle.h"

namespace visavis {

/// A head learned from a recording, and how well it fits it.
struct Enrolment {
  HeadGeometry head;
  int frames{0}, tracked{0};  ///< of the last reading of the recording
  std::size_t views{0};       ///< that the head is made of
  ViewSelection::Range range{};
  HeadBundle::Agreement before, after;  ///< of the head it began with, and of this one
  double rms_change_mm{0};              ///< of the face's surface from where it started
};

/// Learns the shape and the looks of the head that the stereo recording @p log shows, turning, at
/// unknown poses. The recording is read three times: each time the head is tracked, as well as it
/// is known by then, and views from all directions are bundled. The head's frame is where the face
/// itself says (FaceFrame), as for heads that are learned on the way; shape and frame of a
/// measured head (HeadGeometry::is_measured) stay.
/// @throws std::invalid_argument where the recording shows too little of a face; std::runtime_error
/// where it cannot be read.
Enrolment Enrol(const std::string& log, const RecogniserConfig& config);

}  // namespace visavis
