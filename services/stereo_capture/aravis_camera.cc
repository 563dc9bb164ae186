#include "services/stereo_capture/aravis_camera.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "common/core/clock.h"
#include "common/gige/interface_mtu.h"
#include "services/stereo_capture/aravis_error.h"
#include "services/stereo_capture/aravis_trigger.h"

namespace visavis {
namespace {

constexpr int kSearchMs = 100;        // GigE cameras answer within some milliseconds
constexpr double kControlS = 5;       // longer than a dead owner's hold: 3 s
constexpr double kFirstFrameS = 0.5;  // after the start, beside two periods
constexpr int kLargestPacket = 9000;  // [bytes] that cameras' links carry at most, and at least
constexpr int kSmallPacket = 1400;
constexpr double kExposurePollS = 1;  // where the camera chooses its exposure itself
constexpr std::size_t kMaxTeardowns = 4;
constexpr double kDistrustS = 0.1;     // longer than frames wait for each other in Aravis
constexpr std::int64_t kMaxStale = 3;  // more in succession: the camera's clock was set back

std::string StatusText(ArvBufferStatus status) {
  switch (status) {
    case ARV_BUFFER_STATUS_TIMEOUT:
      return "frame incomplete when the next came";
    case ARV_BUFFER_STATUS_MISSING_PACKETS:
      return "frame with missing packets";
    case ARV_BUFFER_STATUS_WRONG_PACKET_ID:
      return "frame with a wrong packet number";
    case ARV_BUFFER_STATUS_SIZE_MISMATCH:
      return "frame larger than agreed";
    case ARV_BUFFER_STATUS_FILLING:
      return "frame unfinished";
    case ARV_BUFFER_STATUS_ABORTED:
      return "frame aborted";
    default:
      return "frame not received";
  }
}

int LargestPacketOf(ArvCamera* camera) {
  gint64 min = 0, max = 0;
  GlibError error;
  arv_camera_get_integer_bounds(camera, "GevSCPSPacketSize", &min, &max, error.out());
  return !error && max > kSmallPacket ? static_cast<int>(std::min<gint64>(max, kLargestPacket))
                                      : kLargestPacket;
}

}  // namespace

AravisCamera::AravisCamera(Side side, SideConfig device, CameraConfig config,
                           std::optional<PictureSize> rig_size, FrameQueue* queue)
    : CameraThread(side, std::move(device), std::move(config), rig_size, queue) {
  Begin();
}

// Leaving waits for the teardowns: 5 s for a camera that is gone.
AravisCamera::~AravisCamera() { End(); }

double AravisCamera::RunOnce() {
  const auto found = Find();
  if (!found) return 0.05;
  // Give a teardown in work the chance to say farewell, or we would find the camera held by us.
  for (auto& teardown : teardowns_) teardown.wait_for(std::chrono::milliseconds(200));
  auto connection = std::make_unique<AravisConnection>(*found);
  try {
    if (TakeControl(connection.get(), found->text())) {
      const CameraConfig config = ConfigFor(*found, connection->camera());
      const CameraFormat format =
          ApplySettings(connection->camera(), config, device_.features, rig_size_);
      connection->Start(config, format.payload_bytes);
      last_address_ = found->device.address;
      {
        const std::lock_guard<std::mutex> lock(mutex_);
        report_.what = found->text() + ", " + format.text;
      }
      if (!Stream(connection.get(), format)) small_packets_ = !small_packets_;
    }
  } catch (...) {
    TearDown(std::move(connection));
    throw;
  }
  TearDown(std::move(connection));
  return 0;
}

CameraConfig AravisCamera::ConfigFor(const FoundCamera& found, ArvCamera* camera) const {
  CameraConfig config = config_;
  if (config.packet_size_bytes != 0 || !found.usb_id.empty()) return config;
  config.packet_size_bytes =
      small_packets_ ? kSmallPacket
                     : std::min({kLargestPacket, InterfaceMtu(found.device.interface_address),
                                 LargestPacketOf(camera)});
  return config;
}

std::optional<FoundCamera> AravisCamera::Find() {
  const auto found = FindCameras(device_.device, kSearchMs, last_address_);
  if (found.size() == 1) return found[0];
  const std::string key_value = DeviceKeyValue();
  if (found.size() > 1) {
    throw CameraRefusal(key_value + ": " + std::to_string(found.size()) +
                        " cameras answer to it (" + found[0].text() + ", " + found[1].text() +
                        "): must be one");
  }
  Fail(State::kSearching, key_value + ": no such camera answers; looking for it");
  return std::nullopt;
}

bool AravisCamera::TakeControl(AravisConnection* connection, const std::string& camera) {
  const double end_s = MonotonicSeconds() + kControlS;
  while (!stopping()) {
    if (connection->TakeControl()) return true;
    Fail(State::kOpening, camera + ": another program holds it; trying again");
    if (MonotonicSeconds() > end_s) return false;
    Wait(0.1);
  }
  return false;
}

bool AravisCamera::Stream(AravisConnection* connection, CameraFormat format) {
  ++session_;
  AravisTrigger trigger(connection->camera(), last_address_, config_);
  newest_ns_ = num_stale_ = num_wrong_sizes_ = 0;
  distrust_until_s_ = 0;
  bool first = true, streaming = false;
  double last_s = MonotonicSeconds(), last_poll_s = last_s, first_s = last_s;
  const double first_patience_s = kFirstFrameS + 2 * config_.period_s();
  const bool polls = config_.exposure == "auto" || config_.gain == "auto";
  const std::int64_t missing_before = Report().missing_packets;
  const std::int64_t resent_before = Report().resent_packets;
  // A camera that is gone is not told to stop, since each word to it takes seconds; one that is not
  // stops when we leave.
  connection->set_farewell(false);
  while (!stopping()) {
    const auto buffer = connection->Pop(trigger.Pull());
    const double now_s = MonotonicSeconds();
    if (buffer) {
      last_s = now_s;
      // The first frame's arrival says little of the link, and is often late.
      if (std::exchange(first, false)) {
        first_s = now_s;
        continue;
      }
      const bool good = Take(*connection, buffer, format);
      const std::lock_guard<std::mutex> lock(mutex_);
      report_.missing_packets = missing_before + connection->Count("n_missing_packets");
      report_.resent_packets = resent_before + connection->Count("n_resent_packets");
      if (good && !std::exchange(streaming, true)) {
        ++report_.connects;
        report_.state = State::kStreaming;
      }
      if (good) report_.text.clear();
    }
    if (connection->control_lost()) {
      Fail(State::kOpening, "the camera does not answer any more");
      return streaming;
    }
    if (!first && !streaming && !small_packets_ && config_.packet_size_bytes == 0 &&
        now_s - first_s > first_patience_s) {
      Fail(State::kOpening, "no frame is whole; connecting anew with smaller packets");
      return false;
    }
    const double patience_s = first ? first_patience_s : config_.stall_s();
    if (now_s - last_s > patience_s) {
      if (WaitsForTrigger(*connection)) {
        last_s = now_s;
        continue;
      }
      const auto silent_ms = std::lround(1e3 * (now_s - last_s));
      Fail(State::kOpening, "no frame for " + std::to_string(silent_ms) + " ms; connecting anew");
      const std::lock_guard<std::mutex> lock(mutex_);
      ++report_.stalls;
      return streaming;
    }
    if (polls && streaming && now_s > last_poll_s + kExposurePollS) {
      last_poll_s = now_s;
      ReadExposure(connection->camera(), &format.exposure_us, &format.gain_db);
    }
  }
  connection->set_farewell(MonotonicSeconds() - last_s < 2 * config_.period_s());
  return true;
}

bool AravisCamera::WaitsForTrigger(const AravisConnection& connection) {
  if (config_.trigger != "line") return false;
  GlibError error;
  arv_camera_get_pixel_format(connection.camera(), error.out());
  if (error) return false;
  const std::lock_guard<std::mutex> lock(mutex_);
  report_.state = State::kStreaming;
  report_.text = std::string(SideName(side_)) + " camera: no trigger on " + config_.trigger_line;
  return true;
}

// A frame is one that Aravis holds for whole, of the size that was agreed, and newer than the last:
// from nonsense on the line Aravis makes whole frames of a buffer's earlier content.
std::string AravisCamera::Fault(const AravisConnection& connection, ArvBuffer* buffer,
                                const CameraFormat& format) {
  const auto status = arv_buffer_get_status(buffer);
  if (status != ARV_BUFFER_STATUS_SUCCESS) return StatusText(status);
  if (arv_buffer_get_payload_type(buffer) != ARV_BUFFER_PAYLOAD_TYPE_IMAGE)
    return "frame that is no image";
  const int width = arv_buffer_get_image_width(buffer);
  const int height = arv_buffer_get_image_height(buffer);
  if (width != format.width || height != format.height ||
      arv_buffer_get_image_pixel_format(buffer) != format.code) {
    return "frame of " + std::to_string(width) + "x" + std::to_string(height) + ", not as agreed";
  }
  std::size_t size = 0;
  arv_buffer_get_data(buffer, &size);
  if (size < format.image_bytes())
    return "frame of " + std::to_string(size) + " bytes, not as agreed";
  // Told by a count alone, so whatever comes at that time is distrusted.
  const std::int64_t wrong_sizes = connection.Count("n_size_mismatch_errors");
  if (wrong_sizes != std::exchange(num_wrong_sizes_, wrong_sizes))
    distrust_until_s_ = MonotonicSeconds() + kDistrustS;
  if (MonotonicSeconds() < distrust_until_s_) return "frame with packets larger than agreed";
  const auto time_ns = static_cast<std::int64_t>(arv_buffer_get_timestamp(buffer));
  if (newest_ns_ > 0 && time_ns <= newest_ns_ && ++num_stale_ <= kMaxStale)
    return "frame that is no newer than the one before";
  newest_ns_ = time_ns;
  num_stale_ = 0;
  return "";
}

bool AravisCamera::Take(const AravisConnection& connection,
                        const std::shared_ptr<ArvBuffer>& buffer, const CameraFormat& format) {
  const std::string wrong = Fault(connection, buffer.get(), format);
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (wrong.empty()) {
      ++report_.frames;
    } else {
      ++report_.bad_frames;
      report_.last_error = std::string(SideName(side_)) + " camera: " + wrong;
    }
  }
  if (!wrong.empty()) return false;
  CapturedFrame frame;
  frame.image = {static_cast<const std::uint8_t*>(arv_buffer_get_data(buffer.get(), nullptr)),
                 format.width,
                 format.height,
                 format.width * BytesPerPixel(format.format),
                 format.image_bytes(),
                 format.format};
  frame.side = side_;
  frame.pixels = AravisConnection::Pixels(buffer);
  frame.session = session_;
  frame.id = arv_buffer_get_frame_id(buffer.get());
  frame.device_ns = static_cast<std::int64_t>(arv_buffer_get_timestamp(buffer.get()));
  frame.arrival_us =
      static_cast<std::int64_t>(arv_buffer_get_system_timestamp(buffer.get()) / 1000);
  frame.exposure_us = format.exposure_us;
  frame.gain_db = format.gain_db;
  if (frame.device_ns == 0) {  // a camera without a clock: its frames' arrival must do
    const double exposure_us = std::isfinite(frame.exposure_us) ? frame.exposure_us : 0;
    frame.is_host_time = true;
    frame.device_ns = 1000 * (frame.arrival_us - std::llround(exposure_us / 2));
  }
  queue_.Push(std::move(frame));
  return true;
}

void AravisCamera::TearDown(std::unique_ptr<AravisConnection> connection) {
  teardowns_.remove_if([](const std::future<void>& f) {
    return f.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
  });
  if (teardowns_.size() >= kMaxTeardowns) teardowns_.pop_front();  // waits for it
  teardowns_.push_back(
      std::async(std::launch::async, [c = std::move(connection)]() mutable { c.reset(); }));
}

}  // namespace visavis
