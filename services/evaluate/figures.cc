#include "services/evaluate/figures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <sstream>
#include <vector>

#include "services/evaluate/gnuplot.h"

namespace visavis {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kSessionGap_s = 1;  // drawn between two sessions

// A coordinate of the pose as it is drawn.
struct Coordinate {
  const char* label;
  const char* name;
  double unit;      // SI to drawn
  double band;      // drawn; half-width of the tolerance
  double min_span;  // drawn; the axis shows at least this much
};
constexpr std::array<Coordinate, 6> kCoordinates = {{{"x [mm]", "x", 1e3, 15, 40},
                                                     {"y [mm]", "y", 1e3, 15, 40},
                                                     {"z [mm]", "z", 1e3, 15, 40},
                                                     {"Φ [deg]", "Φ", 180 / M_PI, 5, 12},
                                                     {"θ [deg]", "θ", 180 / M_PI, 5, 12},
                                                     {"ψ [deg]", "ψ", 180 / M_PI, 5, 12}}};

using Values = std::array<double, 6>;

// One frame as it is drawn; NaN where there is nothing.
struct Point {
  double time_s;
  TrackStatus status;
  Values truth, estimate;
  double distance_mm, angle_deg;
  bool jump;
};

Values ToValues(const std::optional<RigidTransform>& X) {
  Values values;
  values.fill(kNan);
  if (!X) return values;
  const Vector6d phi = PhiFromTransform(*X);
  for (std::size_t i = 0; i < 6; ++i) {
    values[i] = phi[static_cast<Eigen::Index>(i)] * kCoordinates[i].unit;
  }
  return values;
}

std::vector<Point> MakePoints(const RunRecord& record, const Evaluation& evaluation) {
  std::vector<Point> points;
  double session_start_s = 0;
  for (std::size_t i = 0; i < record.frames.size(); ++i) {
    const RunFrame& frame = record.frames[i];
    if (i > 0 && frame.session != record.frames[i - 1].session) {
      session_start_s = points.back().time_s + kSessionGap_s;
    }
    std::optional<RigidTransform> estimate = frame.X_CM;
    if (estimate && evaluation.offset) estimate = RemoveOffset(*estimate, *evaluation.offset);
    const auto error = FrameError(frame, evaluation.offset);
    points.push_back({session_start_s + frame.time_s, frame.status, ToValues(frame.X_CM_truth),
                      ToValues(estimate), error ? 1e3 * error->position.norm() : kNan,
                      error ? 180 / M_PI * error->total_angle : kNan, frame.jump});
  }
  return points;
}

double MedianPeriod(const std::vector<Point>& points) {
  std::vector<double> periods;
  for (std::size_t i = 1; i < points.size(); ++i) {
    periods.push_back(points[i].time_s - points[i - 1].time_s);
  }
  return std::max(1e-3, Quantile(periods, 0.5).value_or(1));
}

// Range of an axis: all that is given, at least min_span, with a margin.
class AxisRange {
 public:
  void Add(double value) {
    if (!std::isfinite(value)) return;
    min_ = std::min(min_, value);
    max_ = std::max(max_, value);
  }
  bool empty() const { return min_ > max_; }
  double span() const { return empty() ? 0 : max_ - min_; }
  std::string Text(double min_span) const {
    if (empty()) return "[*:*]";
    const double middle = (min_ + max_) / 2, half = std::max(min_span, 1.15 * (max_ - min_)) / 2;
    std::ostringstream text;
    text << '[' << middle - half << ':' << middle + half << ']';
    return text.str();
  }

