#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "common/eventlog/event_log_writer.h"
#include "common/geometry/head_angles.h"
#include "visavis/head_pose_t.hpp"

namespace visavis {

/// Writes a log of a recogniser's run whose errors a test chooses.
class RunLog {
 public:
  static constexpr std::int8_t kSearching = head_pose_t::STATUS_SEARCHING;
  static constexpr std::int8_t kTracking = head_pose_t::STATUS_TRACKING;
  static constexpr std::int8_t kLost = head_pose_t::STATUS_LOST;

  explicit RunLog(const std::string& path);

  /// Truth at @p utime_us; none: no head is there. @p X_WC where the truth tells its world pose.
  void Truth(std::int64_t utime_us, const std::optional<RigidTransform>& X_CM,
             const std::optional<RigidTransform>& X_WC = std::nullopt);
  void Estimate(std::int64_t utime_us, std::int8_t status,
                const std::optional<RigidTransform>& X_CM);
  void CameraPose(std::int64_t utime_us, const RigidTransform& X_WC);
  void Latency(std::int64_t utime_us, double latency_ms);
  /// Truth, and an estimate that errs by @p error: [m] subtracted from the position, and angles
  /// [rad] Phi, theta, psi turned about the head's own axes (so these are Eqs. 33 to 35).
  void Frame(std::int64_t utime_us, std::int8_t status, const RigidTransform& X_CM,
             const Vector6d& error = Vector6d::Zero());
  void Close() { writer_.Close(); }

 private:
  EventLogWriter writer_;
};

/// X_CM with these phi: m and rad.
inline RigidTransform Pose(double x, double y, double z, double Phi = 0, double theta = 0,
                           double psi = 0) {
  Vector6d phi;
  phi << x, y, z, Phi, theta, psi;
  return TransformFromPhi(phi);
}

}  // namespace visavis
