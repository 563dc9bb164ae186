#include "tests/support/capture_harness.h"

#include <dirent.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <sstream>

#include "common/bus/channels.h"
#include "common/convert/image_message.h"
#include "common/core/clock.h"
#include "tests/support/network.h"

namespace visavis {
namespace {

std::string ProgramPath() {
  const char* folder = std::getenv("VISAVIS_BIN_DIR");
  return std::string(folder ? folder : "build/bin") + "/visavis-stereo-capture";
}

std::optional<std::int64_t> TickIn(const images_t& images, std::int16_t type) {
  for (std::size_t i = 0; i < images.images.size(); ++i) {
    const image_t& image = images.images[i];
    if (images.image_types[i] != type || image.data.size() < 8) continue;
    std::int64_t tick = 0;
    std::memcpy(&tick, image.data.data(), sizeof tick);
    return tick;
  }
  return std::nullopt;
}

int CountEntries(const std::string& folder) {
  int count = 0;
  DIR* directory = opendir(folder.c_str());
  if (!directory) return 0;
  while (readdir(directory)) ++count;
  closedir(directory);
  return count - 2;  // . and ..
}

}  // namespace

CaptureHarness::CaptureHarness(const Options& options)
    : left_(std::make_unique<FakeCamera>(options.left, Picture(images_t::LEFT))),
      right_(std::make_unique<FakeCamera>(options.right, Picture(images_t::RIGHT))),
      url_(TestLcmUrl(0, "&recv_buf_size=4194304")),
      bus_(std::make_unique<LcmBus>(url_, "")) {
  if (!options.power_left) left_->Die();
  if (!options.power_right) right_->Die();
  bus_->Subscribe<images_t>(
      kStereoImagesChannel, [this](const images_t& m) { Take(m); }, 100);
  bus_->Subscribe<service_status_t>(kServiceStatusChannel,
                                    [this](const service_status_t& m) { status_ = m; });
  bus_->Subscribe<stereo_rig_t>(kStereoRigChannel, [this](const stereo_rig_t&) { ++num_rigs_; });
  args_ = {ProgramPath(), "--lcm-url", url_};
  std::vector<std::string> settings{"camera.frame_rate_hz=" + std::to_string(options.frame_rate_hz),
                                    "camera.packet_size_bytes=9000"};
  settings.insert(settings.end(), options.settings.begin(), options.settings.end());
  for (const std::string& setting : settings) args_.insert(args_.end(), {"--set", setting});
  Restart();
}

void CaptureHarness::Restart() { process_ = std::make_unique<ChildProcess>(args_); }

FillFrame CaptureHarness::Picture(int side) {
  return [this, side](const FakeFrame& frame) -> std::optional<std::int64_t> {
    // Both on one trigger, at multiples of the period by the host's clock. That this machine comes
    // to it late is what a slow link does.
    const std::int64_t tick = frame.utime_us / frame.period_us;
    std::memcpy(frame.pixels, &tick, sizeof tick);
    const std::lock_guard<std::mutex> lock(mutex_);
    exposed_ticks_[static_cast<std::size_t>(side)].insert(tick);
    return tick * frame.period_us - std::llround(frame.exposure_us);
  };
}

void CaptureHarness::Take(const images_t& images) {
  CaptureEvent event{MonotonicSeconds(),
                     images.utime,
                     FindMetadata(images.images.at(0), "seq").value_or(-1),
                     TickIn(images, images_t::LEFT),
                     TickIn(images, images_t::RIGHT),
                     FindMetadata(images.images.at(0), "skew_us")};
  events_.push_back(event);
  images_ = images;
}

bool CaptureHarness::Receive(double seconds, const std::function<bool()>& done) {
  const double end_s = MonotonicSeconds() + seconds;
  while (MonotonicSeconds() < end_s) {
    if (done && done()) return true;
    bus_->HandleOne(10);
  }
  return done && done();
}

bool CaptureHarness::ReceivePairs(int count, double seconds) {
  const std::size_t begin = events_.size();
  return Receive(seconds, [&] {
    return std::count_if(events_.begin() + static_cast<std::ptrdiff_t>(begin), events_.end(),
                         [](const CaptureEvent& e) { return e.left_tick && e.right_tick; }) >=
           count;
  });
}

int CaptureHarness::num_wrong() const {
  return static_cast<int>(std::count_if(events_.begin(), events_.end(), [](const CaptureEvent& e) {
    return e.left_tick && e.right_tick && e.left_tick != e.right_tick;
  }));
}

int CaptureHarness::num_exposed(std::int64_t from_tick) const {
  if (events_.empty()) return 0;
  const std::int64_t last = events_.back().right_tick.value_or(0);
  const std::lock_guard<std::mutex> lock(mutex_);
  return static_cast<int>(
      std::count_if(exposed_ticks_[0].begin(), exposed_ticks_[0].end(), [&](std::int64_t tick) {
        return tick >= from_tick && tick <= last && exposed_ticks_[1].count(tick) > 0;
      }));
}

int CaptureHarness::NumLostOnBus(std::int64_t from_tick) const {
  std::int64_t lost = 0, last_seq = -1;
  for (const CaptureEvent& event : events_) {
    if (event.right_tick.value_or(0) < from_tick) continue;
    if (last_seq >= 0) lost += event.seq - last_seq - 1;
    last_seq = event.seq;
  }
  return static_cast<int>(lost);
}

int CaptureHarness::NumMissing(std::int64_t from_tick) const {
  std::set<std::int64_t> received;
  for (const CaptureEvent& event : events_) {
    if (event.left_tick && event.left_tick == event.right_tick && *event.left_tick >= from_tick)
      received.insert(*event.left_tick);
  }
  return num_exposed(from_tick) - static_cast<int>(received.size()) - NumLostOnBus(from_tick);
}

std::int64_t CaptureHarness::Counter(const std::string& name) const {
  for (std::size_t i = 0; i < status_.counter_names.size(); ++i) {
    if (status_.counter_names[i] == name) return status_.counters[i];
  }
  return 0;
}

ProcessUse UseOf(int pid) {
  const std::string folder = "/proc/" + std::to_string(pid);
  ProcessUse use;
  std::ifstream stat(folder + "/stat");
  std::string text;
  std::getline(stat, text);
  std::istringstream fields(text.substr(text.rfind(')') + 2));
  std::vector<std::string> values;
  for (std::string value; fields >> value;) values.push_back(value);
  if (values.size() < 22) return use;
  const auto ticks = static_cast<double>(sysconf(_SC_CLK_TCK));
  use.cpu_s = (std::stod(values[11]) + std::stod(values[12])) / ticks;
  use.num_threads = std::stoi(values[17]);
  use.resident_mb = std::stod(values[21]) * static_cast<double>(sysconf(_SC_PAGESIZE)) / 1e6;
  use.num_descriptors = CountEntries(folder + "/fd");
  return use;
}

}  // namespace visavis