 private:
  double min_{std::numeric_limits<double>::infinity()};
  double max_{-std::numeric_limits<double>::infinity()};
};

// Range over truth and TRACKING estimates; guesses while SEARCHING may lie outside.
AxisRange RangeOf(const std::vector<Point>& points, std::size_t i) {
  AxisRange range;
  for (const Point& p : points) {
    range.Add(p.truth[i]);
    if (p.status == TrackStatus::kTracking) range.Add(p.estimate[i]);
  }
  return range;
}

// The coordinate in which the truth moves most, against the tolerance.
std::size_t FindMainMotion(const std::vector<Point>& points) {
  std::size_t best = 0;
  double best_motion = -1;
  for (std::size_t i = 0; i < 6; ++i) {
    AxisRange range;
    for (const Point& p : points) range.Add(p.truth[i]);
    const double motion = range.span() / kCoordinates[i].band;
    if (motion > best_motion) {
      best_motion = motion;
      best = i;
    }
  }
  return best;
}

// Columns: 1 time, 2-7 truth, 8-13 TRACKING estimate, 14-19 other estimate, 20 and 21 distance and
// angle while TRACKING, 22 and 23 otherwise, 24 SEARCHING, 25 LOST.
void WriteData(const std::vector<Point>& points, std::ostream& out) {
  out << "$data << END_OF_DATA\n";
  const auto put = [&out](double value) {
    if (std::isfinite(value)) {
      out << ' ' << value;
    } else {
      out << " NaN";
    }
  };
  double last_s = 0;
  for (const Point& p : points) {
    if (p.time_s >= last_s + kSessionGap_s) out << '\n';  // an empty line interrupts lines
    last_s = p.time_s;
    const bool tracking = p.status == TrackStatus::kTracking;
    put(p.time_s);
    for (const double v : p.truth) put(v);
    for (const double v : p.estimate) put(tracking ? v : kNan);
    for (const double v : p.estimate) put(tracking ? kNan : v);
    put(tracking ? p.distance_mm : kNan);
    put(tracking ? p.angle_deg : kNan);
    put(tracking ? kNan : p.distance_mm);
    put(tracking ? kNan : p.angle_deg);
    put(p.status == TrackStatus::kSearching ? 1 : kNan);
    put(p.status == TrackStatus::kLost ? 1 : kNan);
    out << '\n';
  }
  out << "END_OF_DATA\n";
}

constexpr char kStyle[] = R"(set encoding utf8
set border 3 lc rgb '#555555'
set tics nomirror out textcolor rgb '#333333'
set grid ytics lc rgb '#e4e4e4' lt 1 lw 0.7
set y2range [0:1]
unset y2tics
set style fill solid 1 noborder
set style line 1 lc rgb '#1b1b1b' lw 2.4
set style line 2 lc rgb '#d4500f' lw 1.4 pt 7 ps 0.45
set style line 3 lc rgb '#707070' lw 1 pt 6 ps 0.6
set style line 4 lc rgb '#2b7bba' lw 1.4 dt 2
set style line 5 lc rgb '#b5121b' lw 1.4 dt 4
shade = "$data using 1:24 axes x1y2 with boxes lc rgb '#fdf0c8' title 'SEARCHING', $data using 1:25 axes x1y2 with boxes lc rgb '#f6d5d5' title 'LOST'"
)";

void SetUp(const std::vector<Point>& points, const std::string& png, int width, int height,
           std::ostream& out) {
  out << "set terminal pngcairo size " << width << ',' << height << " font 'DejaVu Sans,13'\n"
      << "set output " << QuoteForGnuplot(png) << '\n'
      << "set xrange [" << points.front().time_s << ':'
      << std::max(points.back().time_s, points.front().time_s + 0.1) << "]\n"
      << "set boxwidth " << 1.05 * MedianPeriod(points) << " absolute\n";
}

// "N TRUTH, N ESTIMATE ..." curves of coordinate i.
std::string Curves(std::size_t i, bool has_truth) {
  std::ostringstream text;
  text << "$data using 1:" << 14 + i << " with points ls 3 title 'not TRACKING'";
  if (has_truth) text << ", $data using 1:" << 2 + i << " with lines ls 1 title 'truth'";
  text << ", $data using 1:" << 8 + i << " with linespoints ls 2 title 'TRACKING'";
  return text.str();
}

void DrawPose(const std::vector<Point>& points, bool has_truth, const std::string& png,
              std::ostream& out) {
  SetUp(points, png, 1600, 1100, out);
  out << "set multiplot layout 3,2 columnsfirst margins 0.065,0.985,0.065,0.93 spacing "
         "0.075,0.05\n";
  for (std::size_t i = 0; i < 6; ++i) {
    out << "set ylabel " << QuoteForGnuplot(kCoordinates[i].label) << " offset 1\n"
        << "set yrange " << RangeOf(points, i).Text(kCoordinates[i].min_span) << '\n'
        << (i == 0
                ? "set key at screen 0.5,0.985 center top horizontal maxrows 1 width 2 samplen 2\n"
                : "unset key\n")
        << (i % 3 == 2 ? "set xlabel 'time [s]'\n" : "unset xlabel\n") << "plot @shade, "
        << Curves(i, has_truth) << '\n';
  }
  out << "unset multiplot\n";
}

