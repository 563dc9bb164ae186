#pragma once

#include <array>
#include <atomic>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>

#include "services/stereo_capture/frame_queue.h"
#include "services/stereo_capture/frame_source.h"
#include "services/stereo_capture/picture_reader.h"
#include "services/stereo_capture/picture_size.h"
#include "services/stereo_capture/stereo_capture_config.h"

namespace visavis {

/// Both cameras at once: pairs of pictures at camera.frame_rate_hz, exposed together at multiples
/// of the period since start. A thread of its own reads ahead by one pair.
class PictureSource final : public FrameSource {
 public:
  /// @param rig_sizes what pictures must measure, by Index(Side) @param queue aliased
  /// @throws std::invalid_argument where the first pair cannot be read or is of another size.
  PictureSource(const StereoCaptureConfig& config, std::unique_ptr<PictureReader> reader,
                const std::array<std::optional<PictureSize>, 2>& rig_sizes, FrameQueue* queue);
  ~PictureSource() override;

  CameraReport Report() const override;
  bool finished() const override { return finished_; }

 private:
  void Run();
  /// The next pair; false at the end.
  bool Read();
  void RequireRigSize(const CapturedFrame& frame) const;

  const StereoCaptureConfig config_;
  const std::unique_ptr<PictureReader> reader_;
  const std::array<std::optional<PictureSize>, 2> rig_sizes_;
  FrameQueue& queue_;
  CapturedFrame left_, right_;  // read ahead

  mutable std::mutex mutex_;  // of the two below
  CameraReport report_;
  std::condition_variable stopping_;
  bool stop_{false};
  std::atomic<bool> finished_{false};
  std::thread thread_;
};

}  // namespace visavis
