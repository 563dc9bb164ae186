#include "common/gige/fake_camera.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cmath>
#include <condition_variable>
#include <mutex>
#include <stdexcept>
#include <system_error>

#include "common/core/clock.h"
#include "common/gige/gobject.h"

namespace visavis {
namespace {

constexpr std::uint32_t kPacketSizeRegister = 0x0d04;  // GigE Vision: stream channel 0
constexpr double kLostOfLarge = 0.9;                   // small parts of a frame come through
constexpr int kGvcpPort = 3956;

// Aravis's camera says that it runs even where it got no socket.
void RequireFreeAddress(const std::string& address) {
  sockaddr_in name{};
  name.sin_family = AF_INET;
  name.sin_port = htons(kGvcpPort);
  const int fd = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  const bool bound = fd >= 0 && inet_pton(AF_INET, address.c_str(), &name.sin_addr) == 1 &&
                     bind(fd, reinterpret_cast<const sockaddr*>(&name), sizeof name) == 0;
  const int error = errno;
  if (fd >= 0) close(fd);
  if (!bound) {
    throw std::runtime_error("fake camera at " + address + ":" + std::to_string(kGvcpPort) + ": " +
                             std::generic_category().message(error));
  }
}

ArvPixelFormat ToAravis(PixelFormat format) {
  switch (format) {
    case PixelFormat::kGray:
      return ARV_PIXEL_FORMAT_MONO_8;
    case PixelFormat::kRgb:
      return ARV_PIXEL_FORMAT_RGB_8_PACKED;
    case PixelFormat::kBayerBggr:
      return ARV_PIXEL_FORMAT_BAYER_BG_8;
    case PixelFormat::kBayerGbrg:
      return ARV_PIXEL_FORMAT_BAYER_GB_8;
    case PixelFormat::kBayerGrbg:
      return ARV_PIXEL_FORMAT_BAYER_GR_8;
    case PixelFormat::kBayerRggb:
      return ARV_PIXEL_FORMAT_BAYER_RG_8;
    default:
      throw std::invalid_argument("fake camera: " + PixelFormatName(format) +
                                  ": must be gray, rgb or bayer");
  }
}

// Nothing for a format that the callback's user does not know (Mono16).
std::optional<PixelFormat> FromAravis(ArvPixelFormat format) {
  for (const PixelFormat candidate :
       {PixelFormat::kGray, PixelFormat::kRgb, PixelFormat::kBayerBggr, PixelFormat::kBayerGbrg,
        PixelFormat::kBayerGrbg, PixelFormat::kBayerRggb}) {
    if (ToAravis(candidate) == format) return candidate;
  }
  return std::nullopt;
}

}  // namespace

class FakeCamera::Impl {
 public:
  Impl(const Options& options, FillFrame fill) : options_(options), fill_(std::move(fill)) {
    PowerOn(options_.address);
  }
  ~Impl() { PowerOff(); }

  void PowerOn(const std::string& address) {
    RequireFreeAddress(address);
    options_.address = address;
    power_on_us_ = SystemClock().NowUs();
    clock_step_us_ = 0;
    number_ = 0;
    to_drop_ = 0;
    mute_ = false;
    SetFrozen(false);
    const std::string& file = options_.genicam_file;
    ObjectPtr<ArvGvFakeCamera> camera(arv_gv_fake_camera_new_full(
        address.c_str(), options_.serial.c_str(), file.empty() ? nullptr : file.c_str()));
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      camera_ = std::move(camera);
      fake_ = arv_gv_fake_camera_get_fake_camera(camera_.get());
    }
    Write(ARV_FAKE_CAMERA_REGISTER_WIDTH, static_cast<std::uint32_t>(options_.width));
    Write(ARV_FAKE_CAMERA_REGISTER_HEIGHT, static_cast<std::uint32_t>(options_.height));
    Write(ARV_FAKE_CAMERA_REGISTER_PIXEL_FORMAT, ToAravis(options_.format));
    Write(ARV_FAKE_CAMERA_REGISTER_ACQUISITION_FRAME_PERIOD_US,
          static_cast<std::uint32_t>(std::lround(1e6 / options_.frame_rate_hz)));
    // A software trigger is looked for so often; the default would make it 40 ms late.
    arv_fake_camera_set_trigger_frequency(fake(), 200);
    arv_fake_camera_set_fill_pattern(fake(), &Impl::OnFrame, this);
  }

  void PowerOff() {
    SetFrozen(false, true);  // after this its thread leaves camera_ alone
    camera_.reset();
  }

  void SetFrozen(bool frozen, bool leaving = false) {
    const std::lock_guard<std::mutex> lock(mutex_);
    frozen_ = frozen;
    leaving_ = leaving;
    changed_.notify_all();
  }

  ArvFakeCamera* fake() const { return fake_; }
  void Write(std::uint32_t address, std::uint32_t value) {
    arv_fake_camera_write_register(fake(), address, value);
  }

