#include "services/log_tool/sequence_tables.h"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <map>
#include <stdexcept>

namespace visavis {
namespace {

constexpr std::int64_t kMaxCameraGapUs = 100'000;

/// Writes rows of cells to a file that appears with its first row.
class CsvWriter {
 public:
  CsvWriter(std::string path, std::string header)
      : path_(std::move(path)), header_(std::move(header)) {}

  CsvWriter& Text(const std::string& cell) {
    if (num_cells_++ > 0) row_ += ',';
    row_ += cell;
    return *this;
  }
  CsvWriter& Count(std::int64_t value) { return Text(std::to_string(value)); }
  /// The shortest text that reads as the same double; empty for NaN.
  CsvWriter& Number(double value) {
    if (!std::isfinite(value)) return Text("");
    char text[32];
    return Text(std::string(text, std::to_chars(text, text + sizeof text, value).ptr));
  }
  /// Microseconds as seconds with all six decimals.
  CsvWriter& Time(std::int64_t utime_us) {
    char text[32];
    const int n = std::snprintf(text, sizeof text, "%lld.%06lld",
                                static_cast<long long>(utime_us / 1'000'000),
                                static_cast<long long>(utime_us % 1'000'000));
    return Text(std::string(text, static_cast<std::size_t>(n)));
  }
  /// x, y, z, qw, qx, qy, qz.
  CsvWriter& Pose(const RigidTransform& X) {
    const Eigen::Quaterniond q = CanonicalQuaternion(X.linear());
    for (int i = 0; i < 3; ++i) Number(X.translation()[i]);
    return Number(q.w()).Number(q.x()).Number(q.y()).Number(q.z());
  }
  void EndRow() {
    if (num_rows_++ == 0) {
      file_.open(path_, std::ios::binary);
      file_ << header_ << '\n';
    }
    file_ << row_ << '\n';
    row_.clear();
    num_cells_ = 0;
  }
  /// @return the number of rows.
  std::int64_t Close() {
    if (num_rows_ > 0) {
      file_.close();
      if (!file_) throw std::runtime_error(path_ + ": " + std::strerror(errno));
    }
    return num_rows_;
  }

 private:
  const std::string path_, header_;
  std::ofstream file_;
  std::string row_;
  int num_cells_{0};
  std::int64_t num_rows_{0};
};

constexpr char kPoseHeader[] = "frame,time_s,x_m,y_m,z_m,qw,qx,qy,qz";

constexpr char kHeadPoseHeader[] =
    "frame,time_s,seq,status,x_m,y_m,z_m,qw,qx,qy,qz,Phi_deg,theta_deg,psi_deg,"
    "sigma_x_m,sigma_y_m,sigma_z_m,sigma_rx_deg,sigma_ry_deg,sigma_rz_deg,"
    "xw_m,yw_m,zw_m,qww,qxw,qyw,qzw,fitness,fitness_site,fitness_color,fitness_feat,"
    "generations,evaluations,feedforward,feedforward_source,feedforward_extrapolated,"
    "budget_reduced";

std::string Word(int value, std::initializer_list<const char*> words) {
  return value >= 0 && value < static_cast<int>(words.size()) ? words.begin()[value]
                                                              : std::to_string(value);
}

void WriteHeadPose(const head_pose_t& m, CsvWriter* csv) {
  constexpr double kDegrees = 180 / M_PI;
  const double nan = std::nan("");
  csv->Time(m.utime).Count(m.seq).Text(Word(m.status, {"SEARCHING", "TRACKING", "LOST"}));
  for (const double v : m.p_CM_m) csv->Number(v);
  for (const double v : m.q_CM_wxyz) csv->Number(v);
  for (const double v : m.euler_zyx_CM_rad) csv->Number(v * kDegrees);
  for (std::size_t i = 0; i < 6; ++i)
    csv->Number(std::sqrt(m.covariance[std::size_t{7} * i]) * (i < 3 ? 1 : kDegrees));
  for (const double v : m.p_WM_m) csv->Number(m.has_world_pose ? v : nan);
  for (const double v : m.q_WM_wxyz) csv->Number(m.has_world_pose ? v : nan);
  csv->Number(m.fitness).Number(m.fitness_site).Number(m.fitness_color).Number(m.fitness_feat);
  csv->Count(m.generations).Count(m.evaluations);
  csv->Text(Word(m.feedforward, {"none", "jacobian", "exact"}));
  csv->Text(Word(m.feedforward_source, {"none", "arm", "camera_pose", "missing"}));
  csv->Count(m.feedforward_extrapolated).Count(m.budget_reduced);
}

}  // namespace

std::int64_t WriteFramesCsv(const std::vector<ExportedFrame>& frames, const std::string& path) {
  CsvWriter csv(path, "frame,time_s,left,right");
  for (const auto& f : frames) {
    csv.Count(f.number).Time(f.utime_us).Text(f.left).Text(f.right).EndRow();
  }
  return csv.Close();
}

std::int64_t WriteCameraPoseCsv(const std::vector<ExportedFrame>& frames,
                                const std::vector<StampedPose>& poses, const std::string& path) {
  const PoseTrack track(poses);
  CsvWriter csv(path, kPoseHeader);
  for (const auto& f : frames) {
    const auto X_WC = track.At(f.utime_us, kMaxCameraGapUs);
    if (X_WC) csv.Count(f.number).Time(f.utime_us).Pose(*X_WC).EndRow();
  }
  return csv.Close();
}

std::int64_t WriteTruthCsv(const std::vector<ExportedFrame>& frames,
                           const std::vector<TruthSample>& truth, const std::string& path) {
  std::vector<std::int64_t> utimes_us(frames.size());
  for (std::size_t i = 0; i < frames.size(); ++i) utimes_us[i] = frames[i].utime_us;
  const TruthTrack track(truth, utimes_us);
  CsvWriter csv(path, kPoseHeader);
  for (const auto& f : frames) {
    const auto sample = track.At(f.utime_us);
    if (sample && sample->X_CM) csv.Count(f.number).Time(f.utime_us).Pose(*sample->X_CM).EndRow();
  }
  return csv.Close();
}

std::int64_t WriteArmCsv(const std::vector<arm_state_t>& states, const std::string& path) {
  if (states.empty()) return 0;
  std::string header = "time_s";
  for (const auto& name : states[0].joint_names) header += "," + name;
  CsvWriter csv(path, header);
  std::int64_t last_us = -1;
  for (const auto& state : states) {
    const bool finite = std::all_of(state.joint_position.begin(), state.joint_position.end(),
                                    [](double q) { return std::isfinite(q); });
    if (!finite || state.utime <= last_us || state.joint_names != states[0].joint_names) continue;
    last_us = state.utime;
    csv.Time(state.utime);
    for (const double q : state.joint_position) csv.Number(q);
    csv.EndRow();
  }
  return csv.Close();
}

std::int64_t WriteHeadPoseCsv(const std::vector<ExportedFrame>& frames,
                              const std::vector<head_pose_t>& poses, const std::string& path) {
  std::map<std::int64_t, std::int64_t> number_at;
  for (const auto& f : frames) number_at[f.utime_us] = f.number;
  CsvWriter csv(path, kHeadPoseHeader);
  for (const auto& pose : poses) {
    const auto frame = number_at.find(pose.utime);
    csv.Text(frame == number_at.end() ? "" : std::to_string(frame->second));
    WriteHeadPose(pose, &csv);
    csv.EndRow();
  }
  return csv.Close();
}

}  // namespace visavis
