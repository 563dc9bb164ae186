#include "tests/support/naive_bands.h"

#include <cmath>

namespace visavis {
namespace {

double At(const BandView& band, int x, int y) {
  const std::int32_t pair = band.pairs[y * band.width + x];
  return static_cast<double>(static_cast<std::int16_t>(pair & 0xffff)) / kBandSteps;
}

/// Linear between @p from and @p to.
double Blend(double share, double from, double to) { return (1 - share) * from + share * to; }

}  // namespace

bool SampleBand(const BandView& band, double u, double v, BandSample* sample) {
  const auto scale = static_cast<double>(band.scale);
  const double x = (u + 0.5 - static_cast<double>(band.x0)) * scale - 0.5;
  const double y = (v + 0.5 - static_cast<double>(band.y0)) * scale - 0.5;
  if (!(x >= 2 && y >= 2 && x < band.width - 3 && y < band.height - 3)) return false;
  const int i = static_cast<int>(x), j = static_cast<int>(y);
  const double a = x - i, b = y - j;
  const auto value = [&](int column, int row) {
    return Blend(
        b, Blend(a, At(band, i + column, j + row), At(band, i + column + 1, j + row)),
        Blend(a, At(band, i + column, j + row + 1), At(band, i + column + 1, j + row + 1)));
  };
  sample->value = static_cast<float>(value(0, 0));
  sample->du = static_cast<float>(0.5 * scale * (value(1, 0) - value(-1, 0)));
  sample->dv = static_cast<float>(0.5 * scale * (value(0, 1) - value(0, -1)));
  return true;
}

bool NearestSample(const BandView& band, double u, double v, float* value) {
  const auto scale = static_cast<double>(band.scale);
  const double x = (u + 0.5 - static_cast<double>(band.x0)) * scale;
  const double y = (v + 0.5 - static_cast<double>(band.y0)) * scale;
  if (!(x >= 0 && y >= 0 && x < band.width && y < band.height)) return false;
  *value = static_cast<float>(At(band, static_cast<int>(x), static_cast<int>(y)));
  return true;
}

}  // namespace visavis
