#pragma once

#include <initializer_list>
#include <utility>
#include <vector>

namespace visavis {

/// A smooth curve through given points: piecewise cubic, monotone between neighbours (no
/// overshoot), constant outside. Arguments ascend.
class Profile {
 public:
  Profile(std::initializer_list<std::pair<double, double>> points);
  explicit Profile(std::vector<std::pair<double, double>> points);

  double operator()(double x) const;

 private:
  std::vector<double> x_, y_, slope_;
};

}  // namespace visavis
