#include "services/recogniser/refined/head_bundle.h"

#include <gtest/gtest.h>

#include <cmath>

#include "common/core/random.h"
#include "services/recogniser/refined/adult_head.h"
#include "services/recogniser/refined/face_bundle.h"
#include "tests/support/mesh_scene.h"
#include "tests/support/stereo_scene.h"

namespace visavis {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

constexpr double kDistance_m = 1;
constexpr int kRounds = 8;

/// Another adult: up to 6 mm off the painted head.
HeadGeometry OtherHead() {
  HeadTable table = TableOf(SharedAdultHead().surface, 4);
  const Eigen::MatrixXd& modes = TheAdult().shape_modes_m;
  const Eigen::VectorXd off = 1.5 * (modes.col(1) - modes.col(2) + modes.col(4) - modes.col(6));
  for (std::size_t i = 0; i < table.radii_m.size(); ++i)
    table.radii_m[i] += static_cast<float>(off[static_cast<Eigen::Index>(i)]);
  return {HeadSurface(HeadShape{}, table), {0, 0, 0}};
}

/// The generic adult with a face that is 12 mm flatter.
HeadGeometry FlatHead() {
  HeadTable table = TableOf(SharedAdultHead().surface, 4);
  const Icosphere sphere(4);
  const auto& directions = sphere.vertices();
  for (std::size_t i = 0; i < directions.size(); ++i) {
    const float frontal = std::max(0.0f, -directions[i].z());
    table.radii_m[i] -= 0.012f * frontal * frontal * frontal * frontal;
  }
  return {HeadSurface(HeadShape{}, table), {0, 0, 0}};
}

const std::vector<Vector6d>& Views() {
  static const std::vector<Vector6d> views = {
      PhiOf(0, 0, 1000, 0, 0, 0),        PhiOf(30, -10, 980, 3, 14, 2),
      PhiOf(-30, 10, 1020, -3, -14, 0),  PhiOf(10, 20, 1000, 0, 3, 12),
      PhiOf(-10, -20, 1010, 2, -3, -12), PhiOf(20, 10, 990, -4, 10, 10),
      PhiOf(-20, -5, 1000, 0, -10, -9)};
  return views;
}

/// How the poses of a bundle lie to the truth.
struct PoseErrors {
  RigidTransform offset;               ///< mean, of the bundle's head frame in the painted one
  double position_m{0}, angle_rad{0};  ///< rms about it
};
PoseErrors ErrorsOf(const HeadBundle& bundle) {
  const auto n = static_cast<double>(bundle.num_views());
  Vector3d p = Vector3d::Zero(), w = Vector3d::Zero();
  std::vector<RigidTransform> offsets;
  for (std::size_t i = 0; i < bundle.num_views(); ++i) {
    offsets.push_back(TransformFromPhi(Views()[i]).inverse() * bundle.pose(i));
    p += offsets.back().translation() / n;
    w += LogRotation(offsets.back().linear()) / n;
  }
  double square_m = 0, square_rad = 0;
  for (const RigidTransform& X : offsets) {
    square_m += (X.translation() - p).squaredNorm() / n;
    square_rad += (LogRotation(X.linear()) - w).squaredNorm() / n;
  }
  return {MakeTransform(ExpRotation(w), p), std::sqrt(square_m), std::sqrt(square_rad)};
}

/// rms distance [m] of the face of @p head, its frame at @p offset, from the painted surface.
double ShapeError(const HeadGeometry& head, const RigidTransform& offset) {
  double sum = 0;
  for (const Vector3f& p : SharedAdultHead().face.points) {
    const Vector3d on_head = head.surface.Onto(p).cast<double>();
    const Vector3f painted = (offset * on_head).cast<float>();
    const float beyond = painted.norm() - SharedAdultHead().surface.Radius(painted.normalized());
    sum += static_cast<double>(beyond * beyond);
  }
  return std::sqrt(sum / static_cast<double>(SharedAdultHead().face.size()));
}

/// FeaturedHead's features on a skin of stronger grain.
Color Speckled(const Vector3f& p_M) {
  const Color featured = FeaturedHead(p_M);
  return featured[0] < 150 ? featured : GrainyHead(p_M);
}

class HeadBundleTest : public ::testing::Test {
 protected:
  HeadBundleTest() : scene_(TestRig()) { scene_.Show(TransformFromPhi(Views()[0]), GrainyHead); }

