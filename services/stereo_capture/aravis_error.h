#pragma once

#include <string>

#include "common/gige/gobject.h"
#include "services/stereo_capture/camera_error.h"

namespace visavis {

/// @throws CameraLost or CameraRefusal, whichever @p error is; nothing for no error.
/// @param key_value e.g. "camera.gain_db: 7", what was being set
void ThrowOnError(const GlibError& error, const std::string& key_value);

}  // namespace visavis
