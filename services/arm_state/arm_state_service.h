#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "common/rigs/rig_description.h"
#include "common/service/offline_loop.h"
#include "common/service/service.h"
#include "common/service/service_flags.h"
#include "services/arm_state/arm_state_config.h"
#include "services/arm_state/sources/arm_source.h"
#include "services/arm_state/state_builder.h"
#include "visavis/arm_state_t.hpp"
#include "visavis/stereo_rig_t.hpp"

namespace visavis {

/// A driver's joint states in, checked against the arm's URDF; ARM_STATE out.
class ArmStateService final : public Service {
 public:
  static ServiceTraits Traits();
  /// What a replay leaves out of the new log: earlier arm states.
  static Replay::Filter ReplayFilter(const ArmStateConfig& config, const std::string& prefix);

  /// @throws std::invalid_argument for a rig_file or csv_file that cannot be used.
  ArmStateService(const ArmStateConfig& config, const ServiceContext& context);

  std::int64_t next_wake_us() const override;
  void Wake() override { source_->Wake(); }
  bool finished() const override { return source_->finished(); }
  void UpdateStatus() override;

 private:
  void SetArm(const ArmDescription& arm);
  void OnRig(const stereo_rig_t& message);
  void OnReading(const JointReading& reading);
  void UpdateConditions(std::int64_t now_us);
  /// How the source is called in the status: its channel or file.
  std::string Place() const;

  const ArmStateConfig config_;
  const ServiceContext context_;
  std::optional<ArmDescription> arm_;
  std::unique_ptr<StateBuilder> states_;  ///< none until there is an arm
  std::unique_ptr<ArmSource> source_;
  arm_state_t message_{};

  std::int64_t readings_{0}, last_arrival_us_{-1}, newest_utime_us_{-1};
  std::int64_t readings_before_{0}, last_status_us_{-1};  // at the status before
};

}  // namespace visavis
