#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "common/bus/lcm_bus.h"
#include "common/gige/fake_camera.h"
#include "tests/support/child_process.h"
#include "visavis/images_t.hpp"
#include "visavis/service_status_t.hpp"
#include "visavis/stereo_rig_t.hpp"

namespace visavis {

/// One message on STEREO_IMAGES as it was received.
struct CaptureEvent {
  double time_s;  ///< of its reception, monotonic
  std::int64_t utime_us, seq;
  std::optional<std::int64_t> left_tick, right_tick;  ///< nothing: no such image
  std::optional<std::int64_t> skew_us;
};

/// visavis-stereo-capture as a process of its own, before two fake cameras in this process, on an
/// LCM port of this process alone. Each picture holds in its first bytes which tick of the common
/// period it was exposed at, so that two pictures with one tick belong together whatever anybody's
/// clock says. Enter a private network first.
class CaptureHarness {
 public:
  struct Options {
    double frame_rate_hz{30};
    FakeCamera::Options left{"127.0.0.1", "LEFT"}, right{"127.0.0.2", "RIGHT"};
    std::vector<std::string> settings;  ///< KEY=VALUE for the service, after the harness's own
    bool power_left{true}, power_right{true};
  };
  explicit CaptureHarness(const Options& options);

  /// Starts the program again, once it has ended.
  void Restart();

  FakeCamera& left() { return *left_; }
  FakeCamera& right() { return *right_; }
  ChildProcess& process() { return *process_; }

  /// Receives for so long, or until @p done. @return whether it was done.
  bool Receive(double seconds, const std::function<bool()>& done = {});
  /// Receives until so many pairs have come from now on. @return whether they did in time.
  bool ReceivePairs(int count, double seconds);

  const std::vector<CaptureEvent>& events() const { return events_; }
  /// Pairs whose pictures do not belong together, of all received.
  int num_wrong() const;
  /// Messages from @p from_tick on that were sent, by their numbers, and did not reach this
  /// process.
  int NumLostOnBus(std::int64_t from_tick) const;
  /// Ticks from @p from_tick on, before the last received, at which both cameras exposed a picture
  /// of which no pair was sent.
  int NumMissing(std::int64_t from_tick) const;
  int num_exposed(std::int64_t from_tick) const;

  /// The newest status; a counter of it, 0 where it has none.
  const service_status_t& status() const { return status_; }
  std::int64_t Counter(const std::string& name) const;
  int num_rigs() const { return num_rigs_; }
  const images_t& last_images() const { return images_; }

 private:
  FillFrame Picture(int side);
  void Take(const images_t& images);

  mutable std::mutex mutex_;                             // of exposed_
  std::array<std::set<std::int64_t>, 2> exposed_ticks_;  // by the cameras' threads
  std::unique_ptr<FakeCamera> left_, right_;
  std::string url_;
  std::vector<std::string> args_;  // of the program
  std::unique_ptr<LcmBus> bus_;
  std::unique_ptr<ChildProcess> process_;
  std::vector<CaptureEvent> events_;
  service_status_t status_{};
  images_t images_;
  int num_rigs_{0};
};

/// Seconds of processor time that a process has taken, and its resident memory, descriptors and
/// threads.
struct ProcessUse {
  double cpu_s{0};
  double resident_mb{0};
  int num_descriptors{0}, num_threads{0};
};
ProcessUse UseOf(int pid);

}  // namespace visavis
