#include "services/stereo_capture/picture_reader.h"

#include <opencv2/core/utils/logger.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/videoio.hpp>
#include <stdexcept>
#include <vector>

#include "common/csv/csv_table.h"

namespace visavis {
namespace {

class FolderReader final : public PictureReader {
 public:
  explicit FolderReader(const std::string& folder)
      : folder_(folder), table_(folder + "/frames.csv") {
    left_ = table_.Column("left");
    right_ = table_.Column("right");
    if (table_.num_rows() == 0)
      throw std::invalid_argument(table_.path() + ": must have at least one frame");
  }

  bool Next(cv::Mat* left, cv::Mat* right) override {
    if (row_ >= table_.num_rows()) return false;
    const int row = row_++;
    *left = Read(row, left_);
    *right = Read(row, right_);
    return true;
  }
  void Rewind() override { row_ = 0; }

 private:
  cv::Mat Read(int row, int column) const {
    const std::string file = folder_ + "/" + std::string(table_.Text(row, column));
    cv::Mat picture = cv::imread(file, cv::IMREAD_ANYCOLOR);
    if (picture.empty())
      throw std::runtime_error(table_.PlaceOf(row) + ": " + file + ": is no picture");
    return picture;
  }

  const std::string folder_;
  const CsvTable table_;
  int left_, right_, row_{0};
};

class VideoReader final : public PictureReader {
 public:
  VideoReader(const std::string& left, const std::string& right)
      : left_file_(left), right_file_(right) {
    Rewind();
  }

  bool Next(cv::Mat* left, cv::Mat* right) override {
    return left_.read(*left) && right_.read(*right);
  }
  void Rewind() override {
    Open("left.device", left_file_, &left_);
    Open("right.device", right_file_, &right_);
  }

 private:
  static void Open(const std::string& key, const std::string& file, cv::VideoCapture* video) {
    // OpenCV tells the terminal too, which is not for it to do.
    cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
    const bool is_pattern = file.find('%') != std::string::npos;
    const std::vector<int> backends = is_pattern
                                          ? std::vector<int>{cv::CAP_IMAGES}
                                          : std::vector<int>{cv::CAP_FFMPEG, cv::CAP_OPENCV_MJPEG};
    for (const int backend : backends) {
      try {
        if (video->open(file, backend)) return;
      } catch (const cv::Exception&) {  // told below
      }
    }
    throw std::invalid_argument(key + ": " + file +
                                ": must be a video, or a pattern such as left_%04d.png");
  }

  const std::string left_file_, right_file_;
  cv::VideoCapture left_, right_;
};

}  // namespace

std::unique_ptr<PictureReader> OpenFolder(const std::string& folder) {
  return std::make_unique<FolderReader>(folder);
}

std::unique_ptr<PictureReader> OpenVideos(const std::string& left, const std::string& right) {
  return std::make_unique<VideoReader>(left, right);
}

}  // namespace visavis
