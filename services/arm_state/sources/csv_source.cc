#include "services/arm_state/sources/csv_source.h"

#include <charconv>
#include <cmath>
#include <stdexcept>
#include <string_view>

#include "common/csv/csv_table.h"

namespace visavis {
namespace {

constexpr double kMaxTimeS = 9e12;  // below 2^63 microseconds

bool IsNumber(std::string_view text) {
  double value;
  return std::from_chars(text.data(), text.data() + text.size(), value).ec == std::errc();
}

std::vector<int> JointColumns(const CsvTable& table) {
  std::vector<int> columns;
  for (int i = 0; i < static_cast<int>(table.columns().size()); ++i) {
    const std::string& name = table.columns()[i];
    if (name != "time_s" && name != "frame" && !name.empty() && IsNumber(table.Text(0, i)))
      columns.push_back(i);
  }
  if (columns.empty())
    throw std::invalid_argument(table.path() + ":1: no joints: must have a column per joint");
  return columns;
}

std::int64_t TimeOf(const CsvTable& table, int row, int column) {
  const double time_s = table.Number(row, column);
  if (!(time_s >= 0 && time_s < kMaxTimeS)) table.Refuse(row, column, "must be >= 0");
  return std::llround(time_s * 1e6);
}

}  // namespace

CsvSource::CsvSource(const SourceContext& context) : context_(context) {
  const CsvTable table(context.file);
  if (table.num_rows() == 0) throw std::invalid_argument(context.file + ": must have rows");
  const int time = table.Column("time_s");
  const std::vector<int> columns = JointColumns(table);
  for (const int column : columns) reading_.names.push_back(table.columns()[column]);
  for (int row = 0; row < table.num_rows(); ++row) {
    const std::int64_t utime_us = TimeOf(table, row, time);
    if (row > 0 && utime_us <= utimes_us_.back())
      table.Refuse(row, time, "must be later than the row before, by 1 us at least");
    utimes_us_.push_back(utime_us);
    for (const int column : columns) positions_.push_back(table.Number(row, column));
  }
  if (!context.live) return;
  const std::int64_t shift_us = context.clock->NowUs() - utimes_us_.front();
  for (std::int64_t& utime_us : utimes_us_) utime_us += shift_us;
}

std::int64_t CsvSource::next_wake_us() const { return finished() ? kNever : utimes_us_[next_]; }

void CsvSource::Wake() {
  const auto num_joints = static_cast<std::ptrdiff_t>(reading_.names.size());
  while (!finished() && utimes_us_[next_] <= context_.clock->NowUs()) {
    const auto row = positions_.begin() + static_cast<std::ptrdiff_t>(next_) * num_joints;
    reading_.utime_us = utimes_us_[next_++];
    reading_.position.assign(row, row + num_joints);
    context_.take(reading_);
  }
}

}  // namespace visavis
