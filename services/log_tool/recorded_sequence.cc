#include "services/log_tool/recorded_sequence.h"

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <map>
#include <stdexcept>

#include "common/csv/csv_table.h"
#include "common/kinematics/arm.h"
#include "common/rigs/rig_file.h"

namespace visavis {
namespace {

namespace fs = std::filesystem;

constexpr double kMaxTime_s = 9e12;                // in us it still is an int64_t
constexpr std::int64_t kMaxTimeMismatchUs = 1000;  // other files may print fewer digits

/// Rows of a file must follow each other in time.
class RowTimes {
 public:
  explicit RowTimes(const CsvTable& table) : table_(table), column_(table.Column("time_s")) {}

  /// [us] @throws std::invalid_argument where the row is not later than the one before.
  std::int64_t Next(int row) {
    const double time_s = table_.Number(row, column_);
    if (!(time_s >= 0 && time_s <= kMaxTime_s)) {
      table_.Refuse(row, column_, "must be 0 to 9e12 s");
    }
    const std::int64_t utime_us = std::llround(time_s * 1e6);
    if (utime_us <= last_us_) {
      table_.Refuse(row, column_, "must be later than the row before, by 1e-6 s at least");
    }
    return last_us_ = utime_us;
  }

  /// As Next(), for a row about a frame: the frame's time, which the row must repeat.
  std::int64_t NextOf(const SequenceFrame& frame, int row) {
    if (std::llabs(Next(row) - frame.utime_us) > kMaxTimeMismatchUs) {
      table_.Refuse(row, column_,
                    "must be the time of frame " + std::to_string(frame.number) +
                        " in frames.csv, within 0.001 s");
    }
    return last_us_ = frame.utime_us;
  }

 private:
  const CsvTable& table_;
  const int column_;
  std::int64_t last_us_{-1};
};

using FrameIndex = std::map<std::int64_t, std::size_t>;

std::vector<SequenceFrame> ReadFrames(const fs::path& folder) {
  const CsvTable table((folder / "frames.csv").string());
  const int frame = table.Column("frame");
  const int pictures[] = {table.Column("left"), table.Column("right")};
  RowTimes times(table);
  FrameIndex seen;
  std::vector<SequenceFrame> frames;
  for (int row = 0; row < table.num_rows(); ++row) {
    SequenceFrame f;
    f.number = table.Count(row, frame);
    if (!seen.emplace(f.number, frames.size()).second) {
      table.Refuse(row, frame, "must name a frame once");
    }
    f.utime_us = times.Next(row);
    f.place = table.PlaceOf(row);
    for (const int column : pictures) {
      const fs::path file = folder / table.Text(row, column);
      std::error_code error;
      if (table.Text(row, column).empty() || !fs::is_regular_file(file, error)) {
        table.Refuse(row, column, "must be a picture file in the folder");
      }
      (column == pictures[0] ? f.left : f.right) = file.string();
    }
    frames.push_back(std::move(f));
  }
  if (frames.empty()) throw std::invalid_argument(table.path() + ":2: must have a row a frame");
  return frames;
}

/// Columns x_m, y_m, z_m, qw, qx, qy, qz.
class PoseColumns {
 public:
  explicit PoseColumns(const CsvTable& table) : table_(table) {
    const char* names[] = {"x_m", "y_m", "z_m", "qw", "qx", "qy", "qz"};
    for (int i = 0; i < 7; ++i) columns_[i] = table.Column(names[i]);
  }

  RigidTransform Read(int row) const {
    double v[7];
    for (int i = 0; i < 7; ++i) {
      v[i] = table_.Number(row, columns_[i]);
      if (i < 3 && std::abs(v[i]) > 1e6) table_.Refuse(row, columns_[i], "must be within 1e6 m");
    }
    const Eigen::Quaterniond q(v[3], v[4], v[5], v[6]);
    if (std::abs(q.norm() - 1) > 1e-3) {
      table_.Refuse(
          row, columns_[3],
          "qw, qx, qy, qz have norm " + std::to_string(q.norm()) + ", must be 1 within 0.001");
    }
    return MakeTransform(q, {v[0], v[1], v[2]});
  }

