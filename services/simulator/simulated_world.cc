#include "services/simulator/simulated_world.h"

#include <cmath>

#include "common/config/config_error.h"
#include "services/simulator/mesh_file.h"

namespace visavis {
namespace {

constexpr int kOpennessRays = 48;
constexpr double kShadowPeriod_s = 0.2;

/// A mesh as fine as its texture is worth.
FigureDetail DetailFor(int texture_size) {
  if (texture_size < 512) return {56, 44, texture_size};
  return {112, 88, texture_size};
}

Figure MakeFigure(const SceneConfig& scene) {
  scene.ValidateOrThrow();
  if (!scene.mesh_file.empty()) {
    return LoadFigure(scene.mesh_file, {scene.mesh_scale, scene.mesh_y_up,
                                        Eigen::Vector3d::Map(scene.mesh_origin_m.data())});
  }
  return BuildFigure(NamedSubject(scene.subject), DetailFor(scene.texture_size));
}

Figure MakeBystander(const SceneConfig& scene) {
  if (scene.second_head.empty()) return {};
  return BuildFigure(NamedSubject(scene.second_head), DetailFor(std::min(scene.texture_size, 512)));
}

BackgroundConfig WallOf(const SceneConfig& scene) {
  BackgroundConfig config;
  config.coarse = scene.texture_size < 512;  // as the figure, see DetailFor()
  config.wall_z_m = 1e-3 * scene.wall_z_mm;
  config.skin_coloured = scene.skin_coloured_wall;
  if (config.skin_coloured && scene.mesh_file.empty()) {
    config.skin = NamedSubject(scene.subject).complexion.skin;
  }
  return config;
}

Lighting LightOf(const SceneConfig& scene, std::uint64_t seed) {
  if (scene.light == "side") return Lighting::Side();
  return scene.light == "random" ? Lighting::Random(seed) : Lighting();
}

/// Where the body is when the head is at X_SM: upright, joined at the neck, turned a little along.
RigidTransform BodyPose(const RigidTransform& X_SM, const Eigen::Vector3d& p_M_neck) {
  const Eigen::Matrix3d R_SB = ExpRotation(0.2 * LogRotation(X_SM.linear()));
  return MakeTransform(R_SB, X_SM * p_M_neck - R_SB * p_M_neck);
}

}  // namespace

void SceneConfig::ValidateOrThrow() const {
  for (const auto& [key, value] :
       {std::pair{"scene.subject", subject}, {"scene.second_head", second_head}}) {
    if (value.empty() && key != std::string("scene.subject")) continue;
    try {
      NamedSubject(value);
    } catch (const std::invalid_argument& e) {
      throw FieldError(key, value, e.what());
    }
  }
}

SimulatedWorld::SimulatedWorld(const ScenarioConfig& scenario, const SceneConfig& scene,
                               const SensorConfig& sensor, const StereoRig& rig,
                               const RigidTransform& X_WC0, std::uint64_t seed)
    : SimulatedWorld(scenario, scene, sensor, rig, X_WC0, seed, MakeFigure(scene),
                     std::make_shared<Background>(WallOf(scene), seed)) {}

SimulatedWorld::SimulatedWorld(const ScenarioConfig& scenario, const SceneConfig& scene,
                               const SensorConfig& sensor, const StereoRig& rig,
                               const RigidTransform& X_WC0, std::uint64_t seed, Figure figure,
                               std::shared_ptr<const Background> background)
    : scenario_(scenario, X_WC0, seed),
      scene_(scene),
      sensor_config_(sensor),
      rig_(rig),
      X_SW_(X_WC0.inverse()),
      figure_(std::move(figure)),
      bystander_figure_(MakeBystander(scene)),
      background_(std::move(background)),
      light_(LightOf(scene, seed)),
      sensor_(sensor, seed),
      right_(rig.right, scene.edge_samples),
      left_(rig.left, scene.edge_samples) {
  rig.ValidateOrThrow();
  head_ = std::make_unique<Actor>(figure_.head, false);
  std::vector<const Actor*> bodies;
  if (!figure_.body.empty()) {
    body_ = std::make_unique<Actor>(figure_.body, false);
    bodies.push_back(body_.get());
    body_->ComputeOpenness({head_.get()}, kOpennessRays);
  }
  head_->ComputeOpenness(bodies, kOpennessRays);
  if (!bystander_figure_.head.empty()) {
    bystander_head_ = std::make_unique<Actor>(bystander_figure_.head, true);
    bystander_body_ = std::make_unique<Actor>(bystander_figure_.body, true);
    bystander_head_->ComputeOpenness({bystander_body_.get()}, kOpennessRays);
    bystander_body_->ComputeOpenness({bystander_head_.get()}, kOpennessRays);
    RigidTransform X_SM = RigidTransform::Identity();
    X_SM.translation() = 1e-3 * Eigen::Vector3d::Map(scene.second_head_mm.data());
    bystander_head_->set_X_SO(X_SM);
    bystander_body_->set_X_SO(X_SM);
    bystander_head_->ComputeKeyLight(light_, {bystander_body_.get()});
    bystander_body_->ComputeKeyLight(light_, {bystander_head_.get()});
  }
  if (scene.occluded_share > 0) {
    hand_parts_ = BuildHand(scene.mesh_file.empty() ? NamedSubject(scene.subject).complexion.skin
                                                    : Srgb(0.78, 0.6, 0.5));
    hand_ = std::make_unique<Actor>(hand_parts_, false);
    hand_->ComputeOpenness({}, kOpennessRays);
    PlaceHand();
  }
}

SimulatedWorld::~SimulatedWorld() = default;

void SimulatedWorld::KeepLabels() {
  keep_labels_ = true;
  const auto pixels = [](const Pinhole& camera) {
    return static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height);
  };
  labels_[0].resize(pixels(rig_.right));
  labels_[1].resize(pixels(rig_.left));
}

