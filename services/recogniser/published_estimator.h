#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "common/config/rule.h"
#include "services/recogniser/estimator.h"
#include "services/recogniser/track_monitor.h"

namespace visavis {

/// A pose to start from, where it is known.
struct StartConfig {
  template <typename A>
  void Serialize(A* a) {
    a->Visit("phi_mm_deg", &phi_mm_deg);
    a->Visit("spread_mm", &spread_mm, InRange(0.0, 500.0, "mm"));
    a->Visit("spread_deg", &spread_deg, InRange(0.0, 45.0, "deg"));
  }
  /// @throws FieldError, keys under @p prefix.
  void ValidateOrThrow(const std::string& prefix) const;

  /// X_CM; nothing where it is not known.
  std::optional<RigidTransform> Pose() const;

  std::vector<double> phi_mm_deg;  ///< t_x t_y t_z [mm] Phi theta psi [deg]; empty: unknown
  double spread_mm{8};             ///< standard deviation of the first population round it
  double spread_deg{3};
};

/// All that the published method can be set to.
struct PublishedConfig {
  template <typename A>
  void Serialize(A* a) {
    a->Visit("generations_per_frame", &generations_per_frame, InRange(1, 10000));
    a->Visit("color", &color);
    a->Visit("fitness", &fitness);
    a->Visit("track", &track);
  }
  int generations_per_frame{1};  ///< 1: the paper's 1-Step GA
  ColorRuleConfig color;
  FitnessConfig fitness;
  TrackMonitorConfig track;
};

/// The paper's method: binary elitist GA over F (Eq. 32), one generation per new image (Fig. 9),
/// the population carried by the camera's motion (Fig. 3, Eq. 16).
class PublishedEstimator final : public Estimator {
 public:
  struct Settings {
    PublishedConfig published;
    GaConfig ga;
    SearchSpace space;
    bool recentre{true};
    StartConfig start;
    FeedforwardMode feedforward{FeedforwardMode::kExact};
    std::uint64_t seed{1};
  };

  PublishedEstimator(const Settings& settings, const HeadModelConfig& head, const StereoRig& rig);

  const Estimate& Process(const StereoFrame& frame, const CameraStep& step,
                          StageTimer* timer) override;
  void Reset() override;
  void SetFeedforward(FeedforwardMode mode) override { settings_.feedforward = mode; }
  void SetSearchSpace(const SearchSpace& space) override;
  const std::vector<Individual>& population() const override { return reported_; }
  std::int64_t total_generations() const override { return total_generations_; }

 private:
  StereoMaps BuildMaps(const StereoFrame& frame);
  FeedforwardMode Feedforward(const CameraStep& step);
  void Evolve(const StereoMaps& maps);
  void FollowHead();
  void CentreOn(const Eigen::Vector3d& p_CM);

  Settings settings_;
  StereoFitness fitness_;
  PackedMap right_map_, left_map_;
  GeneticAlgorithm ga_;
  /// Where the search space is centred once a head was found or its pose given; moves with the
  /// camera. Nothing: the space is where the configuration puts it.
  std::optional<Eigen::Vector3d> centre_;
  TrackMonitor monitor_;
  Estimate estimate_;
  std::vector<Individual> reported_;  // as evaluated, before reproduction
  std::int64_t total_generations_{0};
};

}  // namespace visavis
