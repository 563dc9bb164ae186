#pragma once

#include <memory>
#include <opencv2/core.hpp>
#include <string>

#include "services/stereo_capture/frame_source.h"

namespace visavis {

/// Whether a picture can be given as this camera.pixel_format: keep, Mono8, RGB8 or BGR8.
bool IsPictureFormat(const std::string& pixel_format);

/// A frame of @p picture (8-bit BGR or grey, as OpenCV reads them) in @p pixel_format, in memory of
/// its own. @throws std::invalid_argument for another kind of picture.
CapturedFrame ToFrame(const cv::Mat& picture, const std::string& pixel_format, Side side);

}  // namespace visavis
