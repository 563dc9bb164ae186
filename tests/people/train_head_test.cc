#include <gmock/gmock.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

#include "services/recogniser/refined/adult_head.h"
#include "services/recogniser/refined/icosphere.h"
#include "tests/people/hair_border.h"
#include "tests/people/head_alignment.h"
#include "tests/people/looks_training.h"
#include "tests/people/trained_head.h"
#include "tests/people/weighted.h"

namespace visavis {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

/// The surface of the generic adult, whose T is its M, seen from M elsewhere.
float AdultRadius(const RigidTransform& X_TM, const Vector3f& direction) {
  const HeadSurface& surface = TheAdult().surface;
  float inside = 0, outside = 0.3f;
  for (int k = 0; k < 24; ++k) {
    const float middle = 0.5f * (inside + outside);
    const Vector3f p_T = (X_TM * (middle * direction).cast<double>()).cast<float>();
    (p_T.norm() < surface.Radius(p_T.normalized()) ? inside : outside) = middle;
  }
  return inside;
}

FaceRegion AdultFace() {
  return FaceRegionOf([](const Vector3f& d) { return TheAdult().surface.Radius(d); });
}

RigidTransform Displaced(double y_m, double z_m, double nod_rad) {
  return MakeTransform(ExpRotation({nod_rad, 0, 0}), Vector3d(0, y_m, z_m));
}

TEST(HeadAlignmentTest, FindsHowAHeadWasDisplaced) {
  const RigidTransform X_TM = AlignHead(&AdultRadius, AdultFace(), Displaced(0.006, -0.004, 0.05));
  EXPECT_LT(X_TM.translation().norm(), 1e-4);
  EXPECT_LT(LogRotation(X_TM.linear()).norm(), 1e-3);
}

TEST(HeadAlignmentTest, LaysAllHeadsAlikeAndTheirMeanOnTheFace) {
  std::vector<HeadToAlign> heads;
  for (const double off : {-1.0, 0.2, 0.8}) {
    heads.push_back({&AdultRadius, Displaced(0.004 * off, 0.003 * off, -0.04 * off), 1 + off / 2});
  }
  AlignHeads(AdultFace(), &heads);
  for (const HeadToAlign& head : heads) {
    EXPECT_LT(head.X_TM.translation().norm(), 2e-4);
    EXPECT_LT(LogRotation(head.X_TM.linear()).norm(), 2e-3);
  }
}

TEST(HairBorderTest, TellsTheDistanceToWhereHalfHaveHair) {
  const Icosphere sphere(4);
  const std::vector<float> radii(sphere.vertices().size(), 0.1f);
  std::vector<double> share;
  for (const Vector3f& d : sphere.vertices())
    share.push_back(0.5 - 0.5 * static_cast<double>(d.y()));
  const std::vector<float> sides = HairSides(sphere, radii, share);
  for (std::size_t i = 0; i < sides.size(); ++i) {
    const Vector3f p = 0.1f * sphere.vertices()[i];
    const float chord = std::hypot(p.y(), 0.1f - std::hypot(p.x(), p.z()));
    EXPECT_NEAR(sides[i], p.y() < 0 ? chord : -chord, 2e-4f);
  }
}

TEST(WeightedValuesTest, OutliersCountUpToTheCap) {
  WeightedValues values;
  for (const double x : {-1.0, 1.0, -1.0, 1.0, -1.0, 1.0, -1.0, 1.0}) values.Add(x, 1);
  values.Add(1000, 0.01);
  EXPECT_EQ(values.Median(), 1);
  EXPECT_NEAR(values.Deviation(0, 2.5), 1, 0.01);
}

TEST(WeightedValuesTest, ModesAreStandardDeviationsAlongTheAxesOfMostVariance) {
  Eigen::MatrixXd columns(3, 4);
  columns << 2, -2, 0, 0, 0, 0, 1, -1, 0, 0, 0, 0;
  const Eigen::MatrixXd modes = PrincipalModes(columns, Eigen::VectorXd::Constant(4, 0.25), 2);
  EXPECT_NEAR(modes(0, 0), std::sqrt(2.0), 1e-9);
  EXPECT_NEAR(modes(1, 1), std::sqrt(0.5), 1e-9);
  EXPECT_NEAR(modes.squaredNorm(), 2.5, 1e-9);
}

TEST(LooksTrainingTest, FindsMeanAndModeUnderAnyLight) {
  const LooksGrid grid;
  const int unseen = 20 + 5 * grid.columns;
  // Without mean and correlation: those are taken for light.
  const auto wave = [&](int i, int count, int periods) {
    return std::cos(2 * M_PI * periods * (i + 0.5) / count);
  };
  const auto mean = [&](int cell) { return wave(grid.row(cell), grid.rows, 3); };
  const auto mode = [&](int cell) { return wave(grid.column(cell), grid.columns, 2); };
  std::vector<RecordedLooks> recordings;
  for (int r = 0; r < 30; ++r) {
    RecordedLooks& recording = recordings.emplace_back();
    recording.weight = 1.0 / 30;
    for (int v = 0; v < 4; ++v) {
      LooksView& view = recording.views.emplace_back();
      for (std::vector<float>& values : view) {
        for (int cell = 0; cell < grid.size(); ++cell) {
          const double look = mean(cell) + (r % 2 == 0 ? 0.3 : -0.3) * mode(cell);
          values.push_back(static_cast<float>((3 + r + v) * look + 7 * v - r));
        }
        values[unseen] = std::numeric_limits<float>::quiet_NaN();
      }
    }
  }
  const LooksModel model = TrainLooks(grid, recordings, std::vector<bool>(grid.size(), true));
  EXPECT_FALSE(model.known[unseen]);
  const double scale = model.mean[kFineBand][0] / mean(0);
  for (int cell = 0; cell < grid.size(); ++cell) {
    if (cell == unseen) continue;
    EXPECT_NEAR(model.mean[kFineBand][cell], scale * mean(cell), 0.02 * scale);
    EXPECT_NEAR(model.mean[kCoarseBand][cell], model.mean[kFineBand][cell], 1e-6);
    EXPECT_NEAR(std::abs(model.modes(cell, 0)), std::abs(0.3 * scale * mode(cell)), 0.03 * scale);
  }
}

/// The adult as it was read.
TrainedHead AdultAsTrained() {
  const AdultHead& adult = TheAdult();
  TrainedHead head;
  const Icosphere sphere(Icosphere::LevelOf(static_cast<std::size_t>(adult.shape_modes_m.rows())));
  for (const Vector3f& d : sphere.vertices()) {
    const float radius = adult.surface.Radius(d);
    head.shape.table.radii_m.push_back(radius);
    head.shape.table.sigma_m.push_back(adult.surface.Sigma(d));
    head.shape.table.hair_side_m.push_back(adult.surface.HairSide(radius * d));
  }
  std::vector<Eigen::Index> rows;
  for (Eigen::Index i = 0; i < adult.shape_modes_m.rows(); ++i) {
    if (!adult.shape_modes_m.row(i).isZero()) rows.push_back(i);
  }
  head.shape.modes_m.resize(static_cast<Eigen::Index>(rows.size()), adult.shape_modes_m.cols());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    head.shape.region.push_back(static_cast<int>(rows[i]));
    head.shape.modes_m.row(static_cast<Eigen::Index>(i)) = adult.shape_modes_m.row(rows[i]);
  }
  const AdultLooks& looks = adult.looks;
  head.looks.grid = {looks.columns, looks.rows, looks.left_m, looks.top_m, looks.step_m};
  const int n = head.looks.grid.size();
  for (std::size_t band = 0; band < kNumBands; ++band)
    head.looks.mean[band] = head.looks.doubt[band] = Eigen::VectorXd::Zero(n);
  head.looks.modes.resize(n, AdultLooks::kModes);
  for (int i = 0; i < n; ++i) {
    const AdultLooks::Place& cell = looks.cells[static_cast<std::size_t>(i)];
    head.looks.known.push_back(cell.known);
    for (std::size_t band = 0; band < kNumBands; ++band) {
      head.looks.mean[band][i] = static_cast<double>(cell.mean[band]);
      head.looks.doubt[band][i] = static_cast<double>(cell.doubt);
    }
    for (std::size_t k = 0; k < AdultLooks::kModes; ++k)
      head.looks.modes(i, static_cast<Eigen::Index>(k)) = static_cast<double>(cell.modes[k]);
  }
  return head;
}

TEST(TrainedHeadTest, IsWrittenAsItIsRead) {
  const TrainedHead head = AdultAsTrained();
  std::stringstream written;
  WriteHead(head, &written);
  std::ifstream file(std::string(std::getenv("VISAVIS_SOURCE_DIR")) +
                     "/services/recogniser/refined/adult_head.dat");
  ASSERT_TRUE(file);
  // The doubts of the coarse band are not read.
  const auto first_look = static_cast<int>(1 + 3 * head.shape.table.radii_m.size() + 5);
  const int cells = head.looks.grid.size();
  double expected = 0, value = 0;
  int number = 0;
  for (; file >> expected; ++number) {
    ASSERT_TRUE(written >> value) << number;
    const int look = number - first_look;
    if (look >= 2 * cells && look < 4 * cells && look % 2 == 1) continue;
    ASSERT_NEAR(value, expected, 1e-9) << number;
  }
  EXPECT_FALSE(written >> value);
  EXPECT_GT(number, first_look + 16 * cells);
}

}  // namespace
}  // namespace visavis
