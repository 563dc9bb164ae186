#pragma once

#include <cmath>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "common/image/image.h"
#include "services/stereo_capture/stereo_pairer.h"

namespace visavis {

/// One good frame as a camera gave it.
struct CapturedFrame {
  Side side{Side::kRight};
  ImageView image;  ///< into @p pixels
  /// The picture's memory, which goes back to the camera when the last copy of the pointer does. It
  /// may be swapped out while it is published, and must be back by then.
  std::shared_ptr<std::vector<std::uint8_t>> pixels;
  std::int64_t session{0};    ///< another number: the camera was away, its clock and ids begin anew
  std::uint64_t id{0};        ///< the camera's number of the frame, see FrameIds
  std::int64_t device_ns{0};  ///< the camera's own time stamp, of any epoch
  std::int64_t arrival_us{0};  ///< host time at which its first bytes came
  bool is_host_time{false};    ///< device_ns is the exposure's middle in host time already
  double exposure_us{std::nan("")}, gain_db{std::nan("")};  ///< NaN: unknown
};

/// What a camera says of itself.
struct CameraReport {
  enum class State {
    kSearching,  ///< nobody answers to its name
    kOpening,    ///< there, but not ready: held by someone else, or being set up
    kRefused,    ///< there, and cannot do what the configuration asks
    kStreaming,
  };
  State state{State::kSearching};
  int attempts{0};         ///< to find and open it, since start
  std::string text;        ///< what is wrong now; empty: nothing
  std::string last_error;  ///< the newest thing that went wrong
  std::string what;        ///< vendor, model, serial, address; what is set on it
  // Counts since start.
  std::int64_t frames{0};           ///< good ones
  std::int64_t bad_frames{0};       ///< damaged, truncated, of another size than agreed
  std::int64_t missing_packets{0};  ///< that stayed missing
  std::int64_t resent_packets{0};
  std::int64_t connects{0};  ///< times it began to stream; one is the first
  std::int64_t stalls{0};    ///< times it fell silent
};

/// One camera, or what stands for one: pushes frames into a queue from a thread of its own until it
/// is destroyed, and looks for its camera again whenever that is lost.
class FrameSource {
 public:
  virtual ~FrameSource() = default;
  /// From any thread.
  virtual CameraReport Report() const = 0;
  /// Whether nothing more will come: pictures that have an end.
  virtual bool finished() const { return false; }
};

}  // namespace visavis
