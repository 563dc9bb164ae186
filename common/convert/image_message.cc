#include "common/convert/image_message.h"

#include <algorithm>
#include <charconv>

#include "common/convert/message_error.h"

namespace visavis {
namespace {

struct FormatCode {
  PixelFormat format;
  std::int32_t code;
};

constexpr FormatCode kFormatCodes[] = {
    {PixelFormat::kGray, image_t::PIXELFORMAT_GRAY},
    {PixelFormat::kRgb, image_t::PIXELFORMAT_RGB},
    {PixelFormat::kBgr, image_t::PIXELFORMAT_BGR},
    {PixelFormat::kBayerBggr, image_t::PIXELFORMAT_BAYER_BGGR},
    {PixelFormat::kBayerGbrg, image_t::PIXELFORMAT_BAYER_GBRG},
    {PixelFormat::kBayerGrbg, image_t::PIXELFORMAT_BAYER_GRBG},
    {PixelFormat::kBayerRggb, image_t::PIXELFORMAT_BAYER_RGGB},
    {PixelFormat::kJpeg, image_t::PIXELFORMAT_MJPEG},
};

PixelFormat FormatFromCode(std::int32_t code) {
  for (const FormatCode& entry : kFormatCodes) {
    if (entry.code == code) return entry.format;
  }
  RequireField(false, "image_t.pixelformat", code,
               "must be GRAY, RGB, BGR, MJPEG or a BAYER pattern");
  return PixelFormat::kGray;
}

void CheckSize(const char* name, const ImageView& image, const Pinhole& camera) {
  if (image.width == camera.width && image.height == camera.height) return;
  throw MessageError(std::string(name) + " image: " + std::to_string(image.width) + "x" +
                     std::to_string(image.height) + ": must be " + std::to_string(camera.width) +
                     "x" + std::to_string(camera.height) + " as in the rig");
}

// All but the pixels; metadata is cleared.
void SetFields(const ImageView& image, std::int64_t utime_us, image_t* message) {
  message->utime = utime_us;
  message->width = image.width;
  message->height = image.height;
  message->row_stride = image.stride;
  for (const FormatCode& entry : kFormatCodes) {
    if (entry.format == image.format) message->pixelformat = entry.code;
  }
  message->nmetadata = 0;
  message->metadata.clear();
}

}  // namespace

ImageView FromMessage(const image_t& m) {
  RequireField(m.utime >= 0, "image_t.utime", m.utime, "must be >= 0");
  RequireField(m.width >= 1 && m.width <= 16384, "image_t.width", m.width, "must be 1 to 16384 px");
  RequireField(m.height >= 1 && m.height <= 16384, "image_t.height", m.height,
               "must be 1 to 16384 px");
  const PixelFormat format = FormatFromCode(m.pixelformat);
  const auto size = static_cast<std::int64_t>(m.data.size());
  if (format == PixelFormat::kJpeg) {
    RequireField(size >= 4, "image_t.size", size, "must hold a JPEG");
  } else {
    const std::int64_t row_bytes = static_cast<std::int64_t>(m.width) * BytesPerPixel(format);
    RequireField(m.row_stride >= row_bytes, "image_t.row_stride", m.row_stride,
                 "must be at least width times bytes a pixel");
    const std::int64_t needed =
        static_cast<std::int64_t>(m.row_stride) * (m.height - 1) + row_bytes;
    RequireField(size >= needed, "image_t.size", size, "must be at least row_stride times height");
  }
  return {m.data.data(), m.width, m.height, m.row_stride, m.data.size(), format};
}

StereoImages FromMessage(const images_t& message, const StereoRig& rig) {
  StereoImages result;
  RequireField(message.utime >= 0, "images_t.utime", message.utime, "must be >= 0");
  result.utime_us = message.utime;
  RequireField(message.image_types.size() == message.images.size(), "images_t.image_types",
               message.image_types.size(), "must be as many as images");
  for (std::size_t i = 0; i < message.images.size(); ++i) {
    const std::int16_t type = message.image_types[i];
    RequireField(type == images_t::LEFT || type == images_t::RIGHT, "images_t.image_types", type,
                 "must be 0 (left) or 1 (right)");
    const bool is_left = type == images_t::LEFT;
    std::optional<ImageView>& slot = is_left ? result.left : result.right;
    RequireField(!slot, "images_t.image_types", type, "must not come twice");
    slot = FromMessage(message.images[i]);
    CheckSize(is_left ? "left" : "right", *slot, is_left ? rig.left : rig.right);
    if (!result.seq) result.seq = FindMetadata(message.images[i], "seq");
  }
  RequireField(result.left || result.right, "images_t.n_images", message.n_images,
               "must be 1 or 2");
  return result;
}

void SetImage(const ImageView& image, std::int64_t utime_us, image_t* message) {
  SetFields(image, utime_us, message);
  const std::size_t size = image.format == PixelFormat::kJpeg
                               ? image.size
                               : static_cast<std::size_t>(image.stride) * image.height;
  // A view's last row may end at its last pixel: what is missing to a whole stride becomes 0.
  message->data.assign(image.data, image.data + std::min(size, image.size));
  message->data.resize(size, 0);
  message->size = static_cast<std::int32_t>(size);
}

void SwapImage(const ImageView& image, std::int64_t utime_us, std::vector<std::uint8_t>* pixels,
               image_t* message) {
  SetFields(image, utime_us, message);
  message->data.swap(*pixels);
  message->size = static_cast<std::int32_t>(message->data.size());
}

void AddMetadata(const std::string& key, std::int64_t value, image_t* message) {
  const std::string text = std::to_string(value);
  image_metadata_t entry;
  entry.key = key;
  entry.n = static_cast<std::int32_t>(text.size());
  entry.value.assign(text.begin(), text.end());
  message->metadata.push_back(entry);
  message->nmetadata = static_cast<std::int32_t>(message->metadata.size());
}

std::optional<std::int64_t> FindMetadata(const image_t& message, const std::string& key) {
  for (const image_metadata_t& entry : message.metadata) {
    if (entry.key != key) continue;
    std::int64_t value = 0;
    const char* begin = reinterpret_cast<const char*>(entry.value.data());
    const char* end = begin + entry.value.size();
    const auto parsed = std::from_chars(begin, end, value);
    if (parsed.ec == std::errc() && parsed.ptr == end) return value;
  }
  return std::nullopt;
}

}  // namespace visavis