void SimulatedWorld::PlaceHand() {
  // Before the face, fingers slanting up; slid in from the image's lower left until it hides the
  // share asked for, seen by a coarse camera in the nominal place.
  const Eigen::Matrix3d R = (Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitZ()) *
                             Eigen::AngleAxisd(-0.25, Eigen::Vector3d::UnitY()))
                                .toRotationMatrix();
  const Pinhole coarse{160, 120, 200, 200, 79.5, 59.5, {}};
  PictureRenderer renderer(coarse, 1);
  std::vector<std::uint8_t> pixels(160 * 120 * 3);
  RigidTransform X_SM_front = RigidTransform::Identity();
  X_SM_front.translation().z() = 1e-3 * scenario_.config().distance_mm;
  head_->set_X_SO(X_SM_front);
  const auto hidden = [&](double way) {
    const Eigen::Vector3d p_M(-0.20 + 0.20 * way, 0.19 - 0.14 * way, -0.165);
    X_MHand_ = MakeTransform(R, p_M);
    hand_->set_X_SO(X_SM_front * X_MHand_);
    const SceneView view{{head_.get(), hand_.get()}, true, background_.get(), &light_};
    HeadPixels seen;
    renderer.Render(view, RigidTransform::Identity(), {pixels.data(), 160, 120, 480}, nullptr,
                    &seen);
    return 1 - seen.face_share();
  };
  double low = 0, high = 1;
  if (hidden(high) < scene_.occluded_share) {
    throw FieldError("scene.occluded_share", std::to_string(scene_.occluded_share),
                     "the hand hides at most " + std::to_string(hidden(high)) + " of this face");
  }
  for (int i = 0; i < 14; ++i) {
    const double middle = 0.5 * (low + high);
    (hidden(middle) < scene_.occluded_share ? low : high) = middle;
  }
  hidden(high);
}

bool SimulatedWorld::HandShown(double t_s) const {
  return hand_ != nullptr && t_s >= scene_.occluded_from_s && t_s < scene_.occluded_until_s;
}

