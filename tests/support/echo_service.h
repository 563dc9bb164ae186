#pragma once

#include <cstdint>
#include <string>

#include "common/config/config_error.h"
#include "common/config/rule.h"
#include "common/service/run_service.h"
#include "visavis/head_pose_t.hpp"

namespace visavis {

struct EchoConfig {
  template <typename A>
  void Serialize(A* a) {
    a->Visit("gain", &gain, InRange(1, 100));
    a->Visit("input", &input, ChannelName());
    a->Visit("output", &output, ChannelName());
    a->Visit("fail_on_seq", &fail_on_seq);
    a->Visit("period_ms", &period_ms, InRange(0, 100000, "ms"));
    a->Visit("num_wakes", &num_wakes, InRange(0, 1000000));
    a->Visit("num_nudges", &num_nudges, InRange(0, 1000000));
  }
  void ValidateOrThrow() const {
    if (input == output) throw FieldError("output", output, "must differ from input");
  }

  int gain{1};
  std::string input{"ECHO_IN"}, output{"ECHO_OUT"};
  int fail_on_seq{-1};  ///< the input with this seq makes the handler throw; so does that wake
  int period_ms{0};     ///< of the wakes; 0: none
  int num_wakes{0};     ///< finished after so many; 0: never
  int num_nudges{0};    ///< wakes that its file descriptor asks for
};

/// The smallest whole service, for tests of what carries services. It answers each input with its
/// seq times gain on the output, and publishes on ECHO_WAKE (seq: which wake) and ECHO_FINISHED.
class EchoService final : public Service {
 public:
  EchoService(const EchoConfig& config, const ServiceContext& context);
  ~EchoService() override;

  static ServiceTraits Traits();
  /// Its own output is ECHO_*, but for the input; images are what comes on IMAGES.
  static Replay::Filter ReplayFilter(const EchoConfig& config, const std::string& prefix);

  std::int64_t next_wake_us() const override { return next_wake_us_; }
  int wake_fd() const override { return nudges_fd_; }
  void Wake() override;
  bool finished() const override;
  void UpdateStatus() override;
  void Finish() override;

 private:
  void Handle(const head_pose_t& message);
  void Publish(const std::string& channel, std::int64_t seq);

  const EchoConfig config_;
  const ServiceContext context_;
  const int nudges_fd_;  // readable while there are nudges left; -1: there were none
  std::int64_t next_wake_us_;
  std::int64_t num_wakes_{0}, num_finishes_{0};
};

}  // namespace visavis
