#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "common/image/image.h"

namespace visavis {

/// What a fake camera asks for each time it exposes a frame, in its own thread.
struct FakeFrame {
  std::uint64_t number;      ///< counts the exposures since power-on, lost ones too
  std::int64_t utime_us;     ///< host time of now
  std::int64_t period_us;    ///< as the client set it: exposures are at its multiples
  double exposure_us, gain;  ///< as the client set them
  PixelFormat format;        ///< as the client set it; kGray, kRgb or a Bayer pattern
  int width, height;         ///< [px] as the client set them
  std::uint8_t* pixels;      ///< to be filled: rows without padding
};

/// Fills a frame. @return host time [us] at which its exposure began; nothing: it ends now. The
/// camera stamps the frame with that time by its own clock, and sends it as soon as it is filled.
using FillFrame = std::function<std::optional<std::int64_t>(const FakeFrame& frame)>;

/// A GigE Vision camera in this process (Aravis's), that shows pictures of our own and can fail on
/// command. It speaks GVCP and GVSP over the network like any other: clients in this or another
/// process find it, control it and receive its frames. All members may be called from any thread
/// but the one that fills frames.
class FakeCamera {
 public:
  struct Options {
    std::string address{"127.0.0.1"};  ///< of this host; one camera an address
    std::string serial{"FAKE"};
    int width{640}, height{480};  ///< [px] at power-on; at most 2048
    PixelFormat format{PixelFormat::kRgb};
    double frame_rate_hz{30};
    /// The camera's clock reads clock_start_s at power-on, and gains drift_ppm on the host's.
    double clock_start_s{0}, drift_ppm{0};
    /// Share of the packets that the link loses. The camera cannot send them again.
    double lost_packet_share{0};
    /// Of larger packets [bytes] the link loses nearly all; 0: it carries any.
    int largest_packet_bytes{0};
    /// GenICam description of features beyond Aravis's own, whose registers are plain memory; the
    /// name of a file. Empty: Aravis's.
    std::string genicam_file{};
  };

  /// Powers the camera on. @throws std::runtime_error where the address cannot be had: it is not
  /// this host's, or has a camera already.
  FakeCamera(const Options& options, FillFrame fill);
  ~FakeCamera();
  FakeCamera(const FakeCamera&) = delete;
  FakeCamera& operator=(const FakeCamera&) = delete;

  /// Hangs: neither frames nor answers until Thaw(). Frames of that time are never made.
  void Freeze();
  void Thaw();
  /// Answers, but sends no frames until Unmute(); they are numbered and lost.
  void Mute();
  void Unmute();
  /// Loses the next frames. Called while a frame is filled, by the one that fills it: that one is
  /// the first.
  void Drop(int num_frames);
  /// The camera's clock jumps.
  void StepClock(double seconds);
  /// Loses power.
  void Die();
  /// Power comes back, at another address if one is given: clock and numbers begin anew, nobody
  /// controls it. @throws as the constructor.
  void Return(const std::string& address = "");

  bool powered() const;
  /// Frames exposed since it was first powered on.
  std::uint64_t num_frames() const;
  /// Writes a register behind the client's back: a camera that does not do as it said.
  void WriteRegister(std::uint32_t address, std::uint32_t value);
  std::uint32_t ReadRegister(std::uint32_t address) const;
  /// Aravis's own GenICam description, to be added to.
  static std::string GenicamText();

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace visavis
