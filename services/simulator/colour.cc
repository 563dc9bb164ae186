#include "services/simulator/colour.h"

namespace visavis {
namespace {

/// Identity up to 0.8, then approaches 1 with a continuous slope.
double Shoulder(double x) { return x <= 0.8 ? x : 1.0 - 0.2 * std::exp(-(x - 0.8) / 0.2); }

}  // namespace

ResponseCurve::ResponseCurve() {
  const auto response = [](double radiance) { return 255.0 * SrgbFromLinear(Shoulder(radiance)); };
  for (std::size_t i = 0; i < encode_.size(); ++i) {
    encode_[i] = static_cast<std::uint8_t>(std::lround(response(static_cast<double>(i) / kSteps)));
  }
  for (int value = 0; value < 256; ++value) {
    double low = 0, high = kMax;
    for (int i = 0; i < 60; ++i) {
      const double middle = 0.5 * (low + high);
      (response(middle) < value ? low : high) = middle;
    }
    decode_[static_cast<std::size_t>(value)] = static_cast<float>(0.5 * (low + high));
  }
}

}  // namespace visavis
