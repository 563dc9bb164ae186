#include "services/stereo_capture/stereo_capture_messages.h"

#include <cmath>

#include "common/convert/image_message.h"

namespace visavis {

const images_t& ImagesMessage::Pair(const StampedFrame& left, const StampedFrame& right,
                                    std::int64_t seq) {
  GiveBack();
  pair_.utime = right.utime_us;
  pair_.n_images = 2;
  pair_.image_types = {images_t::LEFT, images_t::RIGHT};
  pair_.images.resize(2);
  const std::int64_t skew_us = left.utime_us - right.utime_us;
  Fill(left, seq, skew_us, &pair_.images[0]);
  Fill(right, seq, skew_us, &pair_.images[1]);
  return pair_;
}

const images_t& ImagesMessage::Single(const StampedFrame& frame, std::int64_t seq) {
  GiveBack();
  const bool is_left = frame.frame.side == Side::kLeft;
  single_.utime = frame.utime_us;
  single_.n_images = 1;
  single_.image_types = {is_left ? images_t::LEFT : images_t::RIGHT};
  single_.images.resize(1);
  Fill(frame, seq, std::nullopt, &single_.images[0]);
  return single_;
}

void ImagesMessage::GiveBack() {
  for (const Loan& loan : loans_) loan.image->data.swap(*loan.pixels);
  loans_.clear();
}

void ImagesMessage::Fill(const StampedFrame& frame, std::int64_t seq,
                         std::optional<std::int64_t> skew_us, image_t* image) {
  const ImageView& view = frame.frame.image;
  if (jpeg_quality_) {
    SetImage(encoder_.Encode(decoder_.Decode(view), *jpeg_quality_), frame.utime_us, image);
  } else if (frame.frame.pixels && frame.frame.pixels->size() == view.size) {
    SwapImage(view, frame.utime_us, frame.frame.pixels.get(), image);
    loans_.push_back({frame.frame.pixels, image});
  } else {  // the camera pads its frames
    SetImage(view, frame.utime_us, image);
  }
  AddMetadata("seq", seq, image);
  AddMetadata("camera_us", frame.camera_us, image);
  if (std::isfinite(frame.frame.exposure_us))
    AddMetadata("exposure_us", std::llround(frame.frame.exposure_us), image);
  if (std::isfinite(frame.frame.gain_db))
    AddMetadata("gain_db", std::llround(frame.frame.gain_db), image);
  if (skew_us) AddMetadata("skew_us", *skew_us, image);
}

}  // namespace visavis
