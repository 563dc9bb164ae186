#include "services/calibrate_tool/canvas.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

#include "common/core/provisional_file.h"

namespace visavis {
namespace {

const cv::Scalar kInk(60, 50, 45), kPale(215, 215, 215);

// Sub-pixel positions for OpenCV: 1/16 px.
cv::Point Fine(double x, double y) {
  return {static_cast<int>(std::lround(16 * x)), static_cast<int>(std::lround(16 * y))};
}

}  // namespace

cv::Scalar HeatColour(double share) {
  const double s = std::clamp(share, 0.0, 1.0);
  const double red = std::clamp(2 * s - 0.4, 0.0, 1.0), blue = std::clamp(1 - 2 * s, 0.0, 1.0);
  const double green = std::clamp(1.2 - 2 * std::abs(s - 0.45), 0.0, 0.75);
  return {220 * blue, 220 * green, 220 * red};
}

double RoundUp(double value) {
  if (!(value > 0)) return 1;
  const double power = std::pow(10, std::floor(std::log10(value)));
  for (const double step : {1.0, 2.0, 5.0, 10.0})
    if (value <= step * power * (1 + 1e-9)) return step * power;
  return 10 * power;
}

Canvas::Canvas(int width, int height) : image_(height, width, CV_8UC3, cv::Scalar(255, 255, 255)) {}

void Canvas::Text(double x, double y, const std::string& text, double size) {
  cv::putText(image_, text, {static_cast<int>(x), static_cast<int>(y)}, cv::FONT_HERSHEY_SIMPLEX,
              0.6 * size, kInk, 1, cv::LINE_AA);
}

void Canvas::Dot(double x, double y, double radius, const cv::Scalar& bgr) {
  cv::circle(image_, Fine(x, y), static_cast<int>(16 * radius), bgr, cv::FILLED, cv::LINE_AA, 4);
}

void Canvas::Line(double x0, double y0, double x1, double y1, const cv::Scalar& bgr,
                  int thickness) {
  cv::line(image_, Fine(x0, y0), Fine(x1, y1), bgr, thickness, cv::LINE_AA, 4);
}

void Canvas::Frame(double x, double y, double width, double height) {
  cv::rectangle(image_, Fine(x, y), Fine(x + width, y + height), kInk, 1, cv::LINE_AA, 4);
}

void Canvas::Bar(double x, double y, double width, double height, const cv::Scalar& bgr) {
  cv::rectangle(image_, Fine(x, y), Fine(x + width, y + height), bgr, cv::FILLED, cv::LINE_AA, 4);
}

void Canvas::BarChart(double x, double y, double width, double height, const std::string& title,
                      const std::vector<double>& values, const cv::Scalar& bgr) {
  double most = 0;
  for (const double value : values)
    if (std::isfinite(value)) most = std::max(most, value);
  const double top = RoundUp(most);
  Text(x, y - 10, title);
  for (int i = 0; i <= 4; ++i) {
    const double level = y + height * (1 - 0.25 * i);
    char label[32];
    std::snprintf(label, sizeof label, "%.3g", 0.25 * i * top);
    Line(x, level, x + width, level, kPale);
    Text(x - 62, level + 6, label, 0.8);
  }
  const double step = width / static_cast<double>(std::max<std::size_t>(1, values.size()));
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!std::isfinite(values[i])) continue;
    const double bar = height * values[i] / top;
    Bar(x + step * (static_cast<double>(i) + 0.15), y + height - bar, 0.7 * step, bar, bgr);
  }
  Frame(x, y, width, height);
}

void Canvas::Save(const std::string& file) const {
  std::vector<std::uint8_t> bytes;
  if (!cv::imencode(".png", image_, bytes)) throw std::runtime_error(file + ": cannot be encoded");
  WriteTextFile(file, std::string(bytes.begin(), bytes.end()));
}

}  // namespace visavis
