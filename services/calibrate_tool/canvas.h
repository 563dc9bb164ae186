#pragma once

// For the reports alone.

#include <opencv2/core.hpp>
#include <string>
#include <vector>

namespace visavis {

/// A white picture to draw on.
class Canvas {
 public:
  Canvas(int width, int height);

  /// @p size: 1 is 20 px high.
  void Text(double x, double y, const std::string& text, double size = 1);
  void Dot(double x, double y, double radius, const cv::Scalar& bgr);
  void Line(double x0, double y0, double x1, double y1, const cv::Scalar& bgr, int thickness = 1);
  void Frame(double x, double y, double width, double height);
  void Bar(double x, double y, double width, double height, const cv::Scalar& bgr);

  /// Bars of @p values (NaN: none) in a frame, a scale from 0 to a round number at its left.
  void BarChart(double x, double y, double width, double height, const std::string& title,
                const std::vector<double>& values, const cv::Scalar& bgr);

  /// @throws std::runtime_error naming the file.
  void Save(const std::string& file) const;

 private:
  cv::Mat image_;
};

/// From blue (0) by green to red (1).
cv::Scalar HeatColour(double share);

/// The next number above @p value that is 1, 2 or 5 times a power of ten.
double RoundUp(double value);

}  // namespace visavis