std::vector<Actor*> SimulatedWorld::Pose(const RigidTransform& X_SM, bool with_hand) {
  head_->set_X_SO(X_SM);
  std::vector<Actor*> actors{head_.get()};
  if (body_) {
    const RigidTransform X_SB = BodyPose(X_SM, figure_.p_M_neck_m);
    body_->set_X_SO(X_SB);
    head_->Bend(X_SM.inverse() * X_SB);
    actors.push_back(body_.get());
  }
  if (with_hand) {
    hand_->set_X_SO(X_SM * X_MHand_);
    actors.push_back(hand_.get());
  }
  return actors;
}

void SimulatedWorld::Light(double t_s) {
  // Shadows are soft and follow the head's turns alone: they are cast for its pose at most
  // kShadowPeriod_s ago, a function of time like all else.
  const double lit_t_s = kShadowPeriod_s * std::floor(t_s / kShadowPeriod_s);
  const RigidTransform X_SM = X_SW_ * scenario_.HeadPose(lit_t_s);
  const bool with_hand = HandShown(t_s);
  if (lit_X_SM_ && lit_X_SM_->matrix() == X_SM.matrix() && lit_with_hand_ == with_hand) return;
  lit_X_SM_ = X_SM;
  lit_with_hand_ = with_hand;
  const std::vector<Actor*> actors = Pose(X_SM, with_hand);
  for (Actor* actor : actors) {
    std::vector<const Actor*> others;
    for (const Actor* other : actors) {
      if (other != actor) others.push_back(other);
    }
    actor->ComputeKeyLight(light_, others);
  }
}

HeadPixels SimulatedWorld::RenderInstant(double t_s, const RigidTransform& X_WC,
                                         const RgbView& right, const RgbView& left) {
  SceneView view{{}, false, background_.get(), &light_};
  if (scenario_.HeadPresent(t_s)) {
    Light(t_s);
    view.has_head = true;
    for (const Actor* actor : Pose(X_SW_ * scenario_.HeadPose(t_s), HandShown(t_s))) {
      view.actors.push_back(actor);
    }
  }
  if (bystander_head_) {
    view.actors.push_back(bystander_head_.get());
    view.actors.push_back(bystander_body_.get());
  }
  const RigidTransform X_SC = X_SW_ * X_WC;
  HeadPixels pixels;
  const auto labels = [&](std::size_t i) { return keep_labels_ ? labels_[i].data() : nullptr; };
  right_.Render(view, X_SC, right, labels(0), &pixels);
  left_.Render(view, X_SC * rig_.X_CL, left, labels(1), nullptr);
  return pixels;
}

SimulatedWorld::Truth SimulatedWorld::Render(double t_s, std::int64_t picture_number,
                                             const CameraPath& X_WC, const RgbView& right,
                                             const RgbView& left) {
  Truth truth;
  truth.X_WC = X_WC(t_s);
  truth.X_WM = scenario_.HeadPose(t_s);
  truth.X_CM = truth.X_WC.inverse() * truth.X_WM;
  truth.head_present = scenario_.HeadPresent(t_s);
  HeadPixels pixels;
  if (sensor_config_.blur_samples == 1) {
    pixels = RenderInstant(t_s, truth.X_WC, right, left);
  } else {
    right_sum_.Clear(right.width, right.height);
    left_sum_.Clear(left.width, left.height);
    const int n = sensor_config_.blur_samples;
    for (int k = 0; k < n; ++k) {
      const double t = t_s + 1e-3 * sensor_config_.exposure_ms * ((k + 0.5) / n - 0.5);
      const HeadPixels seen = RenderInstant(t, X_WC(t), right, left);
      if (k == n / 2) pixels = seen;
      right_sum_.Add(right);
      left_sum_.Add(left);
    }
    right_sum_.Write(right);
    left_sum_.Write(left);
  }
  sensor_.Expose(picture_number, 0, t_s, right);
  sensor_.Expose(picture_number, 1, t_s, left);
  truth.head_visible_share = pixels.head_share();
  truth.face_visible_share = pixels.face_share();
  return truth;
}

}  // namespace visavis
