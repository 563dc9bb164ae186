#include "services/recogniser/head_model.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "common/config/config_reader.h"
#include "tests/support/config_refusal.h"
#include "tests/support/stereo_scene.h"

namespace visavis {
namespace {

HeadModelConfig AHead(const std::string& shape) {
  HeadModelConfig head = TestHead();
  head.shape = shape;
  head.radius_mm = 95;
  return head;
}

class HeadModelTest : public ::testing::TestWithParam<const char*> {
 protected:
  const HeadModelConfig config_ = AHead(GetParam());
  const HeadModel model_{config_};
};
INSTANTIATE_TEST_SUITE_P(Shapes, HeadModelTest, ::testing::Values("sphere", "ellipsoid"),
                         [](const auto& tested) { return std::string(tested.param); });

TEST_P(HeadModelTest, EverySetFillsWholeVectorsOfTheKernel) {
  for (const int n :
       {model_.num_in(), model_.num_out(), model_.num_feature_in(), model_.num_feature_out()}) {
    EXPECT_GT(n, 0);
    EXPECT_EQ(n % HeadModel::kLanes, 0) << n;
  }
  EXPECT_EQ(model_.num_points(), model_.num_in() + model_.num_out() + model_.num_feature_in() +
                                     model_.num_feature_out());
}

TEST_P(HeadModelTest, HasAtLeast400PointsACameraSo800AStereoEvaluation) {
  EXPECT_GE(model_.num_points(), 400);
}

TEST_P(HeadModelTest, SInLiesInsideTheOutlineAndSOutOutsideWithinItsWidth) {
  for (int i = 0; i < model_.num_in(); ++i) {
    EXPECT_LT(std::hypot(model_.in_u[i], model_.in_v[i]), 1);
  }
  for (int i = 0; i < model_.num_out(); ++i) {
    const double radius = std::hypot(model_.out_u[i], model_.out_v[i]);
    EXPECT_GT(radius, 1);
    EXPECT_LT(radius, 1 + config_.outline_width);
  }
}

// Of a uniform set every ring has its share of points by area and every sector by angle.
TEST_P(HeadModelTest, SInIsUniformOverTheDisc) {
  constexpr int kRings = 4, kSectors = 6;
  std::array<int, kRings> rings{};
  std::array<int, kSectors> sectors{};
  double sum_u2 = 0, sum_v2 = 0, sum_uv = 0;
  for (int i = 0; i < model_.num_in(); ++i) {
    const double u = model_.in_u[i], v = model_.in_v[i];
    ++rings[static_cast<int>((u * u + v * v) * kRings)];
    // A small turn keeps points off the sectors' borders.
    ++sectors[static_cast<int>((std::atan2(v, u) + M_PI) / (2 * M_PI) * kSectors + 0.1) % kSectors];
    sum_u2 += u * u;
    sum_v2 += v * v;
    sum_uv += u * v;
  }
  for (const int n : rings) EXPECT_EQ(n, model_.num_in() / kRings);
  for (const int n : sectors) EXPECT_EQ(n, model_.num_in() / kSectors);
  // Second moments of the unit disc: 1/4, 1/4, 0.
  EXPECT_NEAR(sum_u2 / model_.num_in(), 0.25, 0.005);
  EXPECT_NEAR(sum_v2 / model_.num_in(), 0.25, 0.005);
  EXPECT_NEAR(sum_uv / model_.num_in(), 0, 1e-6);
}

TEST_P(HeadModelTest, SInHasNoPointTwice) {
  std::set<std::pair<float, float>> points;
  for (int i = 0; i < model_.num_in(); ++i) points.insert({model_.in_u[i], model_.in_v[i]});
  EXPECT_EQ(points.size(), model_.in_u.size());
}

double AngleFromStraightDownDeg(double u, double v) {
  return std::abs(std::atan2(u, v)) * 180 / M_PI;
}

TEST_P(HeadModelTest, SOutSparesTheNecksSectorAndNothingElse) {
  for (const double gap_deg : {0.0, 60.0, 180.0}) {
    HeadModelConfig config = config_;
    config.chin_gap_deg = gap_deg;
    const HeadModel model(config);
    double nearest_deg = 180, sum_u = 0;
    for (int i = 0; i < model.num_out(); ++i) {
      nearest_deg = std::min(nearest_deg, AngleFromStraightDownDeg(model.out_u[i], model.out_v[i]));
      sum_u += model.out_u[i];
    }
    const double spacing_deg = (360 - gap_deg) * 2 / model.num_out();  // two rings
    EXPECT_GE(nearest_deg, gap_deg / 2);
    EXPECT_LE(nearest_deg, gap_deg / 2 + spacing_deg);
    EXPECT_NEAR(sum_u, 0, 1e-4);
  }
}

TEST_P(HeadModelTest, FeaturesLieOnTheFrontOfTheSurface) {
  const Eigen::Vector3d a = model_.semi_axes_m();
  for (std::size_t i = 0; i < model_.feature_x.size(); ++i) {
    const Eigen::Vector3d p(model_.feature_x[i], model_.feature_y[i], model_.feature_z[i]);
    EXPECT_NEAR(p.cwiseQuotient(a).squaredNorm(), 1, 1e-5);
    EXPECT_LT(p.z(), 0);
  }
}

TEST_P(HeadModelTest, FeaturesOfTheFrontAreNoHair) {
  for (std::size_t i = 0; i < model_.feature_x.size(); ++i) {
    const Eigen::Vector3d p(model_.feature_x[i], model_.feature_y[i], model_.feature_z[i]);
    EXPECT_LT(model_.hair_normal().dot(p), model_.hair_offset_m());
  }
}

// Whether each point has its mirror image in the set.
bool IsSymmetric(std::vector<std::array<float, 3>> points) {
  const auto near = [](const std::array<float, 3>& a, const std::array<float, 3>& b) {
    return std::abs(a[0] + b[0]) < 1e-6 && std::abs(a[1] - b[1]) < 1e-6 &&
           std::abs(a[2] - b[2]) < 1e-6;
  };
  return std::all_of(points.begin(), points.end(), [&](const auto& p) {
    return std::count_if(points.begin(), points.end(), [&](const auto& q) { return near(p, q); }) ==
           1;
  });
}

TEST_P(HeadModelTest, EverySetIsLeftRightSymmetric) {
  std::vector<std::array<float, 3>> in, out, feature_in, feature_out;
  for (std::size_t i = 0; i < model_.in_u.size(); ++i)
    in.push_back({model_.in_u[i], model_.in_v[i]});
  for (std::size_t i = 0; i < model_.out_u.size(); ++i)
    out.push_back({model_.out_u[i], model_.out_v[i]});
  for (std::size_t i = 0; i < model_.feature_x.size(); ++i) {
    auto& set = static_cast<int>(i) < model_.num_feature_in() ? feature_in : feature_out;
    set.push_back({model_.feature_x[i], model_.feature_y[i], model_.feature_z[i]});
  }
  EXPECT_TRUE(IsSymmetric(in));
  EXPECT_TRUE(IsSymmetric(out));
  EXPECT_TRUE(IsSymmetric(feature_in));
  EXPECT_TRUE(IsSymmetric(feature_out));
}

TEST_P(HeadModelTest, FInLiesWithinEyesAndBrowsAndFOutBeside) {
  const auto& c = config_;
  for (std::size_t i = 0; i < model_.feature_x.size(); ++i) {
    const double x = 1e3 * std::abs(model_.feature_x[i]), y = 1e3 * model_.feature_y[i];
    const bool in_eye = std::hypot((x - c.eye_x_mm) / c.eye_half_width_mm,
                                   (y - c.eye_y_mm) / c.eye_half_height_mm) < 1;
    const double s = (x - c.brow_inner_x_mm) / (c.brow_outer_x_mm - c.brow_inner_x_mm);
    const double brow_y = c.brow_y_mm - c.brow_arch_mm * (1 - (2 * s - 1) * (2 * s - 1));
    const bool in_brow = s > 0 && s < 1 && std::abs(y - brow_y) < c.brow_half_height_mm;
    EXPECT_EQ(in_eye || in_brow, static_cast<int>(i) < model_.num_feature_in()) << x << ' ' << y;
  }
}

TEST_P(HeadModelTest, ThePlaneOfChLeansBackByItsTilt) {
  EXPECT_NEAR(model_.hair_normal().norm(), 1, 1e-12);
  EXPECT_NEAR(std::atan2(model_.hair_normal().z(), -model_.hair_normal().y()) * 180 / M_PI,
              config_.hair_tilt_deg, 1e-9);
  EXPECT_DOUBLE_EQ(model_.hair_offset_m(), config_.hair_offset_mm / 1000);
  // Up (y < 0) and back (z > 0) is hair, the chin is not.
  const Eigen::Vector3d a = model_.semi_axes_m();
  EXPECT_GT(model_.hair_normal().dot(Eigen::Vector3d(0, -a.y(), 0)), model_.hair_offset_m());
  EXPECT_GT(model_.hair_normal().dot(Eigen::Vector3d(0, 0, a.z())), model_.hair_offset_m());
  EXPECT_LT(model_.hair_normal().dot(Eigen::Vector3d(0, a.y(), 0)), model_.hair_offset_m());
}

TEST(HeadModelShapeTest, ASphereHasItsRadiusOnAllAxes) {
  HeadModelConfig config = AHead("sphere");
  config.radius_mm = 101;
  EXPECT_TRUE(HeadModel(config).semi_axes_m().isApprox(Eigen::Vector3d::Constant(0.101)));
}

TEST(HeadModelShapeTest, AnEllipsoidHasItsThreeSemiAxes) {
  EXPECT_TRUE(
      HeadModel(AHead("ellipsoid")).semi_axes_m().isApprox(Eigen::Vector3d(0.080, 0.108, 0.098)));
}

void ExpectHeadRefusal(const std::function<void(HeadModelConfig*)>& change, const std::string& key,
                       const std::string& value, const std::string& rule) {
  for (const char* shape : {"sphere", "ellipsoid"}) {
    HeadModelConfig config = AHead(shape);
    change(&config);
    ExpectRefusal([&] { config.ValidateOrThrow("head."); }, "head." + key, value, rule);
    ExpectRefusal([&] { HeadModel model(config); }, "head." + key, value, rule);
  }
}

TEST(HeadModelConfigTest, ABrowThatEndsBeforeItBeginsIsRefused) {
  ExpectHeadRefusal([](auto* c) { c->brow_outer_x_mm = 13; }, "brow_outer_x_mm", "13",
                    "must exceed brow_inner_x_mm");
}

TEST(HeadModelConfigTest, ABrowBelowTheEyeIsRefused) {
  ExpectHeadRefusal([](auto* c) { c->brow_y_mm = 20; }, "brow_y_mm", "20", "above the eye");
}

TEST(HeadModelConfigTest, AnEyeBesideTheHeadIsRefused) {
  ExpectHeadRefusal([](auto* c) { c->eye_x_mm = 60, c->eye_half_width_mm = 20; }, "eye_x_mm", "60",
                    "front of the head");
}

TEST(HeadModelConfigTest, AnEyeBelowTheHeadIsRefused) {
  ExpectHeadRefusal(
      [](auto* c) {
        c->radius_mm = c->semi_axis_x_mm = c->semi_axis_y_mm = 70;
        c->eye_y_mm = 60, c->eye_x_mm = 10, c->eye_half_width_mm = 4, c->eye_half_height_mm = 15;
        c->brow_outer_x_mm = 30;
      },
      "eye_x_mm", "10", "front of the head");
}

TEST(HeadModelConfigTest, ABrowBesideTheHeadIsRefused) {
  ExpectHeadRefusal([](auto* c) { c->brow_outer_x_mm = 80, c->radius_mm = c->semi_axis_x_mm = 75; },
                    "brow_outer_x_mm", "80", "front of the head");
}

TEST(HeadModelConfigTest, ABrowWhoseArchLeavesTheHeadIsRefused) {
  ExpectHeadRefusal(
      [](auto* c) {
        c->radius_mm = c->semi_axis_x_mm = c->semi_axis_y_mm = 80;
        c->brow_y_mm = -60, c->brow_arch_mm = 20, c->brow_half_height_mm = 10;
        c->brow_outer_x_mm = 20;
      },
      "brow_outer_x_mm", "20", "front of the head");
}

TEST(HeadModelConfigTest, AHairPlaneThatMissesTheHeadIsRefused) {
  ExpectHeadRefusal([](auto* c) { c->hair_offset_mm = -112; }, "hair_offset_mm", "-112",
                    "must cut the head");
}

// Along z the ellipsoid may be thinner than along x and y: there the plane must cut it, too.
TEST(HeadModelConfigTest, AHairPlaneBehindAFlatHeadIsRefused) {
  HeadModelConfig config = AHead("ellipsoid");
  config.semi_axis_z_mm = 60;
  config.hair_tilt_deg = 90;
  config.hair_offset_mm = 70;
  ExpectRefusal([&] { config.ValidateOrThrow("head."); }, "head.hair_offset_mm", "70",
                "must cut the head");
}

// Whatever the rules of single keys and between keys let pass makes a model.
TEST(HeadModelConfigTest, EveryHeadThatPassesTheRulesMakesAModel) {
  int taken = 0;
  for (const char* shape : {"sphere", "ellipsoid"}) {
    for (const double size : {60.0, 80.0, 110.0}) {
      for (const double eye_y : {-20.0, 20.0, 60.0}) {
        for (const double brow_above : {5.0, 40.0, 75.0}) {
          for (const double arch : {-10.0, 20.0}) {
            for (const double half : {1.0, 10.0}) {
              HeadModelConfig c = AHead(shape);
              c.radius_mm = c.semi_axis_x_mm = c.semi_axis_y_mm = c.semi_axis_z_mm = size;
              c.eye_y_mm = eye_y, c.brow_y_mm = eye_y - brow_above;
              c.brow_arch_mm = arch, c.brow_half_height_mm = half;
              c.brow_outer_x_mm = 20, c.eye_x_mm = 10, c.eye_half_width_mm = half;
              try {
                c.ValidateOrThrow("head.");
              } catch (const FieldError&) {
                continue;
              }
              ++taken;
              EXPECT_NO_THROW(HeadModel model(c)) << shape << size << ' ' << eye_y << ' '
                                                  << brow_above << ' ' << arch << ' ' << half;
            }
          }
        }
      }
    }
  }
  EXPECT_GT(taken, 20);
}

struct HeadFile {
  template <typename A>
  void Serialize(A* a) {
    a->Visit("head", &head);
  }
  void ValidateOrThrow() const {}
  HeadModelConfig head;
};

// A rule of one key, as the loader holds it: key, value and rule stand in the line.
TEST(HeadModelConfigTest, EachKeyHoldsItsRange) {
  const std::pair<const char*, const char*> refused[] = {{"shape", "cube"},
                                                         {"radius_mm", "39"},
                                                         {"radius_mm", "201"},
                                                         {"semi_axis_x_mm", "39"},
                                                         {"semi_axis_y_mm", "201"},
                                                         {"semi_axis_z_mm", "0.09"},
                                                         {"hair_tilt_deg", "91"},
                                                         {"hair_offset_mm", "151"},
                                                         {"chin_gap_deg", "-1"},
                                                         {"chin_gap_deg", "181"},
                                                         {"outline_width", "0.01"},
                                                         {"outline_width", "0.6"},
                                                         {"eye_x_mm", "9"},
                                                         {"eye_y_mm", "81"},
                                                         {"eye_half_width_mm", "3"},
                                                         {"brow_y_mm", "-81"},
                                                         {"eye_half_height_mm", "16"},
                                                         {"brow_inner_x_mm", "1"},
                                                         {"brow_outer_x_mm", "81"},
                                                         {"brow_half_height_mm", "11"},
                                                         {"brow_arch_mm", "21"},
                                                         {"radius_mm", ".nan"}};
  for (const auto& [key, value] : refused) {
    const std::string assignment = std::string("head.") + key + "=" + value;
    EXPECT_THAT([&] { LoadConfig<HeadFile>("", {assignment}); },
                ::testing::ThrowsMessage<ConfigError>(
                    ::testing::AllOf(::testing::HasSubstr(key), ::testing::HasSubstr(value),
                                     ::testing::HasSubstr("must be"))))
        << assignment;
  }
}

}  // namespace
}  // namespace visavis