// Vertical lines at the jumps of the truth, from @p tag.
void DrawJumps(const std::vector<Point>& points, std::ostream& out) {
  for (const Point& p : points) {
    if (!p.jump) continue;
    out << "set arrow from " << p.time_s << ", graph 0 to " << p.time_s
        << ", graph 1 nohead front lc rgb '#7a7a7a' dt 3\n";
  }
}

void DrawError(const std::vector<Point>& points, const std::string& png, std::ostream& out) {
  SetUp(points, png, 1600, 900, out);
  DrawJumps(points, out);
  out << "set multiplot layout 2,1 margins 0.06,0.985,0.08,0.91 spacing 0,0.06\n";
  const struct {
    const char* label;
    double Point::*value;
    int column;
    double within, wrong;
  } panels[] = {
      {"distance to the truth [mm]", &Point::distance_mm, 20, 1e3 * kWithin_m, 1e3 * kFalse_m},
      {"angle to the truth [deg]", &Point::angle_deg, 21, kWithin_rad * 180 / M_PI,
       kFalse_rad * 180 / M_PI}};
  for (const auto& panel : panels) {
    double top = 1.15 * panel.wrong;
    for (const Point& p : points) {
      const double value = p.*panel.value;
      if (p.status == TrackStatus::kTracking && std::isfinite(value)) {
        top = std::max(top, 1.05 * value);
      }
    }
    const bool first = panel.column == 20;
    out << "set ylabel " << QuoteForGnuplot(panel.label) << '\n'
        << "set yrange [0:" << top << "]\n"
        << (first
                ? "set key at screen 0.5,0.985 center top horizontal maxrows 1 width 2 samplen 2\n"
                  "unset xlabel\n"
                : "unset key\nset xlabel 'time [s]'\n")
        << "plot @shade, " << panel.within << " with lines ls 4 title 'good within', "
        << panel.wrong
        << " with lines ls 5 title 'false beyond', $data using 1:" << panel.column + 2
        << " with points ls 3 title 'not TRACKING', $data using 1:" << panel.column
        << " with linespoints ls 2 title 'TRACKING'\n";
  }
  out << "unset multiplot\nunset arrow\n";
}

void DrawMotion(const std::vector<Point>& points, const std::string& png, std::ostream& out) {
  const std::size_t i = FindMainMotion(points);
  const Coordinate& c = kCoordinates[i];
  SetUp(points, png, 1400, 700, out);
  out << "set lmargin 10\nset rmargin 3\nset tmargin 3.5\nset bmargin 4\n"
      << "set ylabel " << QuoteForGnuplot(c.label) << "\nset xlabel 'time [s]'\n"
      << "set yrange " << RangeOf(points, i).Text(std::max(c.min_span, 4 * c.band)) << '\n'
      << "set key at screen 0.5,0.985 center top horizontal maxrows 1 width 2 samplen 2\n"
      << "plot @shade, $data using 1:($" << 2 + i << "-" << c.band << "):($" << 2 + i << "+"
      << c.band << ") with filledcurves lc rgb '#d9e6f2' title '±" << c.band
      << (i < 3 ? " mm" : " deg") << "', " << Curves(i, true) << '\n';
}

}  // namespace

void WriteFigures(const RunRecord& record, const Evaluation& evaluation,
                  const std::string& folder) {
  const std::filesystem::path path(folder);
  std::filesystem::create_directories(path);
  const std::vector<Point> points = MakePoints(record, evaluation);
  const bool has_truth = evaluation.num_frames_with_truth > 0;
  std::ostringstream script;
  script.precision(9);
  script << kStyle;
  WriteData(points, script);
  DrawPose(points, has_truth, (path / "pose.png").string(), script);
  if (has_truth) {
    DrawError(points, (path / "error.png").string(), script);
    DrawMotion(points, (path / "motion.png").string(), script);
  }
  RunGnuplot(script.str(), (path / "figures.gp").string());
}

}  // namespace visavis
