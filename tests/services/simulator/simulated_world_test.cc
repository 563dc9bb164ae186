#include "services/simulator/simulated_world.h"

#include <gtest/gtest.h>

#include <map>

#include "common/rigs/demo_rig.h"
#include "services/simulator/bake.h"
#include "tests/support/config_refusal.h"

namespace visavis {
namespace {

constexpr int kWidth = 320, kHeight = 240;

StereoRig Rig() {
  StereoRig rig;
  rig.right = rig.left = {kWidth, kHeight, 400, 400, 159.5, 119.5, {}};
  rig.X_CL.translation().x() = -0.15;
  return rig;
}

struct Pair {
  std::vector<std::uint8_t> right = std::vector<std::uint8_t>(3 * kWidth * kHeight);
  std::vector<std::uint8_t> left = right;
  SimulatedWorld::Truth truth;
};

Pair Shoot(SimulatedWorld* world, double t, std::int64_t number = 0) {
  Pair pair;
  pair.truth = world->Render(t, number, [&](double s) { return world->scenario().CameraPose(s); },
                             {pair.right.data(), kWidth, kHeight, 3 * kWidth},
                             {pair.left.data(), kWidth, kHeight, 3 * kWidth});
  return pair;
}

struct Settings {
  ScenarioConfig scenario;
  SceneConfig scene;
  SensorConfig sensor;
};

Settings Still() {
  Settings s;
  s.scenario.name = "static";
  s.scenario.head_phi_mm_deg.clear();
  s.sensor.noise_sigma = 0;
  return s;
}

/// Figures are made once and coarse: most tests need no more.
const Figure& FigureOf(const std::string& subject) {
  static std::map<std::string, Figure> figures;
  const auto found = figures.find(subject);
  if (found != figures.end()) return found->second;
  return figures.emplace(subject, BuildFigure(NamedSubject(subject), {56, 44, 256})).first->second;
}

std::shared_ptr<const Background> Wall() {
  static const auto wall = std::make_shared<Background>(BackgroundConfig{}, 1);
  return wall;
}

std::unique_ptr<SimulatedWorld> Make(const Settings& s, const std::string& subject = "adult_a") {
  auto world = std::make_unique<SimulatedWorld>(s.scenario, s.scene, s.sensor, Rig(),
                                                DemoCameraPose(), 1, FigureOf(subject), Wall());
  world->KeepLabels();
  return world;
}

int CountLabel(const SimulatedWorld& world, Label label) {
  int count = 0;
  for (const std::uint8_t value : world.labels(0))
    count += value == static_cast<std::uint8_t>(label);
  return count;
}

TEST(SimulatedWorldTest, SameArgumentsSameBytesInAnyOrderAndOnAnotherObject) {
  Settings s = Still();
  s.scenario.name = "moving_head";
  s.scenario.camera_moves = true;
  s.sensor.noise_sigma = 4;
  const auto world = Make(s), twin = Make(s);
  const Pair first = Shoot(world.get(), 0.2, 6), second = Shoot(world.get(), 0.4, 12);
  EXPECT_NE(first.right, second.right);
  const Pair second_again = Shoot(twin.get(), 0.4, 12), first_again = Shoot(twin.get(), 0.2, 6);
  EXPECT_EQ(first.right, first_again.right);
  EXPECT_EQ(first.left, first_again.left);
  EXPECT_EQ(second.right, second_again.right);
  EXPECT_EQ(second.left, second_again.left);
}

TEST(SimulatedWorldTest, TruthIsExactlyTheHeadInTheCameraGiven) {
  const auto world = Make(Still());
  const RigidTransform X_WC =
      DemoCameraPose() * MakeTransform(ExpRotation({0.02, -0.1, 0.05}), {0.05, 0.02, -0.03});
  Pair pair;
  const auto truth = world->Render(0, 0, [&](double) { return X_WC; },
                                   {pair.right.data(), kWidth, kHeight, 3 * kWidth},
                                   {pair.left.data(), kWidth, kHeight, 3 * kWidth});
  EXPECT_EQ(truth.X_CM.matrix(), (X_WC.inverse() * DemoHeadPose()).matrix());
  EXPECT_TRUE(truth.head_present);
  EXPECT_EQ(truth.face_visible_share, 1);
}

/// Mean place [px] of the pixels labelled eye within 18 px of @p near; NaN below 80 pixels.
Eigen::Vector2d EyeCentroid(const std::vector<std::uint8_t>& labels, const Eigen::Vector2d& near) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  int count = 0;
  for (int i = 0; i < 640 * 480; ++i) {
    const Eigen::Vector2d pixel(i % 640, i / 640);
    if (static_cast<Label>(labels[static_cast<std::size_t>(i)]) != Label::kEye) continue;
    if ((pixel - near).norm() > 18) continue;
    sum += pixel;
    ++count;
  }
  return count < 80 ? Eigen::Vector2d::Constant(std::nan("")) : Eigen::Vector2d(sum / count);
}

TEST(SimulatedWorldTest, EyesAreWhereTheModelsLandmarksProject) {
  // The nominal rig and a finer texture: an eye is 24 x 8 px. A head straight before the right
  // camera and one before the left: seen from aside, the near half of an eye counts for more.
  StereoRig rig = Rig();
  rig.right = rig.left = {640, 480, 800, 800, 319.5, 239.5, {}};
  const Figure figure = BuildFigure(NamedSubject("adult_b"), {112, 88, 512});
  for (const int camera : {0, 1}) {
    Settings s = Still();
    s.scenario.head_phi_mm_deg = {camera == 0 ? 10.0 : -140.0, -20, -60, 8, 0, 0};
    SimulatedWorld world(s.scenario, s.scene, s.sensor, rig, DemoCameraPose(), 1, figure, Wall());
    world.KeepLabels();
    std::vector<std::uint8_t> right(640 * 480 * 3), left = right;
    const auto truth = world.Render(0, 0, [](double) { return DemoCameraPose(); },
                                    {right.data(), 640, 480, 1920}, {left.data(), 640, 480, 1920});
    for (const Eigen::Vector3d& p_M : {figure.p_M_eye_right_m, figure.p_M_eye_left_m}) {
      const Eigen::Vector2d expected =
          (camera == 0 ? ProjectRight : ProjectLeft)(rig, truth.X_CM, p_M).uv;
      EXPECT_LT((EyeCentroid(world.labels(camera), expected) - expected).norm(), 0.3) << camera;
    }
  }
}

TEST(SimulatedWorldTest, EverySubjectShowsAFace) {
  for (const std::string& name : SubjectNames()) {
    const auto world = Make(Still(), name);
    const Pair pair = Shoot(world.get(), 0);
    EXPECT_GT(CountLabel(*world, Label::kSkin), 1200) << name;
    EXPECT_GT(CountLabel(*world, Label::kEye), 30) << name;
    EXPECT_GT(CountLabel(*world, Label::kClothes), 2000) << name;
    EXPECT_EQ(pair.truth.head_visible_share, 1) << name;
  }
}

TEST(SimulatedWorldTest, AnAbsentHeadLeavesTheBareWall) {
  Settings s = Still();
  s.scenario.absent_from_s = 1;
  s.scenario.absent_until_s = 2;
  const auto world = Make(s);
  Shoot(world.get(), 0.5);
  const Pair away = Shoot(world.get(), 1.5);
  EXPECT_FALSE(away.truth.head_present);
  EXPECT_EQ(away.truth.head_visible_share, 0);
  EXPECT_EQ(CountLabel(*world, Label::kBackground), kWidth * kHeight);
  const Pair back = Shoot(world.get(), 2.5);
  EXPECT_TRUE(back.truth.head_present);
  EXPECT_EQ(back.right, Shoot(world.get(), 0.5).right);
}

TEST(SimulatedWorldTest, TheHandHidesTheShareAskedForAndOnlyInItsTime) {
  for (const double share : {0.15, 0.4}) {
    Settings s = Still();
    s.scene.occluded_share = share;
    s.scene.occluded_from_s = 1;
    s.scene.occluded_until_s = 2;
    const auto world = Make(s);
    EXPECT_NEAR(1 - Shoot(world.get(), 1.5).truth.face_visible_share, share, 0.02);
    EXPECT_GT(CountLabel(*world, Label::kHand), 500);
    EXPECT_EQ(Shoot(world.get(), 0.5).truth.face_visible_share, 1);
    EXPECT_EQ(CountLabel(*world, Label::kHand), 0);
  }
}

TEST(SimulatedWorldTest, RefusesAShareThatTheHandCannotHide) {
  Settings s = Still();
  s.scene.occluded_share = 0.8;
  try {
    Make(s);
    FAIL();
  } catch (const FieldError& e) {
    EXPECT_EQ(e.key(), "scene.occluded_share");
  }
}

TEST(SimulatedWorldTest, ASecondPersonIsSeenAndKeptApart) {
  Settings s = Still();
  s.scene.second_head = "adult_f";
  s.scene.texture_size = 128;
  const auto world = Make(s);
  const Pair pair = Shoot(world.get(), 0);
  EXPECT_GT(CountLabel(*world, Label::kBystander), 3000);
  EXPECT_EQ(pair.truth.head_visible_share, 1);
}

TEST(SimulatedWorldTest, MotionBlurSoftensWhatMovesAndLeavesTheRest) {
  Settings s = Still();
  s.scenario.name = "shuttle_x";
  s.scenario.period_s = 1;
  s.sensor.exposure_ms = 20;
  const auto sharp = Make(s);
  s.sensor.blur_samples = 8;
  const auto blurred = Make(s);
  const auto roughness = [](const Pair& pair) {
    double sum = 0;
    for (std::size_t i = 3; i < pair.right.size(); ++i)
      sum += std::abs(pair.right[i] - pair.right[i - 3]);
    return sum;
  };
  // Fastest at a quarter of the period: 0.94 m/s, 7.5 px within the shutter time at the head.
  EXPECT_LT(roughness(Shoot(blurred.get(), 0.25)), 0.75 * roughness(Shoot(sharp.get(), 0.25)));
  // At the turning point nothing moves.
  EXPECT_GT(roughness(Shoot(blurred.get(), 0)), 0.93 * roughness(Shoot(sharp.get(), 0)));
}

TEST(SimulatedWorldTest, SideLightDarkensOneHalfOfTheFace) {
  const auto halves = [](const std::string& light) {
    Settings s = Still();
    s.scene.light = light;
    const auto world = Make(s);
    const Pair pair = Shoot(world.get(), 0);
    std::array<double, 2> sum{}, count{};
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        const auto i = static_cast<std::size_t>(y * kWidth + x);
        if (world->labels(0)[i] != static_cast<std::uint8_t>(Label::kSkin)) continue;
        sum[x > kWidth / 2] += pair.right[3 * i + 1];
        ++count[x > kWidth / 2];
      }
    }
    return sum[0] / count[0] / (sum[1] / count[1]);
  };
  EXPECT_LT(halves("front"), 1.35);
  EXPECT_GT(halves("side"), 1.6);
}

