#include "services/stereo_capture/aravis_connection.h"

#include "common/gige/gvsp_filter.h"
#include "services/stereo_capture/aravis_error.h"

namespace visavis {
namespace {

// Aravis keeps tables for the process that two cameras must not fill at once: it reads garbage
// then.
std::mutex& AravisTables() {
  static std::mutex mutex;
  return mutex;
}

// Left to USB, since Aravis's own search for GigE cameras takes a second.
std::vector<FoundCamera> ListUsbCameras() {
  const std::lock_guard<std::mutex> lock(AravisTables());
  arv_disable_interface("GigEVision");
  arv_disable_interface("Fake");
  arv_update_device_list();
  std::vector<FoundCamera> found;
  const auto text = [](const char* t) { return std::string(t ? t : ""); };
  for (unsigned i = 0; i < arv_get_n_devices(); ++i) {
    found.push_back({{text(arv_get_device_vendor(i)), text(arv_get_device_model(i)),
                      text(arv_get_device_serial_nbr(i)), text(arv_get_device_id(i)), "", ""},
                     text(arv_get_device_id(i))});
  }
  return found;
}

ArvDevice* OpenDevice(const FoundCamera& found) {
  const std::lock_guard<std::mutex> lock(AravisTables());
  GlibError error;
  ArvDevice* device = nullptr;
  if (!found.usb_id.empty()) {
    device = arv_open_device(found.usb_id.c_str(), error.out());
  } else {
    const ObjectPtr<GInetAddress> from(
        g_inet_address_new_from_string(found.device.interface_address.c_str()));
    const ObjectPtr<GInetAddress> to(g_inet_address_new_from_string(found.device.address.c_str()));
    if (from && to) device = arv_gv_device_new(from.get(), to.get(), error.out());
  }
  if (!device) throw CameraLost(found.text() + ": cannot be opened: " + error.message());
  return device;
}

}  // namespace

std::string FoundCamera::text() const {
  return device.vendor + " " + device.model + " " + device.serial +
         (usb_id.empty() ? " at " + device.address : " on USB");
}

std::vector<FoundCamera> FindCameras(const std::string& name, int wait_ms,
                                     const std::string& last_address) {
  std::vector<FoundCamera> found;
  const auto keep = [&](const FoundCamera& camera) {
    if (name.empty() || IsCalled(camera.device, name)) found.push_back(camera);
  };
  for (const GvcpDevice& device : DiscoverGvcp(wait_ms, {name, last_address})) keep({device, ""});
  if (!found.empty() && !name.empty()) return found;
  for (const FoundCamera& camera : ListUsbCameras()) keep(camera);
  return found;
}

AravisConnection::AravisConnection(const FoundCamera& found) : address_(found.device.address) {
  const ObjectPtr<ArvDevice> device(OpenDevice(found));
  GlibError error;
  camera_.reset(arv_camera_new_with_device(device.get(), error.out()));
  if (!camera_) throw CameraLost(found.text() + ": cannot be opened: " + error.message());
  // May come in any thread: it only sets a flag.
  g_signal_connect(device.get(), "control-lost",
                   G_CALLBACK(+[](ArvDevice*, std::atomic<bool>* lost) { *lost = true; }),
                   &control_lost_);
}

AravisConnection::~AravisConnection() {
  {
    const std::lock_guard<std::mutex> lock(return_->mutex);
    return_->stream = nullptr;
  }
  g_signal_handlers_disconnect_by_data(arv_camera_get_device(camera_.get()), &control_lost_);
  if (stream_ && farewell_) arv_camera_stop_acquisition(camera_.get(), nullptr);
  stream_.reset();  // before the camera
}

bool AravisConnection::TakeControl() {
  if (!arv_camera_is_gv_device(camera_.get())) return true;
  auto* device = ARV_GV_DEVICE(arv_camera_get_device(camera_.get()));
  return arv_gv_device_is_controller(device) || arv_gv_device_take_control(device, nullptr);
}

void AravisConnection::Start(const CameraConfig& config, std::size_t payload_bytes) {
  GlibError error;
  stream_.reset(arv_camera_create_stream(camera_.get(), nullptr, nullptr, error.out()));
  ThrowOnError(error, "stream");
  if (!stream_) throw CameraLost("stream: cannot be made");
  if (ARV_IS_GV_STREAM(stream_.get())) {
    if (!config.packet_socket)
      FilterStreamSocket(arv_gv_stream_get_port(ARV_GV_STREAM(stream_.get())), address_);
    if (config.socket_buffer_bytes > 0) {
      g_object_set(stream_.get(), "socket-buffer", ARV_GV_STREAM_SOCKET_BUFFER_FIXED,
                   "socket-buffer-size", config.socket_buffer_bytes, nullptr);
    }
    if (!config.packet_resend)
      g_object_set(stream_.get(), "packet-resend", ARV_GV_STREAM_PACKET_RESEND_NEVER, nullptr);
  }
  for (int i = 0; i < config.num_buffers; ++i) {
    auto pixels = std::make_unique<std::vector<std::uint8_t>>(payload_bytes);
    void* data = pixels->data();
    arv_stream_push_buffer(stream_.get(),
                           arv_buffer_new_full(payload_bytes, data, pixels.release(), [](void* p) {
                             delete static_cast<std::vector<std::uint8_t>*>(p);
                           }));
  }
  return_->stream = stream_.get();
  arv_camera_start_acquisition(camera_.get(), error.out());
  ThrowOnError(error, "start of acquisition");
}

std::shared_ptr<ArvBuffer> AravisConnection::Pop(std::uint64_t timeout_us) {
  ArvBuffer* buffer = arv_stream_timeout_pop_buffer(stream_.get(), timeout_us);
  if (!buffer) return nullptr;
  return {buffer, [give_back = return_](ArvBuffer* b) {
            const std::lock_guard<std::mutex> lock(give_back->mutex);
            if (give_back->stream) {
              arv_stream_push_buffer(give_back->stream, b);
            } else {
              g_object_unref(b);
            }
          }};
}

std::shared_ptr<std::vector<std::uint8_t>> AravisConnection::Pixels(
    const std::shared_ptr<ArvBuffer>& buffer) {
  const void* pixels = arv_buffer_get_user_data(buffer.get());
  return {buffer, static_cast<std::vector<std::uint8_t>*>(const_cast<void*>(pixels))};
}

std::int64_t AravisConnection::Count(const char* name) const {
  if (!stream_) return 0;
  return static_cast<std::int64_t>(arv_stream_get_info_uint64_by_name(stream_.get(), name));
}

}  // namespace visavis
