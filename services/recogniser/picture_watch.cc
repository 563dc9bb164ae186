#include "services/recogniser/picture_watch.h"

#include <algorithm>
#include <cstring>

namespace visavis {
namespace {

constexpr int kRows = 64;

// Eight bytes at a time, FNV's prime, and a shift that brings high bits down.
std::uint64_t Mix(std::uint64_t sum, const std::uint8_t* bytes, std::size_t count) {
  constexpr std::uint64_t kPrime = 0x100000001b3;
  for (; count >= 8; bytes += 8, count -= 8) {
    std::uint64_t word;
    std::memcpy(&word, bytes, 8);
    sum = (sum ^ word) * kPrime;
    sum ^= sum >> 29;
  }
  for (; count > 0; ++bytes, --count) sum = (sum ^ *bytes) * kPrime;
  return sum;
}

}  // namespace

std::uint64_t PictureChecksum(const ImageView& image) {
  std::uint64_t sum = 0xcbf29ce484222325;
  if (image.format == PixelFormat::kJpeg) return Mix(sum, image.data, image.size);
  const auto row_bytes =
      static_cast<std::size_t>(image.width) * static_cast<std::size_t>(BytesPerPixel(image.format));
  for (int y = 0; y < image.height; y += std::max(1, image.height / kRows)) {
    sum = Mix(sum, image.row(y), row_bytes);
  }
  return sum;
}

void PictureWatch::Forget() {
  seen_ = {};
  complaint_.clear();
}

void PictureWatch::TakeOutStale(StereoImages* images) {
  complaint_.clear();
  if (!images->right || !images->left) {
    Forget();
    return;
  }
  const std::array<std::optional<std::uint64_t>, 2> now = {PictureChecksum(*images->right),
                                                           PictureChecksum(*images->left)};
  const bool right_repeats = now[0] == seen_[0], left_repeats = now[1] == seen_[1];
  seen_ = now;
  if (right_repeats == left_repeats) return;
  const std::size_t stale = right_repeats ? 0 : 1;
  ++num_stale_[stale];
  (right_repeats ? images->right : images->left).reset();
  complaint_ = std::string("images of the ") + (right_repeats ? "right" : "left") +
               " camera are stale: the same picture again while the other camera's changes; going "
               "on with one eye";
}

}  // namespace visavis