TEST(SimulatedWorldTest, TheBodyStaysUprightWhenTheHeadTurns) {
  Settings s = Still();
  const auto straight = Make(s);
  Shoot(straight.get(), 0);
  s.scenario.head_phi_mm_deg = {0, 0, 0, 20, 0, 0};
  const auto tilted = Make(s);
  Shoot(tilted.get(), 0);
  // The lowest row: shoulders, hardly moved by a head that leans by 20 deg.
  const auto middle = [](const SimulatedWorld& world) {
    double sum = 0, count = 0;
    for (int x = 0; x < kWidth; ++x) {
      if (world.labels(0)[static_cast<std::size_t>((kHeight - 1) * kWidth + x)] !=
          static_cast<std::uint8_t>(Label::kClothes))
        continue;
      sum += x;
      ++count;
    }
    return sum / count;
  };
  EXPECT_NEAR(middle(*tilted), middle(*straight), 25);
}

TEST(SceneConfigTest, RefusesAnUnknownSubject) {
  SceneConfig scene;
  scene.subject = "nobody";
  ExpectRefusal([&] { scene.ValidateOrThrow(); }, "scene.subject", "nobody", "adult_a");
  scene = {};
  scene.second_head = "nobody";
  ExpectRefusal([&] { scene.ValidateOrThrow(); }, "scene.second_head", "nobody", "adult_a");
}

}  // namespace
}  // namespace visavis
