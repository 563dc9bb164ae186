#include "tests/people/trained_head.h"

#include <cmath>
#include <string>

namespace visavis {
namespace {

constexpr std::size_t kColumnLimit = 100;

/// Numbers with blanks between, in lines of at most kColumnLimit characters.
class Lines {
 public:
  explicit Lines(std::ostream* out) : out_(*out) {}
  void Add(const std::string& word) {
    if (length_ > 0 && length_ + 1 + word.size() > kColumnLimit) End();
    if (length_ > 0) out_ << ' ';
    out_ << word;
    length_ += word.size() + (length_ > 0 ? 1 : 0);
  }
  void Add(double value, double unit) { Add(std::to_string(std::lround(value / unit))); }
  void End() {
    if (length_ > 0) out_ << '\n';
    length_ = 0;
  }

 private:
  std::ostream& out_;
  std::size_t length_{0};
};

void WriteShape(const ShapeModel& shape, Lines* lines) {
  const HeadTable& table = shape.table;
  lines->Add(std::to_string(table.radii_m.size()));
  lines->End();
  for (std::size_t i = 0; i < table.radii_m.size(); ++i) {
    lines->Add(static_cast<double>(table.radii_m[i]), 1e-5);
    lines->Add(static_cast<double>(table.sigma_m[i]), 1e-5);
    lines->Add(static_cast<double>(table.hair_side_m[i]), 1e-4);
  }
  lines->End();
}

void WriteModes(const ShapeModel& shape, Lines* lines) {
  lines->Add(std::to_string(shape.region.size()));
  lines->Add(std::to_string(shape.modes_m.cols()));
  lines->End();
  for (std::size_t i = 0; i < shape.region.size(); ++i) {
    lines->Add(std::to_string(shape.region[i]));
    for (Eigen::Index k = 0; k < shape.modes_m.cols(); ++k)
      lines->Add(shape.modes_m(static_cast<Eigen::Index>(i), k), 1e-5);
  }
  lines->End();
}

std::string Text(float metres) {
  std::string text = std::to_string(static_cast<double>(std::lround(metres * 1e4f)) * 1e-4);
  text.erase(text.find_last_not_of('0') + 1);
  return text;
}

void WriteLooks(const LooksModel& looks, Lines* lines) {
  const LooksGrid& grid = looks.grid;
  for (const int count : {grid.columns, grid.rows}) lines->Add(std::to_string(count));
  for (const float metres : {grid.left_m, grid.top_m, grid.step_m}) lines->Add(Text(metres));
  lines->End();
  for (std::size_t band = 0; band < kNumBands; ++band) {
    for (int cell = 0; cell < grid.size(); ++cell) {
      lines->Add(looks.mean[band][cell], 0.01);
      lines->Add(looks.known[static_cast<std::size_t>(cell)] ? looks.doubt[band][cell] : -0.01,
                 0.01);
    }
    lines->End();
  }
  for (Eigen::Index k = 0; k < looks.modes.cols(); ++k) {
    for (int cell = 0; cell < grid.size(); ++cell) lines->Add(looks.modes(cell, k), 0.01);
    lines->End();
  }
}

}  // namespace

void WriteHead(const TrainedHead& head, std::ostream* out) {
  Lines lines(out);
  WriteShape(head.shape, &lines);
  WriteLooks(head.looks, &lines);
  WriteModes(head.shape, &lines);
}

}  // namespace visavis
