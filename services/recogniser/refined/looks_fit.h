#pragma once

#include <array>
#include <vector>

#include "services/recogniser/refined/adult_head.h"
#include "services/recogniser/refined/appearance.h"

namespace visavis {

/// Which of all adults' looks a face has, as far as it matters for its pose: the coefficients a of
/// AdultLooks' modes, a priori of variance 1, are found from the fine band of what both eyes see,
/// value = gain (mean + modes a) + offset, and eliminated from the equations of the pose.
class LooksFit {
 public:
  static constexpr int kModes = AdultLooks::kModes;

  explicit LooksFit(const FacePoints& face);

  /// Fits the looks that @p samples of the eyes (null: an eye that sees nothing) show.
  /// @return what the fit explains of what is seen by the eye that sees less of a face, less what
  /// the fit costs a priori: 1 all, about 0 where there is no face.
  double Fit(const std::array<const FaceSamples*, 2>& samples);

  /// What the last fit says of the pose: Schur's complement of the looks. @p R_CM of the pose.
  void AddTo(const std::array<const FaceSamples*, 2>& samples, const Eigen::Matrix3f& R_CM,
             float weight, PoseEquations* equations);

 private:
  using Modes = Eigen::Matrix<float, kModes, 1>;
  using ModesMatrix = Eigen::Matrix<float, kModes, kModes>;
  struct Point {
    std::size_t index;
    Eigen::Vector3f p;
    float mean, weight;
    Modes modes;
  };
  /// value = gain (mean + modes a) + offset, of an eye that sees enough.
  struct Light {
    bool is_known{false};
    float gain{0}, offset{0};
    double likeness{0};
  };

  /// Those that fit the looks a_ best.
  void FindLights(const std::array<const FaceSamples*, 2>& samples);

  std::vector<Point> points_;
  Modes a_{Modes::Zero()};
  std::array<Light, 2> light_;
};

}  // namespace visavis
