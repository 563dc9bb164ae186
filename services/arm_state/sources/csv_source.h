#pragma once

#include <cstdint>
#include <vector>

#include "services/arm_state/sources/arm_source.h"

namespace visavis {

/// Plays an arm.csv: time_s, then a column per joint, named (rad or m). Columns without numbers and
/// the column `frame` are left out. Live, the first row comes at once and the others at their
/// distances; in a replay time_s is the log's time. It has no velocities.
class CsvSource final : public ArmSource {
 public:
  /// Reads the whole file. @throws std::invalid_argument naming file, line, column, value and rule.
  explicit CsvSource(const SourceContext& context);

  std::int64_t next_wake_us() const override;
  /// Gives every row that is due.
  void Wake() override;
  bool finished() const override { return next_ == utimes_us_.size(); }

 private:
  const SourceContext context_;
  std::vector<std::int64_t> utimes_us_;  ///< of the rows, in the clock's time
  std::vector<double> positions_;        ///< row by row
  JointReading reading_;
  std::size_t next_{0};
};

}  // namespace visavis
