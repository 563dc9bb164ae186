#pragma once

#include <map>
#include <optional>
#include <string>

#include "common/gige/gobject.h"
#include "common/image/image.h"
#include "services/stereo_capture/camera_config.h"
#include "services/stereo_capture/picture_size.h"

namespace visavis {

/// What a camera sends once it is set up.
struct CameraFormat {
  int width{0}, height{0};  ///< [px]
  PixelFormat format{PixelFormat::kGray};
  ArvPixelFormat code{0};        ///< GenICam's number of the format
  std::size_t payload_bytes{0};  ///< of a frame on the wire: at least the image
  double exposure_us, gain_db;   ///< NaN: the camera does not tell
  std::size_t image_bytes() const {
    return static_cast<std::size_t>(width) * height * BytesPerPixel(format);
  }
  std::string text;  ///< all of it in a line, for people
};

/// Stops @p camera, sets what the configuration says, reads back what it made of it.
/// @param features set last, by name @param rig_size what pictures must measure; nothing: any
/// @throws CameraRefusal naming key, value and rule; CameraLost.
CameraFormat ApplySettings(ArvCamera* camera, const CameraConfig& config,
                           const std::map<std::string, std::string>& features,
                           const std::optional<PictureSize>& rig_size);

/// Exposure time [us] and gain as they are; NaN where the camera has none. @throws CameraLost.
void ReadExposure(ArvCamera* camera, double* exposure_us, double* gain_db);

}  // namespace visavis
