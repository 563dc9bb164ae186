#include "services/stereo_capture/camera_thread.h"

#include <chrono>
#include <utility>

#include "services/stereo_capture/camera_error.h"

namespace visavis {
namespace {

constexpr double kRefusedS = 1;  // until a camera that refused is asked again
constexpr double kLostAgainS = 0.1;

}  // namespace

CameraThread::CameraThread(Side side, SideConfig device, CameraConfig config,
                           std::optional<PictureSize> rig_size, FrameQueue* queue)
    : side_(side),
      device_(std::move(device)),
      config_(std::move(config)),
      rig_size_(rig_size),
      queue_(*queue) {}

void CameraThread::Begin() {
  thread_ = std::thread([this] { Run(); });
}

void CameraThread::End() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stop_ = true;
  }
  stopping_.notify_all();
  thread_.join();
}

CameraReport CameraThread::Report() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return report_;
}

void CameraThread::Run() {
  while (!stop_) {
    double wait_s = kLostAgainS;
    try {
      wait_s = RunOnce();
    } catch (const CameraRefusal& e) {
      Fail(State::kRefused, e.what());
      wait_s = kRefusedS;
    } catch (const std::exception& e) {  // OpenCV's among them
      Fail(State::kOpening, e.what());
    }
    Wait(wait_s);
  }
}

void CameraThread::Wait(double seconds) {
  std::unique_lock<std::mutex> lock(mutex_);
  stopping_.wait_for(lock, std::chrono::duration<double>(seconds), [this] { return stop_.load(); });
}

void CameraThread::Fail(State state, const std::string& text) {
  const std::lock_guard<std::mutex> lock(mutex_);
  report_.state = state;
  report_.text = std::string(SideName(side_)) + " camera: " + text;
  report_.last_error = report_.text;
  ++report_.attempts;
}

std::string CameraThread::DeviceKeyValue() const {
  return std::string(SideName(side_)) + ".device: " + device_.device;
}

}  // namespace visavis
