// publish_every_type LCM_URL LOG: writes a log with 100 messages of each type, prints "CHANNEL
// TYPE" for each, then publishes them ten times a second until it is killed, at most a minute.
// HEAD_POSE carries p_CM_m = 0.25 -0.5 1.
#include <chrono>
#include <cstdio>
#include <lcm/lcm-cpp.hpp>
#include <stdexcept>
#include <thread>
#include <utility>

#include "common/bus/channels.h"
#include "tests/fuzz/wire_message.h"
#include "tests/support/message_equal.h"

namespace visavis {
namespace {

template <typename... T>
struct TypeNames {
  std::vector<std::string> names{T::getTypeName()...};
};

struct Sample {
  std::string channel;
  Bytes bytes;
};

std::string ChannelOf(const std::string& type) {
  if (type == "images_t") return kStereoImagesChannel;
  if (type == "rigid_transform_t") return kCameraPoseChannel;
  std::string channel = type.substr(0, type.size() - 2);  // without _t
  for (char& c : channel) c = static_cast<char>(std::toupper(c));
  return channel;
}

Bytes HeadPose() {
  head_pose_t message{};
  message.status = head_pose_t::STATUS_TRACKING;
  message.p_CM_m[0] = 0.25;
  message.p_CM_m[1] = -0.5;
  message.p_CM_m[2] = 1;
  Bytes bytes(static_cast<std::size_t>(message.getEncodedSize()));
  message.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
  return bytes;
}

void WriteLog(const std::vector<Sample>& samples, const char* name) {
  lcm::LogFile log(name, "w");
  if (!log.good()) throw std::runtime_error(std::string(name) + ": cannot be written");
  std::int64_t utime = 1700000000000000;
  for (std::size_t i = 0; i < 100 * samples.size(); ++i) {
    Sample sample = samples[i % samples.size()];
    lcm::LogEvent event{};
    event.timestamp = utime += 10000;
    event.channel = sample.channel;
    event.datalen = static_cast<std::int32_t>(sample.bytes.size());
    event.data = sample.bytes.data();
    if (log.writeEvent(&event) != 0) throw std::runtime_error(std::string(name) + ": disk full?");
  }
}

int Run(const char* url, const char* log_name) {
  const LcmSchema schema = ReadProjectSchema();
  Random random(1);
  std::vector<Sample> samples;
  std::string printed;
  for (const std::string& type : AllTypes<TypeNames>().names) {
    Bytes bytes =
        type == "head_pose_t" ? HeadPose() : RandomWireMessage(schema, type, 3, &random).bytes;
    samples.push_back({ChannelOf(type), std::move(bytes)});
    printed += samples.back().channel + " " + type + "\n";
  }
  WriteLog(samples, log_name);
  std::fputs(printed.c_str(), stdout);
  std::fflush(stdout);
  lcm::LCM lcm(url);
  if (!lcm.good()) {
    std::fprintf(stderr, "publish_every_type: cannot open %s: is there a multicast route?\n", url);
    return 1;
  }
  for (int i = 0; i < 600; ++i) {
    for (const Sample& s : samples) {
      if (lcm.publish(s.channel, s.bytes.data(), static_cast<unsigned>(s.bytes.size())) != 0)
        return 1;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  return 0;
}

}  // namespace
}  // namespace visavis

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "usage: publish_every_type LCM_URL LOG\n");
    return 2;
  }
  try {
    return visavis::Run(argv[1], argv[2]);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "publish_every_type: %s\n", e.what());
    return 1;
  }
}
