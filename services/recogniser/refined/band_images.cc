#include "services/recogniser/refined/band_images.h"

#include <algorithm>

#include "common/core/check.h"

namespace visavis {

BandImages::BandImages(int width, int height) {
  VISAVIS_THROW_UNLESS(width >= 16 && height >= 16, width);
  const auto cells = [&](int divisor) {
    return static_cast<std::size_t>(width / divisor + 1) *
           static_cast<std::size_t>(height / divisor + 1);
  };
  for (Plane* plane : {&half_, &smooth_half_, &scratch_, &bands_[kFineBand]}) {
    plane->data.resize(cells(2));
  }
  for (Plane* plane : {&quarter_, &smooth_quarter_, &wide_, &wider_, &bands_[kCoarseBand]}) {
    plane->data.resize(cells(4));
  }
  eighth_.data.resize(cells(8));
}

void BandImages::Resize(Plane* plane, int width, int height) const {
  plane->width = width;
  plane->height = height;
}

void BandImages::HalfBrightness(const ImageView& image, const PixelBox& box) {
  Resize(&half_, box.width() / 2, box.height() / 2);
  const bool gray = image.format == PixelFormat::kGray;
  const int red = image.format == PixelFormat::kBgr ? 2 : 0, blue = 2 - red;
  const std::ptrdiff_t left = std::ptrdiff_t{box.x0} * (gray ? 1 : 3);  // [bytes] into a row
  for (int y = 0; y < half_.height; ++y) {
    const std::uint8_t* top = image.row(box.y0 + 2 * y) + left;
    const std::uint8_t* bottom = image.row(box.y0 + 2 * y + 1) + left;
    float* out = half_.row(y);
    if (gray) {
      for (int x = 0; x < half_.width; ++x, top += 2, bottom += 2) {
        const int sum = top[0] + top[1] + bottom[0] + bottom[1];
        out[x] = 0.25f * static_cast<float>(sum);
      }
      continue;
    }
    for (int x = 0; x < half_.width; ++x, top += 6, bottom += 6) {
      const int r = top[red] + top[red + 3] + bottom[red] + bottom[red + 3];
      const int g = top[1] + top[4] + bottom[1] + bottom[4];
      const int bl = top[blue] + top[blue + 3] + bottom[blue] + bottom[blue + 3];
      out[x] = (1.0f / 1024) * static_cast<float>(77 * r + 150 * g + 29 * bl);
    }
  }
}

void BandImages::Halve(const Plane& from, Plane* to) {
  to->width = from.width / 2;
  to->height = from.height / 2;
  for (int y = 0; y < to->height; ++y) {
    const float *a = from.row(2 * y), *b = from.row(2 * y + 1);
    float* out = to->row(y);
    for (int x = 0; x < to->width; ++x, a += 2, b += 2) {
      out[x] = 0.25f * (a[0] + a[1] + b[0] + b[1]);
    }
  }
}

// 1 2 1 in both directions; the border repeats.
void BandImages::Smooth3(const Plane& from, Plane* to) {
  Resize(to, from.width, from.height);
  Resize(&scratch_, from.width, from.height);
  const int w = from.width, h = from.height;
  for (int y = 0; y < h; ++y) {
    const float* in = from.row(y);
    float* out = scratch_.row(y);
    out[0] = 0.25f * (3 * in[0] + in[1]);
    for (int x = 1; x < w - 1; ++x) out[x] = 0.25f * (in[x - 1] + 2 * in[x] + in[x + 1]);
    out[w - 1] = 0.25f * (3 * in[w - 1] + in[w - 2]);
  }
  for (int y = 0; y < h; ++y) {
    const float *a = scratch_.row(std::max(y - 1, 0)), *b = scratch_.row(y),
                *c = scratch_.row(std::min(y + 1, h - 1));
    float* out = to->row(y);
    for (int x = 0; x < w; ++x) out[x] = 0.25f * (a[x] + 2 * b[x] + c[x]);
  }
}

// 1 4 6 4 1, as 1 2 1 twice.
void BandImages::Smooth5(const Plane& from, Plane* to) {
  Smooth3(from, to);
  Smooth3(*to, to);
}

// @p from minus @p coarse at twice its resolution (bilinear).
void BandImages::SubtractDoubled(const Plane& from, const Plane& coarse, Plane* to) {
  to->width = from.width;
  to->height = from.height;
  for (int y = 0; y < from.height; ++y) {
    const int near_y = std::min(y / 2, coarse.height - 1);
    const int far_y = std::clamp(y % 2 == 0 ? near_y - 1 : near_y + 1, 0, coarse.height - 1);
    const float *n = coarse.row(near_y), *f = coarse.row(far_y), *in = from.row(y);
    float* out = to->row(y);
    const auto blend = [&](int x) { return 0.75f * n[x] + 0.25f * f[x]; };
    float before = blend(0), here = before;
    for (int x = 0; x < coarse.width; ++x, in += 2, out += 2) {
      const float after = blend(std::min(x + 1, coarse.width - 1));
      out[0] = in[0] - (0.75f * here + 0.25f * before);
      out[1] = in[1] - (0.75f * here + 0.25f * after);
      before = here;
      here = after;
    }
  }
}

void BandImages::Build(const ImageView& image, const PixelBox& box) {
  VISAVIS_THROW_UNLESS(box.x0 % 8 == 0 && box.y0 % 8 == 0 && box.x1 % 8 == 0 && box.y1 % 8 == 0,
                       box.x0);
  box_ = box;
  HalfBrightness(image, box);
  Smooth3(half_, &smooth_half_);
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

bool BandImages::At(Band band, float u, float v, Sample* sample) const {
  const Plane& plane = bands_[band];
  const float scale = band == kFineBand ? 0.5f : 0.25f;
  const float x = (u + 0.5f - static_cast<float>(box_.x0)) * scale - 0.5f;
  const float y = (v + 0.5f - static_cast<float>(box_.y0)) * scale - 0.5f;
  if (!(x >= 2 && y >= 2 && x < static_cast<float>(plane.width - 3) &&
        y < static_cast<float>(plane.height - 3))) {
    return false;
  }
  const int i = static_cast<int>(x), j = static_cast<int>(y);
  const float a = x - static_cast<float>(i), b = y - static_cast<float>(j);
  const std::ptrdiff_t w = plane.width;
  const float* p = plane.row(j) + i;
  // Columns and rows of the 4 x 4 neighbourhood, each interpolated across.
  const auto row = [&](const float* q) { return q[0] + a * (q[1] - q[0]); };
  const float r0 = row(p - w), r1 = row(p), r2 = row(p + w), r3 = row(p + 2 * w);
  const auto column = [&](int k) { return p[k] + b * (p[k + w] - p[k]); };
  const float c0 = column(-1), c1 = column(0), c2 = column(1), c3 = column(2);
  sample->value = r1 + b * (r2 - r1);
  sample->du = 0.5f * scale * ((c2 - c0) + a * ((c3 - c1) - (c2 - c0)));
  sample->dv = 0.5f * scale * ((r2 - r0) + b * ((r3 - r1) - (r2 - r0)));
  return true;
}

}  // namespace visavis