  StereoFrame Frame() const {
    StereoFrame frame;
    frame.right = scene_.picture(0);
    frame.left = scene_.picture(1);
    return frame;
  }
  HeadBundle Bundle(const HeadGeometry& head, Band compared = kBrightness) const {
    return {RefinerConfig{}, TestRig(), kDistance_m, head, {scene_.colors(0), scene_.colors(1)},
            compared};
  }
  /// Shows all views to @p bundle, at poses that are some millimetres and degrees off.
  void ShowAll(HeadBundle* bundle) {
    Random random(11);
    for (const Vector6d& phi : Views()) {
      const auto off = [&](double size) { return size * random.Normal(); };
      scene_.Show(TransformFromPhi(phi), Speckled);
      bundle->Add(Frame(), TransformFromPhi(phi + PhiOf(off(1.5), off(1.5), off(3), off(1),
                                                        off(1.5), off(1.5))));
    }
  }

  MeshScene scene_;
};

class EitherBandTest : public HeadBundleTest, public ::testing::WithParamInterface<Band> {};
INSTANTIATE_TEST_SUITE_P(Compared, EitherBandTest, ::testing::Values(kBrightness, kFineBand));

TEST_P(EitherBandTest, PosesShapeAndTextureComeToAgree) {
  HeadBundle bundle = Bundle(OtherHead(), GetParam());
  ShowAll(&bundle);
  ASSERT_EQ(bundle.num_views(), Views().size());
  const PoseErrors before = ErrorsOf(bundle);
  const HeadBundle::Agreement first = bundle.Round();
  HeadBundle::Agreement last;
  for (int i = 1; i < kRounds; ++i) last = bundle.Round();
  const PoseErrors after = ErrorsOf(bundle);
  EXPECT_LT(after.position_m, 0.2 * before.position_m);
  EXPECT_LT(after.angle_rad, 0.2 * before.angle_rad);
  EXPECT_GT(last.texture_ncc, first.texture_ncc + 0.03);
  EXPECT_GT(last.stereo_ncc, first.stereo_ncc);
  EXPECT_LT(last.contour_px, 0.8 * first.contour_px);
  EXPECT_LT(last.moved_m, 0.2 * first.moved_m);
  EXPECT_LT(ShapeError(bundle.Enrolled(), after.offset),
            0.6 * ShapeError(OtherHead(), after.offset));
  // The head's frame stays where the given poses put it in the mean.
  const RigidTransform moved = before.offset.inverse() * after.offset;
  EXPECT_LT(moved.translation().norm(), 0.003);
  EXPECT_LT(LogRotation(moved.linear()).norm(), 0.02);
}

TEST_F(HeadBundleTest, ARebasedShapeLeavesTheGenericOneFarther) {
  const auto error_after_rounds = [&](bool is_rebased) {
    HeadBundle bundle = Bundle(FlatHead());
    ShowAll(&bundle);
    for (int i = 0; i < kRounds; ++i) {
      if (is_rebased) bundle.Rebase();
      bundle.Round();
    }
    return ShapeError(bundle.Enrolled(), ErrorsOf(bundle).offset);
  };
  EXPECT_LT(error_after_rounds(true), 0.9 * error_after_rounds(false));
}

TEST_F(HeadBundleTest, TheEnrolledHeadHasAFaceOnItsSurfaceThatAViewNotGivenShowsToo) {
  HeadBundle bundle = Bundle(OtherHead());
  ShowAll(&bundle);
  for (int i = 0; i < kRounds; ++i) bundle.Round();
  const HeadGeometry head = bundle.Enrolled();
  ASSERT_TRUE(head.face);
  EXPECT_GT(head.face->points.size(), 400u);
  for (const Vector3f& p : head.face->points) {
    EXPECT_NEAR(p.norm(), head.surface.Radius(p.normalized()), 2e-6);
  }
  PreparedHead prepared(RefinerConfig{}, head);
  FaceTexture texture(prepared.face);
  texture.Remember(*head.face);
  const RigidTransform truth = TransformFromPhi(PhiOf(-5, 8, 1005, 1, 6, -5));
  const StereoView& view = scene_.Show(truth, Speckled);
  const RigidTransform expected = truth * ErrorsOf(bundle).offset;
  const Refined refined = prepared.refiner.Refine(view, expected, &texture, 8, 7);
  EXPECT_GT(refined.texture_ncc, 0.95);
  const RecognitionError error = ComputeRecognitionError(expected, refined.X_CM);
  EXPECT_LT(error.position.norm(), 0.001);
  EXPECT_LT(error.total_angle, 0.01);
}

TEST_F(HeadBundleTest, AMovedFrameMovesPosesAndShapeAlike) {
  HeadBundle bundle = Bundle(OtherHead());
  ShowAll(&bundle);
  bundle.Round();
  std::vector<RigidTransform> poses;
  for (std::size_t i = 0; i < bundle.num_views(); ++i) poses.push_back(bundle.pose(i));
  const HeadSurface surface_N = bundle.Enrolled().surface;
  const RigidTransform X_MN =
      MakeTransform(ExpRotation({0.03, -0.05, 0.04}), Vector3d(0.001, -0.002, 0.003));
  bundle.MoveFrame(X_MN);
  for (std::size_t i = 0; i < poses.size(); ++i)
    EXPECT_TRUE((bundle.pose(i) * X_MN).isApprox(poses[i], 1e-9)) << i;
  const HeadSurface surface = bundle.Enrolled().surface;
  double sum = 0, sum_unmoved = 0;
  const auto square = [](float x) { return static_cast<double>(x * x); };
  for (const Vector3f& p : SharedAdultHead().face.points) {
    const Vector3f on_N = surface_N.Onto(p);
    const Vector3f on_M = (X_MN * on_N.cast<double>()).cast<float>();
    sum += square(on_M.norm() - surface.Radius(on_M.normalized()));
    sum_unmoved += square(on_M.norm() - surface_N.Radius(on_M.normalized()));
  }
  // The radii are told anew every 7 mm, so that the nose's tip is cut a little.
  const auto n = static_cast<double>(SharedAdultHead().face.size());
  EXPECT_LT(std::sqrt(sum / n), 4e-4);
  EXPECT_GT(std::sqrt(sum_unmoved / n), 1.5e-3);
}

TEST_F(HeadBundleTest, AMeasuredSurfaceStaysAndItsTextureMovesToWhereItBelongs) {
  const RigidTransform X_off =
      MakeTransform(ExpRotation({0.03, -0.02, 0.02}), Vector3d(0.003, -0.004, 0.002));
  const auto after_rounds = [&](bool is_measured, HeadGeometry* enrolled) {
    HeadGeometry head{SharedAdultHead().surface};
    head.is_measured = is_measured;
    HeadBundle bundle = Bundle(head);
    for (const Vector6d& phi : Views()) {
      scene_.Show(TransformFromPhi(phi), Speckled);
      bundle.Add(Frame(), TransformFromPhi(phi) * X_off);
    }
    for (int i = 0; i < kRounds; ++i) bundle.Round();
    *enrolled = bundle.Enrolled();
    return ErrorsOf(bundle);
  };
  HeadGeometry kept, moved;
  const PoseErrors measured = after_rounds(true, &kept), free = after_rounds(false, &moved);
  EXPECT_LT(measured.offset.translation().norm(), 0.001);
  EXPECT_LT(LogRotation(measured.offset.linear()).norm(), 0.01);
  EXPECT_GT(LogRotation(free.offset.linear()).norm(), 0.02);
  EXPECT_TRUE(kept.is_measured);
  for (const Vector3f& p : SharedAdultHead().face.points)
    EXPECT_EQ(kept.surface.Radius(p), SharedAdultHead().surface.Radius(p));
}

TEST_F(HeadBundleTest, TheFaceDoesNotMoveTheFrameOfAMeasuredHead) {
  const FaceFrame finder(TheAdult());
  HeadGeometry head = OtherHead();
  head.is_measured = true;
  HeadBundle bundle = Bundle(head);
  ShowAll(&bundle);
  BundleFace(finder, 1, 1, &bundle);
  const HeadGeometry enrolled = bundle.Enrolled();
  for (const Vector3f& p : SharedAdultHead().face.points)
    EXPECT_EQ(enrolled.surface.Radius(p), head.surface.Radius(p));
  EXPECT_THROW(bundle.MoveFrame(RigidTransform::Identity()), std::invalid_argument);
}

TEST_F(HeadBundleTest, TheSameViewsGiveTheSameHeadBitForBit) {
  HeadBundle one = Bundle(OtherHead()), other = Bundle(OtherHead());
  for (HeadBundle* bundle : {&one, &other}) {
    ShowAll(bundle);
    for (int i = 0; i < 2; ++i) bundle->Round();
  }
  for (std::size_t i = 0; i < Views().size(); ++i)
    EXPECT_EQ(one.pose(i).matrix(), other.pose(i).matrix());
  EXPECT_EQ(one.Enrolled().face->points, other.Enrolled().face->points);
  EXPECT_EQ(one.Enrolled().face->value, other.Enrolled().face->value);
}

TEST_F(HeadBundleTest, APairWithoutBothEyesIsRefusedAndLeavesNoView) {
  HeadBundle bundle = Bundle(OtherHead());
  for (const std::size_t missing : {0, 1}) {
    StereoFrame frame = Frame();
    (missing == 0 ? frame.right : frame.left).reset();
    EXPECT_THROW(bundle.Add(frame, TransformFromPhi(Views()[0])), std::invalid_argument);
    EXPECT_EQ(bundle.num_views(), 0u);
  }
}

}  // namespace
}  // namespace visavis
