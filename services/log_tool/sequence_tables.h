#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/recording/log_contents.h"

namespace visavis {

/// A frame of an exported sequence.
struct ExportedFrame {
  std::int64_t number{0};
  std::int64_t utime_us{0};
  std::string left, right;  ///< picture files, relative to the folder; empty: log without images
};

// Each writes one file of the folder and returns its number of rows; without rows there is no file.
// All throw std::runtime_error naming a file that cannot be written.

std::int64_t WriteFramesCsv(const std::vector<ExportedFrame>& frames, const std::string& path);

/// Camera poses at the frames' times, interpolated between poses at most 0.1 s apart.
std::int64_t WriteCameraPoseCsv(const std::vector<ExportedFrame>& frames,
                                const std::vector<StampedPose>& poses, const std::string& path);

/// Truth at the frames' times; no row where it is unknown or no head is there.
std::int64_t WriteTruthCsv(const std::vector<ExportedFrame>& frames,
                           const std::vector<TruthSample>& truth, const std::string& path);

/// Joint positions. States that are not finite, not later than the one before, or of other joints
/// than the first are left out.
std::int64_t WriteArmCsv(const std::vector<arm_state_t>& states, const std::string& path);

/// One row a HEAD_POSE: time, pose, angles in deg, standard deviations, pose in the world, fitness,
/// effort and feedforward. Cells of what is unknown are empty; `frame` is empty where no frame has
/// this time.
std::int64_t WriteHeadPoseCsv(const std::vector<ExportedFrame>& frames,
                              const std::vector<head_pose_t>& poses, const std::string& path);

}  // namespace visavis
