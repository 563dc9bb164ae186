#pragma once

#include <cstdint>
#include <vector>

namespace visavis {

/// Maps one camera's clock to the host's, from the frames' own times and their arrivals.
///
/// A frame arrives at host = device + offset + delay with delay >= 0, and offset drifts with the
/// two crystals. The drift is the slope of the line that lies below all (device, arrival - device)
/// of the last 10 s and above which they sum up to least (the edge of their lower convex hull over
/// their mean); the offset is the minimum of arrival - device over the last 2 s, drift taken out.
/// What remains in the mapped time is the smallest delay of 2 s: some 0.1 ms.
class ClockMap {
 public:
  /// What became of one arrival.
  enum class Verdict {
    kTaken,      ///< agrees with the others
    kOutlier,    ///< the frame's time makes no sense beside the others': it has no host time
    kRestarted,  ///< the camera's or the host's clock was set: everything before is forgotten
  };

  ClockMap();

  /// @param device_ns the camera's clock, of any epoch, at the instant after which the frame may
  /// leave the camera (the exposure's end) @param arrival_us host time of its first packet
  Verdict Add(std::int64_t device_ns, std::int64_t arrival_us);

  /// Whether enough frames agree for the mapped times to be relied on.
  bool settled() const { return settled_; }
  /// Host time [us] of a time of the camera's clock; 0 before the first Add().
  std::int64_t ToHostUs(std::int64_t device_ns) const;
  /// How much faster the host's clock runs than the camera's [us/s = ppm]; 0 until known.
  double drift_ppm() const { return 1e6 * drift_; }
  /// Begins anew: the camera was away.
  void Reset();

 private:
  // Least offset of a short time: x device time, y arrival - device, both [us] since the start.
  struct Point {
    double x, y;
  };
  const Point& At(std::size_t i) const { return points_[(first_ + i) % points_.size()]; }
  void Start(std::int64_t device_ns, std::int64_t arrival_us);
  void Store(const Point& point);
  void FitDrift();
  void FitOffset();
  void Settle(const Point& point);

  std::vector<Point> points_;       // ring, oldest at first_
  std::vector<Point> hull_;         // of FitDrift()
  std::size_t first_{0}, size_{0};  // of the ring
  std::int64_t device_start_ns_{0}, arrival_start_us_{0};
  double x_now_{0}, y_now_{0};  // the fitted line at the newest device time
  double drift_{0};             // its slope
  double settle_y_{0};          // least of the first frames, and how many came close to it
  int num_close_{0}, num_outliers_{0};
  bool settled_{false};
};

}  // namespace visavis
