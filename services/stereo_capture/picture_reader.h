#pragma once

#include <memory>
#include <opencv2/core.hpp>
#include <string>

namespace visavis {

/// Reads pairs of pictures one after another.
class PictureReader {
 public:
  virtual ~PictureReader() = default;
  /// The next pair. @return false at the end. @throws std::runtime_error for a picture that cannot
  /// be read; the next call goes on behind it.
  virtual bool Next(cv::Mat* left, cv::Mat* right) = 0;
  /// Back to the first pair.
  virtual void Rewind() = 0;
};

/// A recorded sequence: a folder with frames.csv (columns left and right).
/// @throws std::invalid_argument naming what is wrong.
std::unique_ptr<PictureReader> OpenFolder(const std::string& folder);

/// Two videos, or patterns of pictures such as left_%04d.png. The shorter one ends both.
/// @throws std::invalid_argument naming the one that cannot be opened.
std::unique_ptr<PictureReader> OpenVideos(const std::string& left, const std::string& right);

}  // namespace visavis
