#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "common/config/rule.h"
#include "common/geometry/stereo_rig.h"
#include "common/image/image.h"
#include "services/simulator/picture_renderer.h"

namespace visavis {

/// Who and what stands before the cameras, and how well they see.
struct WorldConfig {
  template <typename A>
  void Serialize(A* a) {
    a->Visit("subject", &subject);
    a->Visit("noise_sigma", &noise_sigma, InRange(0.0, 50.0));
    a->Visit("edge_samples", &edge_samples, OneOfNumbers());
  }
  static Rule<int> OneOfNumbers() {
    return {[](const int& v) { return v == 1 || v == 2 || v == 4 || v == 8 || v == 16; },
            "must be 1, 2, 4, 8 or 16"};
  }
  std::string subject{"adult_a"};  ///< one of SubjectNames()
  double noise_sigma{4};           ///< of the sensor, in grey levels
  int edge_samples{4};             ///< rays a pixel where surfaces meet
};

/// The scene and both cameras. Poses are given in S, the axes of the nominal right camera.
class SimulatedWorld {
 public:
  /// @throws std::invalid_argument for an unknown subject.
  SimulatedWorld(const WorldConfig& config, const StereoRig& rig, std::uint64_t seed);
  ~SimulatedWorld();

  struct Pictures {
    ImageView right, left;  ///< RGB, valid until the next call
    HeadPixels head;        ///< as the right camera sees it
  };

  /// @param X_SC the right camera, @param X_SM the head, @param frame number of the pair: it seeds
  /// the noise, so that the same frame has the same bytes.
  const Pictures& Render(const RigidTransform& X_SC, const RigidTransform& X_SM, bool head_present,
                         std::int64_t frame);

 private:
  struct Scene;
  void PlaceHead(const RigidTransform& X_SM);
  void AddNoise(std::uint64_t seed, std::vector<std::uint8_t>* picture) const;

  WorldConfig config_;
  StereoRig rig_;
  std::uint64_t seed_;
  std::unique_ptr<Scene> scene_;
  PictureRenderer right_, left_;
  std::vector<std::uint8_t> right_rgb_, left_rgb_;
  std::vector<std::int8_t> noise_;  // drawn once; each picture starts somewhere else in it
  Pictures pictures_;
};

}  // namespace visavis
