// Sends a head's pose to itself over LCM's in-memory provider and prints what arrived.

#include <cstdio>
#include <lcm/lcm-cpp.hpp>
#include <visavis/head_pose_t.hpp>

namespace {

struct Listener {
  void Hear(const lcm::ReceiveBuffer*, const std::string& channel,
            const visavis::head_pose_t* pose) {
    std::printf("%s %lld TRACKING %d z %.3f m\n", channel.c_str(),
                static_cast<long long>(pose->utime),
                pose->status == visavis::head_pose_t::STATUS_TRACKING, pose->p_CM_m[2]);
  }
};

}  // namespace

int main() {
  lcm::LCM lcm("memq://");
  if (!lcm.good()) return 1;
  Listener listener;
  lcm.subscribe("HEAD_POSE", &Listener::Hear, &listener);
  visavis::head_pose_t pose{};
  pose.utime = 42;
  pose.status = visavis::head_pose_t::STATUS_TRACKING;
  pose.p_CM_m[2] = 1.05;
  if (lcm.publish("HEAD_POSE", &pose) != 0) return 1;
  return lcm.handleTimeout(1000) > 0 ? 0 : 1;
}
