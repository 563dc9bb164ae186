#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "common/convert/image_message.h"

namespace visavis {

/// Tells a camera that repeats its picture while the other goes on: no two pictures of a real
/// camera are the same, for their noise. Where both repeat, somebody plays a still picture.
class PictureWatch {
 public:
  /// To be called with each pair, in order. A picture that is repeated is taken out of the pair:
  /// the other eye goes on alone.
  void TakeOutStale(StereoImages* images);
  /// Another session: no picture was seen, nothing is wrong. The counts stay.
  void Forget();

  /// Pairs whose right, left picture was stale, since the start.
  std::int64_t num_stale_right() const { return num_stale_[0]; }
  std::int64_t num_stale_left() const { return num_stale_[1]; }
  /// What is wrong with the last pair and what mends it; empty: nothing.
  const std::string& complaint() const { return complaint_; }

 private:
  std::array<std::optional<std::uint64_t>, 2> seen_;  ///< checksums of the last pair: right, left
  std::array<std::int64_t, 2> num_stale_{};
  std::string complaint_;
};

/// A checksum of the picture's file, or of 64 or more of its rows.
std::uint64_t PictureChecksum(const ImageView& image);

}  // namespace visavis
