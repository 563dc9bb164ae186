#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/geometry/stereo_rig.h"
#include "common/image/image.h"
#include "visavis/images_t.hpp"

namespace visavis {

/// A stereo message's pictures, found by type. Views into the message.
struct StereoImages {
  std::int64_t utime_us{0};  ///< the right image's mid-exposure, host time
  std::optional<ImageView> right;
  std::optional<ImageView> left;
  std::optional<std::int64_t> seq;  ///< of the pair, from the metadata
};

/// View of one image_t. @throws MessageError naming field, value and rule where the sizes lie.
ImageView FromMessage(const image_t& message);

/// Views of the pair, checked against the rig's image sizes. @throws MessageError, also for an
/// image type that is neither or comes twice, and for a message with neither image.
StereoImages FromMessage(const images_t& message, const StereoRig& rig);

/// Copies a picture into @p message (memory reused) with its time; metadata is cleared.
void SetImage(const ImageView& image, std::int64_t utime_us, image_t* message);

/// As SetImage() for a raw picture that fills @p pixels exactly, without a copy: the message and
/// *@p pixels trade their memory. A second call of std::swap trades it back.
void SwapImage(const ImageView& image, std::int64_t utime_us, std::vector<std::uint8_t>* pixels,
               image_t* message);

/// Adds one named number to a picture's metadata.
void AddMetadata(const std::string& key, std::int64_t value, image_t* message);

/// The named number of a picture's metadata; nothing where it is missing or no number.
std::optional<std::int64_t> FindMetadata(const image_t& message, const std::string& key);

}  // namespace visavis