 private:
  const CsvTable& table_;
  int columns_[7];
};

/// Calls @p add with the index of the frame and the pose of each row.
template <typename Add>
void ReadFramePoses(const fs::path& path, const std::vector<SequenceFrame>& frames, Add add) {
  FrameIndex index;
  for (std::size_t i = 0; i < frames.size(); ++i) index[frames[i].number] = i;
  const CsvTable table(path.string());
  const int frame = table.Column("frame");
  const PoseColumns pose(table);
  RowTimes times(table);
  for (int row = 0; row < table.num_rows(); ++row) {
    const auto found = index.find(table.Count(row, frame));
    if (found == index.end()) table.Refuse(row, frame, "must be a frame of frames.csv");
    times.NextOf(frames[found->second], row);
    add(found->second, pose.Read(row));
  }
}

/// Names of the columns that hold joints: those of the chain where the rig describes its arm.
std::vector<std::string> JointColumns(const CsvTable& table, const RigDescription& rig,
                                      const std::string& rig_file) {
  std::vector<std::string> names;
  if (rig.arm) {
    try {
      const Arm arm(rig.arm->urdf, rig.arm->base_link, rig.arm->tip_link);
      for (const ArmJoint& joint : arm.joints()) names.push_back(joint.name);
    } catch (const std::invalid_argument& e) {
      throw std::invalid_argument(rig_file + ": arm: " + e.what());
    }
    for (const auto& name : names) table.Column(name);
    return names;
  }
  for (const auto& name : table.columns()) {
    if (name != "time_s" && name != "frame" && !name.empty()) names.push_back(name);
  }
  if (names.empty() || names.size() > static_cast<std::size_t>(kMaxArmJoints)) {
    throw std::invalid_argument(table.path() + ":1: " + std::to_string(names.size()) +
                                " joints: must be 1 to " + std::to_string(kMaxArmJoints));
  }
  return names;
}

/// Slopes between the neighbours (one-sided at the ends; 0 for a single row).
void SetVelocities(std::vector<SequenceArmState>* states) {
  for (std::size_t i = 0; i < states->size(); ++i) {
    const SequenceArmState& before = (*states)[i == 0 ? 0 : i - 1];
    const SequenceArmState& after = (*states)[i + 1 == states->size() ? i : i + 1];
    const double dt_s = 1e-6 * static_cast<double>(after.utime_us - before.utime_us);
    std::vector<double>& velocities = (*states)[i].velocities;
    velocities.assign(before.positions.size(), 0.0);
    for (std::size_t k = 0; dt_s > 0 && k < velocities.size(); ++k) {
      velocities[k] = (after.positions[k] - before.positions[k]) / dt_s;
    }
  }
}

void ReadArm(const fs::path& path, const std::string& rig_file, RecordedSequence* sequence) {
  const CsvTable table(path.string());
  sequence->joint_names = JointColumns(table, sequence->rig, rig_file);
  std::vector<int> columns;
  for (const auto& name : sequence->joint_names) columns.push_back(table.Column(name));
  RowTimes times(table);
  for (int row = 0; row < table.num_rows(); ++row) {
    SequenceArmState state;
    state.utime_us = times.Next(row);
    for (const int column : columns) state.positions.push_back(table.Number(row, column));
    sequence->arm_states.push_back(std::move(state));
  }
  SetVelocities(&sequence->arm_states);
}

}  // namespace

RecordedSequence ReadRecordedSequence(const std::string& folder) {
  const fs::path path(folder);
  if (!fs::is_directory(path)) throw std::invalid_argument(folder + ": must be a folder");
  RecordedSequence sequence;
  const std::string rig_file = (path / "rig.yaml").string();
  sequence.rig = LoadRigFile(rig_file);
  sequence.frames = ReadFrames(path);
  const auto& frames = sequence.frames;
  if (fs::exists(path / "camera_pose.csv")) {
    ReadFramePoses(path / "camera_pose.csv", frames, [&](std::size_t i, const RigidTransform& X) {
      sequence.camera_poses.push_back({frames[i].utime_us, X});
    });
  }
  if (fs::exists(path / "arm.csv")) ReadArm(path / "arm.csv", rig_file, &sequence);
  if (fs::exists(path / "truth.csv")) {
    ReadFramePoses(path / "truth.csv", frames, [&](std::size_t i, const RigidTransform& X) {
      sequence.truth.push_back({i, X});
    });
  }
  return sequence;
}

}  // namespace visavis
