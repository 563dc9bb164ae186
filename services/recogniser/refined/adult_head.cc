#include "services/recogniser/refined/adult_head.h"

#include <cmath>
#include <cstdlib>

#include "common/core/check.h"

namespace visavis {

extern const char* const kAdultHeadText;  // adult_head.dat

namespace {

class Reader {
 public:
  explicit Reader(const char* text) : text_(text) {}
  double Number() {
    char* end = nullptr;
    const double x = std::strtod(text_, &end);
    VISAVIS_THROW_UNLESS(end != text_, text_);
    text_ = end;
    return x;
  }
  float Scaled(double unit) { return static_cast<float>(unit * Number()); }
  int Count() { return static_cast<int>(Number()); }

 private:
  const char* text_;
};

AdultHead Read() {
  Reader in(kAdultHeadText);
  HeadTable table;
  const int n = in.Count();
  for (int i = 0; i < n; ++i) {
    table.radii_m.push_back(in.Scaled(1e-5));
    table.sigma_m.push_back(in.Scaled(1e-5));
    table.hair_side_m.push_back(in.Scaled(1e-4));
  }
  AdultLooks looks;
  looks.columns = in.Count();
  looks.rows = in.Count();
  looks.left_m = in.Scaled(1);
  looks.top_m = in.Scaled(1);
  looks.step_m = in.Scaled(1);
  looks.cells.resize(static_cast<std::size_t>(looks.columns * looks.rows));
  for (std::size_t band = 0; band < kNumBands; ++band) {
    for (AdultLooks::Place& cell : looks.cells) {
      cell.mean[band] = in.Scaled(0.01);
      const float doubt = in.Scaled(0.01);
      if (band == kFineBand) {
        cell.doubt = doubt;
        cell.known = doubt >= 0;
      }
    }
  }
  for (std::size_t k = 0; k < AdultLooks::kModes; ++k) {
    for (AdultLooks::Place& cell : looks.cells) cell.modes[k] = in.Scaled(0.01);
  }
  const int in_region = in.Count(), modes = in.Count();
  Eigen::MatrixXd shape_modes = Eigen::MatrixXd::Zero(n, modes);
  for (int i = 0; i < in_region; ++i) {
    const int vertex = in.Count();
    VISAVIS_THROW_UNLESS(vertex >= 0 && vertex < n, vertex);
    for (int k = 0; k < modes; ++k) shape_modes(vertex, k) = 1e-5 * in.Number();
  }
  return {HeadSurface(HeadShape{}, table), shape_modes, looks};
}

}  // namespace

AdultLooks::Place AdultLooks::At(float x_m, float y_m) const {
  Place place;
  const float u = (x_m - left_m) / step_m, v = (y_m - top_m) / step_m;
  const int i = static_cast<int>(std::floor(u)), j = static_cast<int>(std::floor(v));
  if (i < 0 || j < 0 || i + 1 >= columns || j + 1 >= rows) return place;
  place.known = true;
  place.doubt = 0;
  for (int k = 0; k < 4; ++k) {
    const int di = k % 2, dj = k / 2;
    const float a = di == 1 ? u - static_cast<float>(i) : 1 - (u - static_cast<float>(i));
    const float b = dj == 1 ? v - static_cast<float>(j) : 1 - (v - static_cast<float>(j));
    const Place& cell = cells[static_cast<std::size_t>((j + dj) * columns + i + di)];
    if (!cell.known) return Place{};
    const float w = a * b;
    for (std::size_t band = 0; band < kNumBands; ++band) place.mean[band] += w * cell.mean[band];
    place.doubt += w * cell.doubt;
    for (std::size_t m = 0; m < kModes; ++m) place.modes[m] += w * cell.modes[m];
  }
  return place;
}

const AdultHead& TheAdult() {
  static const AdultHead adult = Read();
  return adult;
}

}  // namespace visavis
