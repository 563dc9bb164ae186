#pragma once

#include <optional>

#include "common/convert/image_message.h"
#include "common/geometry/stereo_rig.h"
#include "common/image/image_decoder.h"
#include "common/image/remap.h"
#include "services/recogniser/estimator.h"

namespace visavis {

/// Pictures as cameras give them into pictures as the estimator takes them: decoded, undistorted.
class FramePreparer {
 public:
  explicit FramePreparer(const StereoRig& rig);

  /// Views into @p images or into memory of this object, valid until the next call.
  /// @throws std::invalid_argument for a damaged JPEG.
  StereoFrame Prepare(const StereoImages& images);

 private:
  struct Side {
    ImageDecoder decoder;
    std::optional<ImageRemap> undistort;
  };
  static ImageView Prepare(const ImageView& image, Side* side);

  Side right_, left_;
};

}  // namespace visavis
