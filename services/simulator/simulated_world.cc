#include "services/simulator/simulated_world.h"

#include <algorithm>
#include <cmath>

#include "common/core/random.h"
#include "common/geometry/head_angles.h"
#include "services/simulator/figure.h"

namespace visavis {
namespace {

constexpr int kOpennessRays = 48;
constexpr std::size_t kNoiseSize = std::size_t{1} << 22;

}  // namespace

struct SimulatedWorld::Scene {
  Scene(const Subject& subject, std::uint64_t seed)
      : background({}, seed),
        figure(BuildFigure(subject)),
        head(figure.head, false),
        body(figure.body, false) {
    head.ComputeOpenness({&body}, kOpennessRays);
    body.ComputeOpenness({&head}, kOpennessRays);
  }
  Background background;
  Lighting light;
  Figure figure;
  Actor head, body;
  RigidTransform lit_X_SM{RigidTransform::Identity()};
  bool is_lit{false};
};

SimulatedWorld::SimulatedWorld(const WorldConfig& config, const StereoRig& rig, std::uint64_t seed)
    : config_(config),
      rig_(rig),
      seed_(seed),
      scene_(std::make_unique<Scene>(NamedSubject(config.subject), seed)),
      right_(rig.right, config.edge_samples),
      left_(rig.left, config.edge_samples),
      right_rgb_(static_cast<std::size_t>(3 * rig.right.width * rig.right.height)),
      left_rgb_(static_cast<std::size_t>(3 * rig.left.width * rig.left.height)),
      noise_(kNoiseSize) {
  Random random(seed + 101);
  for (auto& n : noise_) {
    n = static_cast<std::int8_t>(
        std::lround(std::clamp(config.noise_sigma * random.Normal(), -120.0, 120.0)));
  }
}

SimulatedWorld::~SimulatedWorld() = default;

// The body follows the head a little, as it does; the light is baked anew when the head has turned.
void SimulatedWorld::PlaceHead(const RigidTransform& X_SM) {
  const Vector6d phi = PhiFromTransform(X_SM);
  RigidTransform X_SB = MakeTransform(
      RotationFromAngles({0.2 * phi[3], 0.2 * phi[4], 0.1 * phi[5]}), Eigen::Vector3d::Zero());
  const Eigen::Vector3d& p_M_neck = scene_->figure.p_M_neck_m;
  X_SB.translation() = X_SM * p_M_neck - X_SB.linear() * p_M_neck;
  if (scene_->is_lit && X_SM.isApprox(scene_->lit_X_SM, 1e-12)) return;
  scene_->head.set_X_SO(X_SM);
  scene_->body.set_X_SO(X_SB);
  scene_->head.Bend(X_SM.inverse() * X_SB);
  scene_->head.ComputeKeyLight(scene_->light, {&scene_->body});
  scene_->body.ComputeKeyLight(scene_->light, {&scene_->head});
  scene_->lit_X_SM = X_SM;
  scene_->is_lit = true;
}

void SimulatedWorld::AddNoise(std::uint64_t seed, std::vector<std::uint8_t>* picture) const {
  if (config_.noise_sigma == 0) return;
  Random random(seed);
  const auto start =
      static_cast<std::size_t>(random.Index(static_cast<int>(kNoiseSize - picture->size())));
  const std::int8_t* noise = noise_.data() + start;
  std::uint8_t* pixels = picture->data();
  for (std::size_t i = 0; i < picture->size(); ++i) {
    const int value = pixels[i] + noise[i];
    pixels[i] = static_cast<std::uint8_t>(value < 0 ? 0 : value > 255 ? 255 : value);
  }
}

const SimulatedWorld::Pictures& SimulatedWorld::Render(const RigidTransform& X_SC,
                                                       const RigidTransform& X_SM,
                                                       bool head_present, std::int64_t frame) {
  SceneView view{{}, head_present, &scene_->background, &scene_->light};
  if (head_present) {
    PlaceHead(X_SM);
    view.actors = {&scene_->head, &scene_->body};
  }
  const auto render = [&](PictureRenderer* renderer, const Pinhole& camera,
                          const RigidTransform& X_SK, std::uint64_t side,
                          std::vector<std::uint8_t>* rgb, ImageView* out) {
    const int stride = 3 * camera.width;
    const HeadPixels pixels =
        renderer->Render(view, X_SK, {rgb->data(), camera.width, camera.height, stride}, nullptr);
    AddNoise(seed_ * 7919 + 2 * static_cast<std::uint64_t>(frame) + side, rgb);
    *out = {rgb->data(), camera.width, camera.height, stride, rgb->size(), PixelFormat::kRgb};
    return pixels;
  };
  pictures_.head = render(&right_, rig_.right, X_SC, 0, &right_rgb_, &pictures_.right);
  render(&left_, rig_.left, X_SC * rig_.X_CL, 1, &left_rgb_, &pictures_.left);
  return pictures_;
}

}  // namespace visavis
