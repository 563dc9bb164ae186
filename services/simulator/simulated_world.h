#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/config/rule.h"
#include "common/geometry/stereo_rig.h"
#include "services/simulator/figure.h"
#include "services/simulator/picture_renderer.h"
#include "services/simulator/scenario.h"
#include "services/simulator/sensor.h"

namespace visavis {

/// What stands in front of the cameras, beside the motion.
struct SceneConfig {
  template <typename A>
  void Serialize(A* a) {
    a->Visit("subject", &subject);
    a->VisitFile("mesh_file", &mesh_file);
    a->Visit("mesh_scale", &mesh_scale, InRange(1e-6, 1e6, "m per unit"));
    a->Visit("mesh_y_up", &mesh_y_up);
    a->Visit("mesh_origin_m", &mesh_origin_m);
    a->Visit("light", &light, OneOf({"front", "side", "random"}));
    a->Visit("wall_z_mm", &wall_z_mm, InRange(1400.0, 10000.0, "mm"));
    a->Visit("skin_coloured_wall", &skin_coloured_wall);
    a->Visit("second_head", &second_head);
    a->Visit("second_head_mm", &second_head_mm);
    a->Visit("occluded_share", &occluded_share, InRange(0.0, 0.8));
    a->Visit("occluded_from_s", &occluded_from_s);
    a->Visit("occluded_until_s", &occluded_until_s);
    a->Visit("edge_samples", &edge_samples,
             {[](const int& n) { return n == 1 || n == 2 || n == 4 || n == 8 || n == 16; },
              "must be 1, 2, 4, 8 or 16"});
    a->Visit("texture_size", &texture_size,
             {[](const int& n) { return n >= 64 && n <= 4096 && (n & (n - 1)) == 0; },
              "must be a power of two, 64 to 4096 texels"});
  }
  /// @throws std::invalid_argument naming field, value and rule.
  void ValidateOrThrow() const;

  std::string subject{"adult_a"};  ///< adult_a to adult_h
  std::string mesh_file;           ///< a head from file in the subject's place; empty: none
  double mesh_scale{1};            ///< metres per unit of the file
  bool mesh_y_up{true};            ///< glTF's axes; false: M's
  std::array<double, 3> mesh_origin_m{0, 0, 0};  ///< M's origin in the scaled file
  /// front: a soft lamp above; side: half the face in the dark; random: by the seed.
  std::string light{"front"};
  double wall_z_mm{2200};  ///< distance of the wall from the nominal camera
  bool skin_coloured_wall{false};
  std::string second_head;  ///< another subject at rest in view; empty: none
  std::array<double, 3> second_head_mm{420, -20, 1450};  ///< its place in the nominal camera
  double occluded_share{0};  ///< share of the face behind a hand, seen from the nominal camera
  double occluded_from_s{0}, occluded_until_s{1e9};
  int edge_samples{4};     ///< rays in a pixel at an edge: 1, 2, 4, 8 or 16
  int texture_size{1024};  ///< of the face [texel]; half of it: a quarter of the start-up time
};

/// The simulated world: pictures of both cameras, and the exact truth.
class SimulatedWorld {
 public:
  /// X_WC at a time [s].
  using CameraPath = std::function<RigidTransform(double t_s)>;

  struct Truth {
    RigidTransform X_CM;  ///< X_WC^-1 X_WM at mid-exposure
    RigidTransform X_WC;
    RigidTransform X_WM;
    bool head_present;          ///< false: X_CM says where it would be
    double head_visible_share;  ///< of the head's outline in the right picture, 0 to 1
    double face_visible_share;  ///< of the face's
  };

  /// @p X_WC0: nominal pose of the right camera, which fixes where wall and light are.
  /// @throws std::invalid_argument naming field, value and rule.
  SimulatedWorld(const ScenarioConfig& scenario, const SceneConfig& scene,
                 const SensorConfig& sensor, const StereoRig& rig, const RigidTransform& X_WC0,
                 std::uint64_t seed);
  /// With figure and wall of the caller's own; a world may share its wall with others.
  SimulatedWorld(const ScenarioConfig& scenario, const SceneConfig& scene,
                 const SensorConfig& sensor, const StereoRig& rig, const RigidTransform& X_WC0,
                 std::uint64_t seed, Figure figure, std::shared_ptr<const Background> background);
  ~SimulatedWorld();

  const Scenario& scenario() const { return scenario_; }
  const Figure& figure() const { return figure_; }

  /// Renders the pair exposed at @p t_s into pictures of the rig's sizes. The camera is where
  /// @p X_WC says, whatever the scenario desires. Same arguments, same bytes, in any order.
  /// @param picture_number of the pair: seeds the noise.
  Truth Render(double t_s, std::int64_t picture_number, const CameraPath& X_WC,
               const RgbView& right, const RgbView& left);

  /// From now on keeps labels too.
  void KeepLabels();
  /// Label at each pixel centre of the right (0) or left (1) picture of the last Render; of its
  /// last instant where there is motion blur. Empty before KeepLabels().
  const std::vector<std::uint8_t>& labels(int camera) const {
    return labels_[static_cast<std::size_t>(camera)];
  }

 private:
  /// Head, body and what hides them, posed for one instant. @return their shares seen.
  HeadPixels RenderInstant(double t_s, const RigidTransform& X_WC, const RgbView& right,
                           const RgbView& left);
  /// Sets the actors for a head at X_SM; returns those in view: head, body, hand.
  std::vector<Actor*> Pose(const RigidTransform& X_SM, bool with_hand);
  /// Casts the key light's shadows for the time @p t_s.
  void Light(double t_s);
  void PlaceHand();
  bool HandShown(double t_s) const;

  Scenario scenario_;
  SceneConfig scene_;
  SensorConfig sensor_config_;
  StereoRig rig_;
  RigidTransform X_SW_;
  Figure figure_;
  Figure bystander_figure_;
  std::vector<Part> hand_parts_;
  std::shared_ptr<const Background> background_;
  Lighting light_;
  Sensor sensor_;
  ExposureSum right_sum_, left_sum_;
  std::unique_ptr<Actor> head_, body_, hand_, bystander_head_, bystander_body_;
  RigidTransform X_MHand_{RigidTransform::Identity()};
  std::optional<RigidTransform> lit_X_SM_;  ///< the head's pose for which the light was computed
  bool lit_with_hand_{false};
  PictureRenderer right_, left_;
  bool keep_labels_{false};
  std::array<std::vector<std::uint8_t>, 2> labels_;
};

}  // namespace visavis
