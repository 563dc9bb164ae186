#include "services/log_tool/sequence_export.h"

#include <cstdio>
#include <filesystem>
#include <optional>
#include <stdexcept>

#include "common/convert/image_message.h"
#include "common/convert/message_error.h"
#include "common/image/image_decoder.h"
#include "common/recording/log_contents.h"
#include "common/rigs/rig_file.h"
#include "services/log_tool/picture_file.h"
#include "services/log_tool/sequence_tables.h"

namespace visavis {
namespace {

namespace fs = std::filesystem;

/// A folder under a provisional name that goes unless it is given its own.
class ProvisionalFolder {
 public:
  explicit ProvisionalFolder(const std::string& name) : name_(WithoutSlash(name)) {
    if (fs::exists(name_) && !(fs::is_directory(name_) && fs::is_empty(name_))) {
      throw std::invalid_argument(name + ": must not exist, or be an empty folder");
    }
    fs::remove_all(path());
    fs::create_directories(path());
  }
  ~ProvisionalFolder() {
    std::error_code ignored;
    if (!kept_) fs::remove_all(path(), ignored);
  }
  ProvisionalFolder(const ProvisionalFolder&) = delete;
  ProvisionalFolder& operator=(const ProvisionalFolder&) = delete;

  fs::path path() const { return name_.string() + ".part"; }
  std::string File(const std::string& name) const { return (path() / name).string(); }
  void Keep() {
    fs::rename(path(), name_);  // replaces an empty folder
    kept_ = true;
  }

 private:
  static fs::path WithoutSlash(const std::string& name) {
    const fs::path path = fs::absolute(name).lexically_normal();
    return path.has_filename() ? path : path.parent_path();
  }

  const fs::path name_;
  bool kept_{false};
};

/// Writes the pictures of one camera; one that equals the one before keeps its file.
class PictureWriter {
 public:
  PictureWriter(const ProvisionalFolder& folder, const char* camera)
      : folder_(folder), camera_(camera) {}

  /// @return the file's name. @throws std::invalid_argument for an image that cannot be decoded.
  const std::string& Write(const image_t& message) {
    const ImageView image = FromMessage(message);
    if (num_pictures_ > 0 && message.pixelformat == last_.pixelformat &&
        message.width == last_.width && message.row_stride == last_.row_stride &&
        message.data == last_.data) {
      return name_;
    }
    char stem[32];
    std::snprintf(stem, sizeof stem, "%04lld_", static_cast<long long>(num_pictures_));
    name_ = stem + std::string(camera_);
    name_ += WritePicture(image, folder_.File(name_), &decoder_);
    last_ = message;
    ++num_pictures_;
    return name_;
  }
  std::int64_t num_pictures() const { return num_pictures_; }

 private:
  const ProvisionalFolder& folder_;
  const std::string camera_;
  ImageDecoder decoder_;
  image_t last_{};
  std::string name_;
  std::int64_t num_pictures_{0};
};

/// Turns stereo messages into frames with picture files.
class FrameExporter {
 public:
  explicit FrameExporter(const ProvisionalFolder& folder)
      : left_(folder, "left"), right_(folder, "right") {}

  /// @throws std::invalid_argument for a message that gives no frame.
  void Add(const images_t& message) {
    const image_t* left = Find(message, images_t::LEFT);
    const image_t* right = Find(message, images_t::RIGHT);
    RequireField(left && right, "images_t.n_images", message.n_images,
                 "must be a left and a right");
    RequireField(message.utime > last_us_, "images_t.utime", message.utime,
                 "must be later than the pair before, and >= 0");
    ExportedFrame frame;
    frame.left = left_.Write(*left);
    frame.right = right_.Write(*right);
    frame.utime_us = last_us_ = message.utime;
    frame.number = FindMetadata(*right, "seq").value_or(-1);
    frames_.push_back(std::move(frame));
  }

  /// Frames numbered by the pairs' own sequence numbers where these increase, else from 0.
  std::vector<ExportedFrame> TakeFrames() {
    bool increasing = true;
    std::int64_t last = -1;
    for (const auto& frame : frames_) {
      increasing = increasing && frame.number > last;
      last = frame.number;
    }
    for (std::size_t i = 0; !increasing && i < frames_.size(); ++i) {
      frames_[i].number = static_cast<std::int64_t>(i);
    }
    return std::move(frames_);
  }
  std::int64_t num_pictures() const { return left_.num_pictures() + right_.num_pictures(); }

 private:
  static const image_t* Find(const images_t& message, std::int16_t type) {
    for (std::size_t i = 0; i < message.images.size(); ++i) {
      if (message.image_types[i] == type) return &message.images[i];
    }
    return nullptr;
  }

  PictureWriter left_, right_;
  std::vector<ExportedFrame> frames_;
  std::int64_t last_us_{-1};
};

/// Frames of a log without images.
std::vector<ExportedFrame> FramesOfHeadPoses(const std::vector<head_pose_t>& poses) {
  std::vector<ExportedFrame> frames;
  for (const auto& pose : poses) {
    if (!frames.empty() && pose.utime <= frames.back().utime_us) continue;
    frames.push_back({static_cast<std::int64_t>(frames.size()), pose.utime, "", ""});
  }
  return frames;
}

}  // namespace

ExportSummary ExportSequence(const std::string& log, const std::string& folder,
                             const std::string& prefix) {
  ProvisionalFolder out(folder);
  FrameExporter exporter(out);
  const LogContents contents =
      ReadLog(log, prefix, [&exporter](const images_t& message) { exporter.Add(message); });

  ExportSummary summary;
  std::vector<ExportedFrame> frames = exporter.TakeFrames();
  if (!frames.empty()) {
    WriteFramesCsv(frames, out.File("frames.csv"));
  } else {
    summary.notes.push_back("no stereo pairs: no frames.csv");
    frames = FramesOfHeadPoses(contents.head_poses);
  }
  if (contents.rig) {
    SaveRigFile(*contents.rig, out.File("rig.yaml"));
  } else {
    summary.notes.push_back("no STEREO_RIG: no rig.yaml");
  }
  summary.num_frames = static_cast<std::int64_t>(frames.size());
  summary.num_pictures = exporter.num_pictures();
  summary.num_camera_poses =
      WriteCameraPoseCsv(frames, contents.camera_poses, out.File("camera_pose.csv"));
  summary.num_arm_states = WriteArmCsv(contents.arm_states, out.File("arm.csv"));
  summary.num_truth = WriteTruthCsv(frames, contents.truth, out.File("truth.csv"));
  summary.num_head_poses = WriteHeadPoseCsv(frames, contents.head_poses, out.File("head_pose.csv"));
  if (contents.num_rejected > 0) {
    summary.notes.push_back("left out " + std::to_string(contents.num_rejected) +
                            " messages, the last: " + contents.last_reject);
  }
  if (contents.num_damaged_bytes > 0) {
    summary.notes.push_back("left out " + std::to_string(contents.num_damaged_bytes) +
                            " damaged bytes");
  }
  if (fs::is_empty(out.path())) {
    throw std::invalid_argument(log + ": must hold a channel that can be exported" +
                                (prefix.empty() ? "" : " (prefix " + prefix + ")"));
  }
  out.Keep();
  return summary;
}

}  // namespace visavis
