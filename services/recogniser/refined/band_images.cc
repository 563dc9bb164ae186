#include "services/recogniser/refined/band_images.h"

#include <algorithm>

#include "common/core/check.h"
#include "services/recogniser/refined/picture_kernel.h"

namespace visavis {

BandImages::BandImages(int width, int height) {
  VISAVIS_THROW_UNLESS(width >= 16 && height >= 16, width);
  const auto cells = [&](int divisor) {
    return static_cast<std::size_t>(width / divisor + 1) *
           static_cast<std::size_t>(height / divisor + 1);
  };
  for (Plane* plane : {&half_, &smooth_half_, &red_, &smooth_red_, &scratch_})
    plane->data.resize(cells(2));
  for (Plane* plane : {&quarter_, &smooth_quarter_, &wide_, &wider_}) plane->data.resize(cells(4));
  eighth_.data.resize(cells(8));
  bands_[kFineBand].data.resize(cells(2));
  bands_[kBrightness].data.resize(cells(2));
  bands_[kCoarseBand].data.resize(cells(4));
  row_.resize(static_cast<std::size_t>(width + 1));
  blended_.resize(static_cast<std::size_t>(width / 4 + 3));
}

void BandImages::HalfBrightness(const ImageView& image, const PixelBox& box) {
  half_.width = box.width() / 2;
  half_.height = box.height() / 2;
  const bool gray = image.format == PixelFormat::kGray, bgr = image.format == PixelFormat::kBgr;
  const std::ptrdiff_t left = std::ptrdiff_t{box.x0} * (gray ? 1 : 3);  // [bytes] into a row
  for (int y = 0; y < half_.height; ++y) {
    const std::uint8_t* top = image.row(box.y0 + 2 * y) + left;
    const std::uint8_t* bottom = image.row(box.y0 + 2 * y + 1) + left;
    std::uint16_t* out = half_.row(y);
    if (gray) {
      for (int x = 0; x < half_.width; ++x, top += 2, bottom += 2) {
        out[x] = static_cast<std::uint16_t>((top[0] + top[1] + bottom[0] + bottom[1]) *
                                            (kBandSteps / 4));
      }
      continue;
    }
    std::uint16_t* means = row_.data();  // 256 a level
    MeanBrightness(top, bottom, box.width(), bgr, means);
    for (int x = 0; x < half_.width; ++x) {
      out[x] = static_cast<std::uint16_t>((means[2 * x] + means[2 * x + 1] + 4) >> 3);
    }
  }
}

// Skin scatters red most: in it highlights, which each eye sees elsewhere, count least.
void BandImages::BuildRed(const ImageView& image, const PixelBox& box) {
  if (image.format == PixelFormat::kGray) {
    PairUp(smooth_half_, &bands_[kBrightness]);
    return;
  }
  red_.width = half_.width;
  red_.height = half_.height;
  const std::ptrdiff_t from = std::ptrdiff_t{box.x0} * 3 + Channels(image.format).red;
  for (int y = 0; y < red_.height; ++y) {
    const std::uint8_t* top = image.row(box.y0 + 2 * y) + from;
    const std::uint8_t* bottom = image.row(box.y0 + 2 * y + 1) + from;
    std::uint16_t* out = red_.row(y);
    for (int x = 0; x < red_.width; ++x, top += 6, bottom += 6)
      out[x] =
          static_cast<std::uint16_t>((top[0] + top[3] + bottom[0] + bottom[3]) * (kBandSteps / 4));
  }
  Smooth3(red_, &smooth_red_);
  PairUp(smooth_red_, &bands_[kBrightness]);
}

void BandImages::Halve(const Plane& from, Plane* to) {
  to->width = from.width / 2;
  to->height = from.height / 2;
  for (int y = 0; y < to->height; ++y) {
    const std::uint16_t *a = from.row(2 * y), *b = from.row(2 * y + 1);
    std::uint16_t* out = to->row(y);
    for (int x = 0; x < to->width; ++x) {
      out[x] =
          static_cast<std::uint16_t>((a[2 * x] + a[2 * x + 1] + b[2 * x] + b[2 * x + 1] + 2) >> 2);
    }
  }
}

// 1 2 1 in both directions; the border repeats. 4 * 255 levels and the rounding fit into 16 bits.
void BandImages::Smooth3(const Plane& from, Plane* to) {
  to->width = scratch_.width = from.width;
  to->height = scratch_.height = from.height;
  const int w = from.width, h = from.height;
  const auto smooth = [](std::uint16_t a, std::uint16_t b, std::uint16_t c) {
    const auto sum = static_cast<std::uint16_t>(a + b + b + c + 2);
    return static_cast<std::uint16_t>(sum >> 2);
  };
  for (int y = 0; y < h; ++y) {
    const std::uint16_t* in = from.row(y);
    std::uint16_t* out = scratch_.row(y);
    out[0] = smooth(in[0], in[0], in[1]);
    for (int x = 1; x < w - 1; ++x) out[x] = smooth(in[x - 1], in[x], in[x + 1]);
    out[w - 1] = smooth(in[w - 2], in[w - 1], in[w - 1]);
  }
  for (int y = 0; y < h; ++y) {
    const std::uint16_t *a = scratch_.row(std::max(y - 1, 0)), *b = scratch_.row(y),
                        *c = scratch_.row(std::min(y + 1, h - 1));
    std::uint16_t* out = to->row(y);
    for (int x = 0; x < w; ++x) out[x] = smooth(a[x], b[x], c[x]);
  }
}

// 1 4 6 4 1, as 1 2 1 twice.
void BandImages::Smooth5(const Plane& from, Plane* to) {
  Smooth3(from, to);
  Smooth3(*to, to);
}

void BandImages::PairUp(const Plane& from, PairPlane* to) {
  to->width = from.width;
  to->height = from.height;
  for (int y = 0; y < from.height; ++y) {
    const std::uint16_t* in = from.row(y);
    std::int32_t* out = to->row(y);
    for (int x = 0; x + 1 < from.width; ++x)
      out[x] = static_cast<std::int32_t>(std::uint32_t{in[x + 1]} << 16 | in[x]);
    out[from.width - 1] = static_cast<std::int32_t>(std::uint32_t{in[from.width - 1]} * 0x10001u);
  }
}

// @p from minus @p coarse at twice its resolution (bilinear).
void BandImages::SubtractDoubled(const Plane& from, const Plane& coarse, PairPlane* to) {
  to->width = from.width;
  to->height = from.height;
  const int w = coarse.width;
  const auto blend = [](std::uint16_t near, std::uint16_t far) {
    const auto sum = static_cast<std::uint16_t>(near + near + near + far + 2);
    return static_cast<std::uint16_t>(sum >> 2);
  };
  std::uint16_t* blended = blended_.data() + 1;  // the border repeats on both sides
  std::uint16_t* row = row_.data();              // signed, modulo 2^16
  for (int y = 0; y < from.height; ++y) {
    const int near_y = std::min(y / 2, coarse.height - 1);
    const int far_y = std::clamp(y % 2 == 0 ? near_y - 1 : near_y + 1, 0, coarse.height - 1);
    const std::uint16_t *n = coarse.row(near_y), *f = coarse.row(far_y), *in = from.row(y);
    for (int x = 0; x < w; ++x) blended[x] = blend(n[x], f[x]);
    blended[-1] = blended[0];
    blended[w] = blended[w - 1];
    for (int x = 0; x < w; ++x) {
      row[2 * x] = static_cast<std::uint16_t>(in[2 * x] - blend(blended[x], blended[x - 1]));
      row[2 * x + 1] =
          static_cast<std::uint16_t>(in[2 * x + 1] - blend(blended[x], blended[x + 1]));
    }
    row[2 * w] = row[2 * w - 1];
    std::int32_t* out = to->row(y);
    for (int x = 0; x < 2 * w; ++x) {
      out[x] = static_cast<std::int32_t>(std::uint32_t{row[x + 1]} << 16 | row[x]);
    }
  }
}

void BandImages::Build(const ImageView& image, const PixelBox& box) {
  VISAVIS_THROW_UNLESS(box.x0 % 8 == 0 && box.y0 % 8 == 0 && box.x1 % 8 == 0 && box.y1 % 8 == 0,
                       box.x0);
  box_ = box;
  HalfBrightness(image, box);
  Smooth3(half_, &smooth_half_);
  BuildRed(image, box);
  Halve(smooth_half_, &quarter_);
  Smooth5(quarter_, &wide_);
  Smooth5(wide_, &wider_);
  SubtractDoubled(smooth_half_, wider_, &bands_[kFineBand]);
  Smooth3(quarter_, &smooth_quarter_);
  Halve(smooth_quarter_, &eighth_);
  Smooth5(eighth_, &wide_);
  Smooth5(wide_, &wider_);
  SubtractDoubled(smooth_quarter_, wider_, &bands_[kCoarseBand]);
}

BandView BandImages::view(Band band) const {
  const PairPlane& plane = bands_[band];
  return {plane.data.data(),
          plane.width,
          plane.height,
          static_cast<float>(box_.x0),
          static_cast<float>(box_.y0),
          band == kCoarseBand ? 0.25f : 0.5f};
}

}  // namespace visavis
