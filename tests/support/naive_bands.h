#pragma once

#include <array>
#include <vector>

#include "common/image/image.h"
#include "services/recogniser/refined/face_kernel.h"
#include "services/recogniser/refined/face_points.h"

namespace visavis {

/// Value and gradient of a band at a place of the picture [levels, levels a px of the picture].
struct BandSample {
  float value, du, dv;
};

/// At picture coordinates (u, v) [px], bilinear; one place at a time in double precision. False
/// within two samples of the border or outside.
bool SampleBand(const BandView& band, double u, double v, BandSample* sample);

/// The value alone, at the nearest sample; false outside.
bool NearestSample(const BandView& band, double u, double v, float* value);

/// Both bands and the brightness of a whole RGB picture, row by row [levels], in double precision;
/// width and height multiples of 8.
struct NaiveBands {
  explicit NaiveBands(const ImageView& rgb);

  std::array<std::vector<double>, kNumPlanes> bands;
};

}  // namespace visavis
