#include "services/calibrate_tool/charuco.h"

namespace visavis {

cv::Ptr<cv::aruco::CharucoBoard> MakeCharuco(const BoardSpec& spec) {
  auto name = cv::aruco::DICT_4X4_250;
  if (spec.dictionary == "5x5") name = cv::aruco::DICT_5X5_250;
  if (spec.dictionary == "6x6") name = cv::aruco::DICT_6X6_250;
  if (spec.dictionary == "7x7") name = cv::aruco::DICT_7X7_250;
  return cv::aruco::CharucoBoard::create(
      spec.columns, spec.rows, static_cast<float>(1e-3 * spec.square_mm),
      static_cast<float>(1e-3 * spec.marker_mm), cv::aruco::getPredefinedDictionary(name));
}

}  // namespace visavis
