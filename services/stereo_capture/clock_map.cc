#include "services/stereo_capture/clock_map.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace visavis {
namespace {

constexpr double kBucketUs = 50e3;        // points are the minima of so long
constexpr double kDriftWindowUs = 10e6;   // what the drift is fitted to
constexpr double kDriftLeastUs = 3e6;     // below, delays would pass for drift
constexpr double kOffsetWindowUs = 2e6;   // what the offset is the minimum of
constexpr double kMaxDrift = 500e-6;      // crystals are within 100 ppm
constexpr double kEarlyOutlierUs = 50e3;  // before the camera can have sent it
constexpr double kLateOutlierUs = 250e3;  // later than any link holds a frame back
constexpr int kOutliersToRestart = 4;     // in succession: not the frames, the clock
constexpr double kSettleUs = 0.15e6;
constexpr int kSettleFrames = 5;
constexpr double kCloseUs = 2000;  // of the least delay: such a frame confirms the minimum

}  // namespace

ClockMap::ClockMap()
    : points_(static_cast<std::size_t>(kDriftWindowUs / kBucketUs)), hull_(points_.size()) {}

void ClockMap::Reset() {
  first_ = size_ = 0;
  x_now_ = y_now_ = drift_ = 0;
  num_close_ = num_outliers_ = 0;
  settled_ = false;
}

void ClockMap::Start(std::int64_t device_ns, std::int64_t arrival_us) {
  Reset();
  device_start_ns_ = device_ns;
  arrival_start_us_ = arrival_us;
}

ClockMap::Verdict ClockMap::Add(std::int64_t device_ns, std::int64_t arrival_us) {
  if (size_ == 0) Start(device_ns, arrival_us);
  const double x = 1e-3 * static_cast<double>(device_ns - device_start_ns_);
  const Point point{x, static_cast<double>(arrival_us - arrival_start_us_) - x};
  Verdict verdict = Verdict::kTaken;
  if (size_ > 0) {
    const double delay = point.y - (y_now_ + drift_ * (x - x_now_));
    if (x < x_now_ || delay < -kEarlyOutlierUs || delay > kLateOutlierUs) {
      if (++num_outliers_ < kOutliersToRestart) return Verdict::kOutlier;
      verdict = Verdict::kRestarted;
      Start(device_ns, arrival_us);
      return Add(device_ns, arrival_us), verdict;
    }
  }
  num_outliers_ = 0;
  Store(point);
  x_now_ = x;
  FitDrift();
  FitOffset();
  Settle(point);
  return verdict;
}

std::int64_t ClockMap::ToHostUs(std::int64_t device_ns) const {
  const double x = 1e-3 * static_cast<double>(device_ns - device_start_ns_);
  return arrival_start_us_ + std::llround(x + y_now_ + drift_ * (x - x_now_));
}

void ClockMap::Store(const Point& point) {
  const auto bucket = [](const Point& p) { return std::floor(p.x / kBucketUs); };
  if (size_ > 0) {
    Point& newest = points_[(first_ + size_ - 1) % points_.size()];
    if (bucket(newest) == bucket(point)) {
      if (point.y < newest.y) newest = point;
      return;
    }
  }
  while (size_ > 0 && (size_ == points_.size() || At(0).x < point.x - kDriftWindowUs)) {
    first_ = (first_ + 1) % points_.size();
    --size_;
  }
  points_[(first_ + size_++) % points_.size()] = point;
}

void ClockMap::FitDrift() {
  if (At(size_ - 1).x - At(0).x < kDriftLeastUs) return;
  std::size_t count = 0;
  double mean_x = 0;
  for (std::size_t i = 0; i < size_; ++i) {
    const Point& p = At(i);
    mean_x += p.x / static_cast<double>(size_);
    const auto is_above = [&](const Point& a, const Point& b) {  // b on or above the line a to p
      return (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x) <= 0;
    };
    while (count >= 2 && is_above(hull_[count - 2], hull_[count - 1])) --count;
    hull_[count++] = p;
  }
  for (std::size_t i = 1; i < count; ++i) {
    if (hull_[i].x < mean_x) continue;
    const double slope = (hull_[i].y - hull_[i - 1].y) / (hull_[i].x - hull_[i - 1].x);
    drift_ = std::clamp(slope, -kMaxDrift, kMaxDrift);
    return;
  }
}

void ClockMap::FitOffset() {
  y_now_ = std::numeric_limits<double>::infinity();
  for (std::size_t i = size_; i-- > 0;) {
    const Point& p = At(i);
    if (p.x < x_now_ - kOffsetWindowUs) break;
    y_now_ = std::min(y_now_, p.y + drift_ * (x_now_ - p.x));
  }
}

void ClockMap::Settle(const Point& point) {
  // A minimum far below the old one shows that all before it were late.
  if (point.y < settle_y_ - kCloseUs) num_close_ = 0;
  settle_y_ = num_close_ == 0 ? point.y : std::min(settle_y_, point.y);
  if (point.y < settle_y_ + kCloseUs) ++num_close_;
  if (num_close_ >= kSettleFrames && x_now_ >= kSettleUs) settled_ = true;
}

}  // namespace visavis
