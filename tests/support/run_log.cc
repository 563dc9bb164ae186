#include "tests/support/run_log.h"

#include "common/convert/pose_message.h"
#include "tests/support/log_writing.h"
#include "visavis/recogniser_timing_t.hpp"

namespace visavis {

RunLog::RunLog(const std::string& path) : writer_(path, EventLogWriter::Mode::kCreate) {}

void RunLog::Truth(std::int64_t utime_us, const std::optional<RigidTransform>& X_CM,
                   const std::optional<RigidTransform>& X_WC) {
  head_pose_t message = TruthMessage(utime_us, 0, X_CM ? &*X_CM : nullptr);
  if (X_CM && X_WC) SetWorldPose(*X_WC * *X_CM, &message);
  WriteMessage("HEAD_POSE_TRUTH", message, &writer_);
}

void RunLog::Estimate(std::int64_t utime_us, std::int8_t status,
                      const std::optional<RigidTransform>& X_CM) {
  head_pose_t message = EmptyHeadPose();
  message.utime = utime_us;
  message.status = status;
  if (X_CM) SetPose(*X_CM, &message);
  WriteMessage("HEAD_POSE", message, &writer_);
}

void RunLog::CameraPose(std::int64_t utime_us, const RigidTransform& X_WC) {
  WriteMessage("CAMERA_POSE", ToMessage(X_WC, utime_us), &writer_);
}

void RunLog::Latency(std::int64_t utime_us, double latency_ms) {
  recogniser_timing_t message{};
  message.utime = utime_us;
  message.latency_ms = latency_ms;
  WriteMessage("RECOGNISER_TIMING", message, &writer_);
}

void RunLog::Frame(std::int64_t utime_us, std::int8_t status, const RigidTransform& X_CM,
                   const Vector6d& error) {
  Truth(utime_us, X_CM);
  RigidTransform estimate = X_CM;
  estimate.translation() -= error.head<3>();
  estimate.linear() = X_CM.linear() * RotationFromAngles(error.tail<3>());
  Estimate(utime_us, status, estimate);
}

}  // namespace visavis
