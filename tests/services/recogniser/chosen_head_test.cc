#include "services/recogniser/chosen_head.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "common/config/config_error.h"
#include "services/recogniser/head_file.h"
#include "services/recogniser/refined/adult_head.h"
#include "tests/support/head_obj.h"
#include "tests/support/temporary_folder.h"

namespace visavis {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;
using ::testing::AllOf;
using ::testing::HasSubstr;

TEST(ChosenHeadTest, TheDefaultIsTheGenericAdult) {
  const HeadGeometry head = ChosenHead({}, {});
  const HeadSurface& adult = TheAdult().surface;
  const Icosphere sphere(3);
  for (const Vector3f& d : sphere.vertices()) EXPECT_EQ(head.surface.Radius(d), adult.Radius(d));
  EXPECT_EQ(head.p_MR_m, AdultOrigin());
}

TEST(ChosenHeadTest, AnEllipsoidIsOneAboutTheOriginThatPosesAreToldFrom) {
  HeadChoice choice;
  choice.shape = "ellipsoid";
  const HeadModelConfig sizes;
  const HeadGeometry head = ChosenHead(choice, sizes);
  const Vector3d axes(1e-3 * sizes.semi_axis_x_mm, 1e-3 * sizes.semi_axis_y_mm,
                      1e-3 * sizes.semi_axis_z_mm);
  const Icosphere sphere(3);
  for (const Vector3f& d : sphere.vertices()) {
    const Vector3d p = (head.surface.Radius(d) * d).cast<double>() - head.p_MR_m;
    EXPECT_NEAR(p.cwiseQuotient(axes).norm(), 1, 1e-4);
  }
  // Its eyes are where the adult's are in M, and where the published model has them in R.
  EXPECT_NEAR(head.p_MR_m.y() + 1e-3 * sizes.eye_y_mm, AdultEyes().y(), 1e-6);
}

TEST(ChosenHeadTest, TheEllipsoidsHairIsBehindThePublishedPlane) {
  HeadChoice choice;
  choice.shape = "ellipsoid";
  const HeadModelConfig sizes;
  const HeadGeometry head = ChosenHead(choice, sizes);
  const double tilt = sizes.hair_tilt_deg * M_PI / 180;
  for (const Vector3d& p_R : {Vector3d(0.01, -0.08, 0.02), Vector3d(0, 0.03, -0.08)}) {
    const double beyond =
        -p_R.y() * std::cos(tilt) + p_R.z() * std::sin(tilt) - 1e-3 * sizes.hair_offset_mm;
    EXPECT_NEAR(head.surface.HairSide((p_R + head.p_MR_m).cast<float>()), beyond, 1e-6);
  }
}

TEST(ChosenHeadTest, ASphereHasItsRadius) {
  HeadChoice choice;
  choice.shape = "sphere";
  HeadModelConfig sizes;
  sizes.radius_mm = 100;
  const HeadGeometry head = ChosenHead(choice, sizes);
  const Vector3f front = head.surface.Radius({0, 0, -1}) * Vector3f(0, 0, -1);
  EXPECT_NEAR((front.cast<double>() - head.p_MR_m).norm(), 0.1, 1e-5);
}

TEST(ChosenHeadTest, EyesBesideTheSphereAreRefused) {
  HeadChoice choice;
  choice.shape = "sphere";
  HeadModelConfig sizes;
  sizes.radius_mm = 40;
  sizes.eye_x_mm = 39;
  EXPECT_THAT([&] { ChosenHead(choice, sizes); },
              ::testing::ThrowsMessage<FieldError>(HasSubstr("must have its eyes in front")));
}

TEST(ChosenHeadTest, ASphereThatHardlyHoldsThePointBehindItsEyesIsRefusedByItsKey) {
  HeadChoice choice;
  choice.shape = "sphere";
  HeadModelConfig sizes;
  for (const double radius_mm : {45.0, 49.0, 51.0}) {
    sizes.radius_mm = radius_mm;
    EXPECT_THAT([&] { ChosenHead(choice, sizes); },
                ::testing::ThrowsMessage<FieldError>(
                    AllOf(HasSubstr("refined.head.shape"), HasSubstr("head.radius_mm"))))
        << radius_mm;
  }
  sizes.radius_mm = 54;
  EXPECT_NO_THROW(ChosenHead(choice, sizes));
}

class HeadOfFileTest : public ::testing::Test {
 protected:
  void ExpectRefused(const HeadChoice& choice, const std::string& what) {
    EXPECT_THAT([&] { ChosenHead(choice, {}); },
                ::testing::ThrowsMessage<FieldError>(
                    AllOf(HasSubstr("refined.head.file: " + choice.file + ": "), HasSubstr(what))));
  }
  TemporaryFolder folder_;
};

TEST_F(HeadOfFileTest, PosesAreToldFromTheFilesOrigin) {
  HeadObj how;
  how.units_per_m = 100;
  how.shift_m = {0.1, 0.2, 0.3};
  HeadChoice choice;
  choice.file = WriteHeadObj(folder_.path(), TheAdult().surface, how);
  choice.scale = 0.01;
  EXPECT_EQ(ChosenHead(choice, {}).p_MR_m, AdultOrigin());
  choice.origin_m = {0.1, -0.21, -0.3};  // y up, z to the viewer
  EXPECT_LT((ChosenHead(choice, {}).p_MR_m - Vector3d(0, 0.01, 0)).norm(), 0.003);
}

TEST_F(HeadOfFileTest, AMeshIsThePersonsOwnUnlessToldOtherwise) {
  HeadChoice choice;
  EXPECT_FALSE(ChosenHead(choice, {}).is_measured);
  choice.file = WriteHeadObj(folder_.path(), TheAdult().surface, HeadObj{});
  EXPECT_TRUE(ChosenHead(choice, {}).is_measured);
  choice.measured = false;
  EXPECT_FALSE(ChosenHead(choice, {}).is_measured);
}

TEST_F(HeadOfFileTest, AYamlFileIsAHeadOfRadii) {
  HeadShape shape;
  shape.mouth_y = 0.08f;
  HeadChoice choice;
  choice.file = folder_ / "head.yaml";
  SaveHeadFile(choice.file, {HeadSurface(shape, TableOf(TheAdult().surface, 4)), {0, 0, 0.01}});
  const HeadGeometry head = ChosenHead(choice, {});
  EXPECT_NEAR(head.surface.shape().mouth_y, 0.08f, 1e-6f);
  EXPECT_NEAR(head.p_MR_m.z(), 0.01, 1e-9);
}

TEST_F(HeadOfFileTest, WhatIsNoHeadIsRefusedInOneLineThatNamesKeyFileAndRule) {
  HeadChoice choice;
  choice.file = "/nowhere/head.obj";
  ExpectRefused(choice, "Unable to open file");
  choice.file = "/nowhere/head.yaml";
  ExpectRefused(choice, "");
  choice.file = folder_ / "head.gltf";
  std::ofstream(choice.file) << "{\"asset\":{\"version\":\"2.0\"},\"meshes\":[{";
  ExpectRefused(choice, "");
  choice.file = folder_ / "broken.yaml";
  std::ofstream(choice.file) << "eye_x_mm: 31\nradii_mm: [1, 2]\n";
  ExpectRefused(choice, "line 2: radii_mm: 2 numbers: must be 162, 642");
  HeadObj how;
  how.leave_out = 5;
  choice.file = WriteHeadObj(folder_.path(), TheAdult().surface, how);
  ExpectRefused(choice, "is not closed");
  how = {};
  how.units_per_m = 1000;
  WriteHeadObj(folder_.path(), TheAdult().surface, how);
  ExpectRefused(choice, "m high: must be 0.12 to 0.45 m");
  how = {};
  how.material = [](const Vector3f&) { return std::string("Material.001"); };
  WriteHeadObj(folder_.path(), TheAdult().surface, how);
  ExpectRefused(choice, "material 'Material.001': must contain skin");
}

TEST_F(HeadOfFileTest, AnOriginOfTwoNumbersIsRefused) {
  HeadChoice choice;
  choice.origin_m = {0, 1};
  EXPECT_THAT([&] { ChosenHead(choice, {}); },
              ::testing::ThrowsMessage<FieldError>(
                  AllOf(HasSubstr("refined.head.origin_m"), HasSubstr("three numbers"))));
}

}  // namespace
}  // namespace visavis