  Options options_;
  const FillFrame fill_;
  ObjectPtr<ArvGvFakeCamera> camera_;
  ArvFakeCamera* fake_{nullptr};  // its inside, which its thread may use until it has ended
  std::atomic<bool> mute_{false};
  std::atomic<int> to_drop_{0};
  std::atomic<std::int64_t> clock_step_us_{0};
  std::atomic<std::uint64_t> total_{0};

 private:
  static void OnFrame(ArvBuffer* buffer, void* self, guint32 exposure_us, guint32 gain,
                      ArvPixelFormat format) {
    static_cast<Impl*>(self)->Fill(buffer, exposure_us, gain, format);
  }

  void Fill(ArvBuffer* buffer, guint32 exposure_us, guint32 gain, ArvPixelFormat format) {
    std::unique_lock<std::mutex> lock(mutex_);
    changed_.wait(lock, [this] { return !frozen_ || leaving_; });
    ArvFakeCamera* const fake = fake_;
    lock.unlock();
    std::size_t size = 0;
    auto* pixels =
        static_cast<std::uint8_t*>(const_cast<void*>(arv_buffer_get_data(buffer, &size)));
    guint32 period_us = 0;
    arv_fake_camera_read_register(fake, ARV_FAKE_CAMERA_REGISTER_ACQUISITION_FRAME_PERIOD_US,
                                  &period_us);
    const FakeFrame frame{number_++,
                          SystemClock().NowUs(),
                          period_us,
                          static_cast<double>(exposure_us),
                          static_cast<double>(gain),
                          FromAravis(format).value_or(PixelFormat::kGray),
                          arv_buffer_get_image_width(buffer),
                          arv_buffer_get_image_height(buffer),
                          pixels};
    ++total_;
    const auto begun_us = fill_ ? fill_(frame) : std::nullopt;
    arv_buffer_set_timestamp(
        buffer, CameraTimeNs(begun_us.value_or(frame.utime_us - std::int64_t{exposure_us})));
    bool lost = mute_;
    if (to_drop_ > 0) {
      --to_drop_;
      lost = true;
    }
    guint32 packet_bytes = 0;
    arv_fake_camera_read_register(fake, kPacketSizeRegister, &packet_bytes);
    double share = options_.lost_packet_share;
    if (options_.largest_packet_bytes > 0 &&
        (packet_bytes & 0xffff) > static_cast<guint32>(options_.largest_packet_bytes))
      share = kLostOfLarge;
    // Aravis looks at this for each packet, in this very thread.
    lock.lock();
    if (leaving_) return;
    g_object_set(camera_.get(), "gvsp-lost-ratio", lost ? 1.0 : share, nullptr);
  }

  guint64 CameraTimeNs(std::int64_t utime_us) const {
    const auto since_us = static_cast<double>(utime_us - power_on_us_);
    const double clock_us = 1e6 * options_.clock_start_s + since_us +
                            1e-6 * options_.drift_ppm * since_us +
                            static_cast<double>(clock_step_us_);
    return static_cast<guint64>(std::llround(1000 * clock_us));
  }

  std::mutex mutex_;
  std::condition_variable changed_;
  bool frozen_{false}, leaving_{false};
  std::int64_t power_on_us_{0};
  std::uint64_t number_{0};
};

FakeCamera::FakeCamera(const Options& options, FillFrame fill)
    : impl_(std::make_unique<Impl>(options, std::move(fill))) {}
FakeCamera::~FakeCamera() = default;

void FakeCamera::Freeze() { impl_->SetFrozen(true); }
void FakeCamera::Thaw() { impl_->SetFrozen(false); }
void FakeCamera::Mute() { impl_->mute_ = true; }
void FakeCamera::Unmute() { impl_->mute_ = false; }
void FakeCamera::Drop(int num_frames) { impl_->to_drop_ += num_frames; }
void FakeCamera::StepClock(double seconds) { impl_->clock_step_us_ += std::llround(1e6 * seconds); }
void FakeCamera::Die() { impl_->PowerOff(); }
void FakeCamera::Return(const std::string& address) {
  impl_->PowerOff();
  impl_->PowerOn(address.empty() ? impl_->options_.address : address);
}
bool FakeCamera::powered() const { return impl_->camera_ != nullptr; }
std::uint64_t FakeCamera::num_frames() const { return impl_->total_; }
void FakeCamera::WriteRegister(std::uint32_t address, std::uint32_t value) {
  if (powered()) impl_->Write(address, value);
}
std::uint32_t FakeCamera::ReadRegister(std::uint32_t address) const {
  std::uint32_t value = 0;
  if (powered()) arv_fake_camera_read_register(impl_->fake(), address, &value);
  return value;
}

std::string FakeCamera::GenicamText() {
  const ObjectPtr<ArvFakeCamera> camera(arv_fake_camera_new("TEXT"));
  std::size_t size = 0;
  const char* text = arv_fake_camera_get_genicam_xml(camera.get(), &size);
  return {text, size};
}

}  // namespace visavis
