#include "tests/support/board_scene.h"

#include <cmath>

namespace visavis {
namespace {

constexpr double kDegree = M_PI / 180;

BoardView SeeWith(const Board& board, const Pinhole& camera, const RigidTransform& X_KT,
                  double noise_px, Random* random) {
  BoardView view;
  for (std::size_t i = 0; i < board.corners().size(); ++i) {
    const Projection projection = Project(camera, X_KT * board.corners()[i]);
    const Eigen::Vector2d noise(noise_px * random->Normal(), noise_px * random->Normal());
    const Eigen::Vector2d uv = projection.uv + noise;
    if (!projection.valid || uv.x() < 2 || uv.y() < 2 || uv.x() > camera.width - 3 ||
        uv.y() > camera.height - 3)
      continue;
    view.ids.push_back(static_cast<int>(i));
    view.pixels.push_back(uv);
  }
  return view;
}

/// The board before the right camera, its middle near pixel @p uv.
RigidTransform PlaceBoard(const Board& board, const Pinhole& camera, Random* random) {
  const double fill = random->Uniform(0.75, 1.15);
  const double z = camera.fx * board.width_m() / (fill * camera.width);
  const Eigen::Vector2d uv(camera.cx + camera.width * random->Uniform(-0.15, 0.15),
                           camera.cy + camera.height * random->Uniform(-0.15, 0.15));
  const double direction = random->Uniform(0, 2 * M_PI), tilt = kDegree * random->Uniform(10, 40);
  const Eigen::Matrix3d R_CT =
      ExpRotation({tilt * std::cos(direction), tilt * std::sin(direction), 0}) *
      ExpRotation({0, 0, kDegree * random->Uniform(-30, 30)});
  const Eigen::Vector3d middle(0.5 * board.width_m(), 0.5 * board.height_m(), 0);
  return MakeTransform(R_CT, z * Unproject(camera, uv) - R_CT * middle);
}

}  // namespace

StereoRig SkewedRig() {
  StereoRig rig;
  rig.right = {640, 480, 802.3, 801.1, 322.7, 236.4, {-0.11, 0.09, 0.0008, -0.0005, 0.02}};
  rig.left = {640, 480, 797.6, 798.2, 315.2, 243.9, {-0.10, 0.08, -0.0006, 0.0007, 0.01}};
  rig.X_CL = MakeTransform(ExpRotation({0.004, 0.021, -0.006}), {-0.1507, 0.0013, 0.0021});
  return rig;
}

BoardSpec SmallBoard(int columns, int rows) {
  BoardSpec spec;
  spec.columns = columns;
  spec.rows = rows;
  spec.square_mm = 60;
  spec.marker_mm = 45;
  return spec;
}

BoardScene MakeBoardScene(const BoardSpec& spec, int num_views, std::uint64_t seed) {
  Random random(seed);
  BoardScene scene{Board(spec), SkewedRig(), {}, {}, {}, {}};
  scene.X_HC = MakeTransform(ExpRotation({0.7, -1.1, 0.4}), {0.031, 0.068, 0.059});
  scene.X_BT = MakeTransform(ExpRotation({0.2, 2.5, -0.3}), {0.9, -0.2, 0.4});
  for (int i = 0; i < num_views; ++i) {
    scene.X_CT.push_back(PlaceBoard(scene.board, scene.rig.right, &random));
    scene.X_BH.push_back(scene.X_BT * (scene.X_HC * scene.X_CT.back()).inverse());
  }
  return scene;
}

StereoView SeeCorners(const BoardScene& scene, const RigidTransform& X_CT, double noise_px,
                      Random* random) {
  StereoView view;
  view.right = SeeWith(scene.board, scene.rig.right, X_CT, noise_px, random);
  view.left =
      SeeWith(scene.board, scene.rig.left, scene.rig.X_CL.inverse() * X_CT, noise_px, random);
  return view;
}

std::vector<ArmView> SeeAll(const BoardScene& scene, double noise_px, std::uint64_t seed) {
  Random random(seed);
  std::vector<ArmView> views;
  for (std::size_t i = 0; i < scene.X_CT.size(); ++i) {
    views.push_back({SeeCorners(scene, scene.X_CT[i], noise_px, &random), scene.X_BH[i]});
    views.back().view.utime_us = 1'000'000 * static_cast<std::int64_t>(i);
  }
  return views;
}

}  // namespace visavis
