#include "common/csv/csv_table.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <iterator>
#include <stdexcept>

namespace visavis {
namespace {

std::string_view Trim(std::string_view text) {
  const auto begin = text.find_first_not_of(" \t\r");
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(" \t\r") - begin + 1);
}

/// Cells longer than this are shortened in complaints.
constexpr std::size_t kMaxShown = 60;

template <typename T>
bool Parse(std::string_view text, T* value) {
  if (!text.empty() && text[0] == '+') text.remove_prefix(1);
  const auto result = std::from_chars(text.data(), text.data() + text.size(), *value);
  return result.ec == std::errc() && result.ptr == text.data() + text.size();
}

}  // namespace

CsvTable::CsvTable(const std::string& path) : path_(path) {
  std::ifstream file(path, std::ios::binary);
  // Reading a folder fails at the first byte, not when it is opened.
  if (!file || file.peek() == std::ifstream::traits_type::eof()) {
    throw std::invalid_argument(path + ": cannot be read, or is empty");
  }
  text_.assign(std::istreambuf_iterator<char>(file), {});
  std::string_view rest = text_;
  if (rest.substr(0, 3) == "\xEF\xBB\xBF") rest.remove_prefix(3);

  std::vector<std::string_view> cells;
  for (int line = 1; !rest.empty(); ++line) {
    const auto end = std::min(rest.find('\n'), rest.size());
    const std::string_view text = Trim(rest.substr(0, end));
    rest.remove_prefix(std::min(end + 1, rest.size()));
    if (text.empty()) continue;
    SplitLine(text, &cells);
    const std::string place = path + ":" + std::to_string(line) + ": ";
    if (columns_.empty()) {
      for (const auto& cell : cells) {
        const std::string name(cell);
        if (!name.empty() && HasColumn(name)) {
          throw std::invalid_argument(place + name + ": must name a column once");
        }
        columns_.push_back(name);
      }
      continue;
    }
    if (cells.size() != columns_.size()) {
      throw std::invalid_argument(place + "row of " + std::to_string(cells.size()) +
                                  " cells: must have " + std::to_string(columns_.size()) +
                                  " as the header");
    }
    cells_.insert(cells_.end(), cells.begin(), cells.end());
    lines_.push_back(line);
  }
  if (columns_.empty()) throw std::invalid_argument(path + ":1: must name its columns");
}

void CsvTable::SplitLine(std::string_view line, std::vector<std::string_view>* cells) {
  cells->clear();
  bool quoted = false;
  std::size_t begin = 0;
  for (std::size_t i = 0; i <= line.size(); ++i) {
    if (i < line.size() && line[i] == '"') quoted = !quoted;
    if (i < line.size() && (quoted || line[i] != ',')) continue;
    cells->push_back(Cell(line.substr(begin, i - begin)));
    begin = i + 1;
  }
}

std::string_view CsvTable::Cell(std::string_view raw) {
  const std::string_view cell = Trim(raw);
  if (cell.size() < 2 || cell.front() != '"' || cell.back() != '"') return cell;
  std::string& text = unquoted_.emplace_back();
  for (std::size_t i = 1; i + 1 < cell.size(); ++i) {
    text += cell[i];
    if (cell[i] == '"' && cell[i + 1] == '"') ++i;  // "" stands for "
  }
  return text;
}

bool CsvTable::HasColumn(const std::string& name) const {
  return std::find(columns_.begin(), columns_.end(), name) != columns_.end();
}

int CsvTable::Column(const std::string& name) const {
  const auto found = std::find(columns_.begin(), columns_.end(), name);
  if (found == columns_.end()) {
    std::string header;
    for (const auto& column : columns_) header += (header.empty() ? "" : ",") + column;
    throw std::invalid_argument(path_ + ":1: " + header.substr(0, 200) + ": must have a column '" +
                                name + "'");
  }
  return static_cast<int>(found - columns_.begin());
}

std::string_view CsvTable::Text(int row, int column) const {
  return cells_.at(static_cast<std::size_t>(row) * columns_.size() +
                   static_cast<std::size_t>(column));
}

double CsvTable::Number(int row, int column) const {
  double value = 0;
  if (!Parse(Text(row, column), &value) || !std::isfinite(value)) {
    Refuse(row, column, "must be a finite number");
  }
  return value;
}

std::int64_t CsvTable::Count(int row, int column) const {
  std::int64_t value = 0;
  if (!Parse(Text(row, column), &value) || value < 0) {
    Refuse(row, column, "must be a whole number >= 0");
  }
  return value;
}

std::string CsvTable::PlaceOf(int row) const {
  return path_ + ":" + std::to_string(lines_.at(static_cast<std::size_t>(row)));
}

void CsvTable::Refuse(int row, int column, const std::string& rule) const {
  const std::string_view cell = Text(row, column);
  std::string shown = cell.empty() ? "empty" : std::string(cell.substr(0, kMaxShown));
  if (cell.size() > kMaxShown) shown += "...";
  throw std::invalid_argument(PlaceOf(row) + ": " + columns_.at(static_cast<std::size_t>(column)) +
                              ": " + shown + ": " + rule);
}

}  // namespace visavis
