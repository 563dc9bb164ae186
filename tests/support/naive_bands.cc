#include "tests/support/naive_bands.h"

#include <algorithm>
#include <cmath>

namespace visavis {
namespace {

double At(const BandView& band, int x, int y) {
  const std::int32_t pair = band.pairs[y * band.width + x];
  return static_cast<double>(static_cast<std::int16_t>(pair & 0xffff)) / kBandSteps;
}

/// Linear between @p from and @p to.
double Blend(double share, double from, double to) { return (1 - share) * from + share * to; }

struct Picture {
  Picture(int columns, int rows)
      : width(columns), height(rows), data(static_cast<std::size_t>(columns * rows)) {}
  double& At(int x, int y) { return data[static_cast<std::size_t>(y * width + x)]; }
  /// The border repeats.
  double Near(int x, int y) const {
    x = std::clamp(x, 0, width - 1);
    y = std::clamp(y, 0, height - 1);
    return data[static_cast<std::size_t>(y * width + x)];
  }
  int width, height;
  std::vector<double> data;
};

Picture Halved(const Picture& from) {
  Picture to(from.width / 2, from.height / 2);
  for (int y = 0; y < to.height; ++y) {
    for (int x = 0; x < to.width; ++x) {
      to.At(x, y) = (from.Near(2 * x, 2 * y) + from.Near(2 * x + 1, 2 * y) +
                     from.Near(2 * x, 2 * y + 1) + from.Near(2 * x + 1, 2 * y + 1)) /
                    4;
    }
  }
  return to;
}

Picture Smooth(const Picture& from, int times) {
  Picture to = from;
  for (int k = 0; k < times; ++k) {
    const Picture old = to;
    for (int y = 0; y < to.height; ++y) {
      for (int x = 0; x < to.width; ++x) {
        double sum = 0;
        for (int j = -1; j <= 1; ++j) {
          for (int i = -1; i <= 1; ++i)
            sum += (i == 0 ? 2 : 1) * (j == 0 ? 2 : 1) * old.Near(x + i, y + j);
        }
        to.At(x, y) = sum / 16;
      }
    }
  }
  return to;
}

std::vector<double> Difference(const Picture& fine, const Picture& coarse) {
  std::vector<double> difference;
  for (int y = 0; y < fine.height; ++y) {
    for (int x = 0; x < fine.width; ++x) {
      const int i = x / 2, j = y / 2, ni = x % 2 == 0 ? i - 1 : i + 1,
                nj = y % 2 == 0 ? j - 1 : j + 1;
      const double near = Blend(0.25, coarse.Near(i, j), coarse.Near(i, nj));
      const double far = Blend(0.25, coarse.Near(ni, j), coarse.Near(ni, nj));
      difference.push_back(fine.Near(x, y) - Blend(0.25, near, far));
    }
  }
  return difference;
}

}  // namespace

NaiveBands::NaiveBands(const ImageView& rgb) {
  Picture full(rgb.width, rgb.height), red(rgb.width, rgb.height);
  for (int y = 0; y < rgb.height; ++y) {
    for (int x = 0; x < rgb.width; ++x) {
      const std::uint8_t* p = rgb.row(y) + 3 * x;
      red.At(x, y) = p[0];
      full.At(x, y) = (77.0 * p[0] + 150.0 * p[1] + 29.0 * p[2]) / 256;
    }
  }
  const Picture half = Smooth(Halved(full), 1), quarter = Halved(half);
  bands[kFineBand] = Difference(half, Smooth(quarter, 4));
  const Picture smooth_quarter = Smooth(quarter, 1);
  bands[kCoarseBand] = Difference(smooth_quarter, Smooth(Halved(smooth_quarter), 4));
  bands[kBrightness] = Smooth(Halved(red), 1).data;
}

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
