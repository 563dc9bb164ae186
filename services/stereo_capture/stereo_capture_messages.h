#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/image/image_decoder.h"
#include "services/stereo_capture/frame_source.h"
#include "visavis/images_t.hpp"

namespace visavis {

/// One side of a message: the picture and what is known of it.
struct StampedFrame {
  CapturedFrame frame;
  std::int64_t utime_us{0};   ///< mid-exposure, host time
  std::int64_t camera_us{0};  ///< mid-exposure, the camera's clock
};

/// Makes the messages of pairs and of single images, raw or as JPEG, in memory that is reused.
class ImagesMessage {
 public:
  /// @param jpeg_quality 1 to 100; nothing: pictures stay as the camera sent them
  explicit ImagesMessage(std::optional<int> jpeg_quality) : jpeg_quality_(jpeg_quality) {}

  ~ImagesMessage() { GiveBack(); }
  ImagesMessage(const ImagesMessage&) = delete;
  ImagesMessage& operator=(const ImagesMessage&) = delete;

  /// The message of a pair. @return it, valid until the next call. Raw pictures lend it their
  /// memory until GiveBack().
  const images_t& Pair(const StampedFrame& left, const StampedFrame& right, std::int64_t seq);
  /// The message of one image, its partner being away; otherwise as Pair().
  const images_t& Single(const StampedFrame& frame, std::int64_t seq);
  /// Lets go of the pictures of the last message, which then holds none.
  void GiveBack();

 private:
  void Fill(const StampedFrame& frame, std::int64_t seq, std::optional<std::int64_t> skew_us,
            image_t* image);

  struct Loan {
    std::shared_ptr<std::vector<std::uint8_t>> pixels;
    image_t* image;
  };

  const std::optional<int> jpeg_quality_;
  ImageDecoder decoder_;  // of Bayer patterns, before they become JPEG
  JpegEncoder encoder_;
  images_t pair_, single_;
  std::vector<Loan> loans_;
};

}  // namespace visavis
