#pragma once

#include <cstdint>
#include <deque>
#include <string>
#include <string_view>
#include <vector>

namespace visavis {

/// A CSV file with one header line, held whole. Accepted: LF or CRLF, a byte order mark, blanks
/// round cells, blank lines, cells in double quotes (without line breaks), columns in any order.
///
/// Every complaint is one line "FILE:LINE: COLUMN: VALUE: RULE".
class CsvTable {
 public:
  /// @throws std::invalid_argument for a file that cannot be read, has no header, names a column
  /// twice, or has a row with another number of cells than its header.
  explicit CsvTable(const std::string& path);
  CsvTable(const CsvTable&) = delete;
  CsvTable& operator=(const CsvTable&) = delete;

  const std::string& path() const { return path_; }
  int num_rows() const { return static_cast<int>(lines_.size()); }
  const std::vector<std::string>& columns() const { return columns_; }

  /// Index of a column. @throws std::invalid_argument where there is none of this name.
  int Column(const std::string& name) const;
  bool HasColumn(const std::string& name) const;

  std::string_view Text(int row, int column) const;
  /// @throws std::invalid_argument unless the cell is a finite decimal number.
  double Number(int row, int column) const;
  /// @throws std::invalid_argument unless the cell is a whole number >= 0.
  std::int64_t Count(int row, int column) const;

  /// "FILE:LINE" of a row.
  std::string PlaceOf(int row) const;

  /// Refuses a cell. @throws std::invalid_argument "FILE:LINE: COLUMN: VALUE: @p rule", always.
  [[noreturn]] void Refuse(int row, int column, const std::string& rule) const;

 private:
  std::string_view Cell(std::string_view raw);
  void SplitLine(std::string_view line, std::vector<std::string_view>* cells);

  std::string path_;
  std::string text_;
  std::deque<std::string> unquoted_;  ///< cells that needed more than cutting out of the text
  std::vector<std::string> columns_;
  std::vector<std::string_view> cells_;  ///< row by row
  std::vector<int> lines_;               ///< line in the file of each row, from 1
};

}  // namespace visavis
