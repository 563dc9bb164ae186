#include "services/recogniser/mesh_head.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "services/recogniser/joined_mesh.h"
#include "services/recogniser/refined/head_mesh.h"
#include "tests/support/head_obj.h"
#include "tests/support/mesh_scene.h"
#include "tests/support/temporary_folder.h"

namespace visavis {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;
using ::testing::AllOf;
using ::testing::HasSubstr;

class MeshHeadTest : public ::testing::Test {
 protected:
  HeadGeometry Load(const HeadObj& how = {}, const MeshFileOptions& options = {}) {
    const std::string file = WriteHeadObj(folder_.path(), SharedAdultHead().surface, how);
    return HeadFromMesh(LoadLabelledMesh(file, options), &p_M_of_mesh_);
  }
  void ExpectRefused(const HeadObj& how, const std::string& what, const std::string& rule,
                     const MeshFileOptions& options = {}) {
    EXPECT_THAT([&] { Load(how, options); }, ::testing::ThrowsMessage<std::invalid_argument>(
                                                 AllOf(HasSubstr(what), HasSubstr(rule))));
  }
  TemporaryFolder folder_;
  Vector3d p_M_of_mesh_;
};

/// Greatest and mean difference of the radii [m], off nose and eyes.
void ExpectAlike(const HeadSurface& a, const HeadSurface& b, double most, double mean) {
  const Icosphere sphere(3);
  double sum = 0;
  for (const Vector3f& d : sphere.vertices()) {
    const auto error = std::abs(static_cast<double>(a.Radius(d) - b.Radius(d)));
    EXPECT_LT(error, most) << d.transpose();
    sum += error;
  }
  EXPECT_LT(sum / static_cast<double>(sphere.vertices().size()), mean);
}

TEST_F(MeshHeadTest, TheAdultFromAFileIsTheAdult) {
  const HeadGeometry head = Load();
  const HeadSurface& adult = SharedAdultHead().surface;
  EXPECT_LT(p_M_of_mesh_.norm(), 0.003);  // its eyes are coarse
  ExpectAlike(head.surface, adult, 0.005, 0.001);
  EXPECT_NEAR(head.surface.shape().eye_x, adult.shape().eye_x, 0.002f);
  EXPECT_NEAR(head.surface.shape().brow_y, adult.shape().brow_y, 0.003f);
  EXPECT_NEAR(head.surface.shape().mouth_y, adult.shape().mouth_y, 0.003f);
  EXPECT_NEAR(head.surface.shape().nostril_y, adult.shape().nostril_y, 0.003f);
  EXPECT_EQ(head.p_MR_m, Vector3d::Zero());
}

TEST_F(MeshHeadTest, HairIsWhereTheMeshHasIt) {
  const HeadGeometry head = Load();
  const HeadSurface& adult = SharedAdultHead().surface;
  const Icosphere sphere(4);
  for (const Vector3f& d : sphere.vertices()) {
    const Vector3f p = adult.Radius(d) * d;
    const float side = adult.HairSide(p);
    if (p.y() > 0.09f) continue;  // the neck ends somewhere
    if (std::abs(side) > 0.008f) {
      EXPECT_EQ(head.surface.HairSide(d) > 0, side > 0) << d.transpose();
    }
    if (std::abs(side) < 0.03f) {
      EXPECT_NEAR(head.surface.HairSide(d), side, 0.02f) << d.transpose();
    }
  }
  EXPECT_GT(HairlineOf(head.surface, 33).points.size(), 25u);
}

TEST_F(MeshHeadTest, UnitsAxesAndPlaceOfTheFileDoNotMatter) {
  const HeadGeometry plain = Load();
  HeadObj how;
  how.units_per_m = 1000;
  how.y_up = false;
  how.shift_m = {0.5, -1.6, 0.2};
  const HeadGeometry moved = Load(how, {1e-3, false, {0, 0, 0}});
  ExpectAlike(plain.surface, moved.surface, 1e-4, 1e-5);
  EXPECT_LT((p_M_of_mesh_ - how.shift_m).norm(), 0.003);
}

TEST_F(MeshHeadTest, ABeardCountsAsSkinAndABaldHeadHasNoHairline) {
  HeadObj how;
  how.material = [](const Vector3f& p) {
    if (p.y() > 0.09f && p.z() < -0.01f) return std::string("beard");
    const std::string adult = AdultMaterial(p);
    return adult == "black_hair" ? std::string("skin") : adult;
  };
  const HeadGeometry head = Load(how);
  EXPECT_TRUE(HairlineOf(head.surface, 33).points.empty());
  const HeadMesh mesh = MeshOf(head.surface, 3);
  for (const HeadPart part : mesh.parts) EXPECT_NE(part, HeadPart::kHair);
}

TEST_F(MeshHeadTest, EarsAndNeckYieldToWhatElseIsThere) {
  HeadObj how;  // a head with pointed ears
  const auto is_ear = [](const Vector3f& p) {
    return std::abs(p.x()) > 0.06f && std::abs(p.y() - 0.02f) < 0.012f && p.z() > -0.01f;
  };
  how.material = [&](const Vector3f& p) {
    return is_ear(p) ? std::string("ear") : AdultMaterial(p);
  };
  ExpectAlike(Load(how).surface, SharedAdultHead().surface, 0.005, 0.001);
}

TEST_F(MeshHeadTest, CornersAThousandthOfAMillimetreApartAreOne) {
  LabelledPart part;
  part.label = Label::kSkin;
  const std::array<Eigen::Vector3f, 4> corners = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  std::uint32_t n = 0;
  for (const auto& t : {std::array{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}) {  // a tetrahedron
    for (const int i : t) {
      part.vertices.push_back(corners[static_cast<std::size_t>(i)] +
                              Vector3f::Constant(1e-7f * static_cast<float>(n % 10)));
      ++n;
    }
    part.triangles.push_back({n - 3, n - 2, n - 1});
  }
  const JoinedMesh mesh = JoinParts({part});
  EXPECT_EQ(mesh.vertices.size(), 4u);
  EXPECT_EQ(mesh.triangles.size(), 4u);
}

TEST_F(MeshHeadTest, AMeshThatIsNotClosedIsRefused) {
  HeadObj how;
  how.leave_out = 1;
  ExpectRefused(how, "is not closed: 3 of 7680 edges", "each must have two");
}

TEST_F(MeshHeadTest, AHeadInWrongUnitsIsRefusedWithTheHeightFound) {
  HeadObj how;
  how.units_per_m = 1000;  // mm taken for m
  ExpectRefused(how, "head is 2", "m high: must be 0.12 to 0.45 m; is the scale right?");
  how.units_per_m = 1e-3;
  ExpectRefused(how, "head is 0.0002", "must be 0.12 to 0.45 m");
}

TEST_F(MeshHeadTest, AHeadWithoutEyesOrWithOneIsRefused) {
  HeadObj how;
  how.material = [](const Vector3f& p) {
    const std::string adult = AdultMaterial(p);
    return adult == "eye_white" ? std::string("skin") : adult;
  };
  ExpectRefused(how, "no eyes", "must contain the word eye");
  how.material = [](const Vector3f& p) {
    const std::string adult = AdultMaterial(p);
    return adult == "eye_white" && p.x() < 0 ? std::string("skin") : adult;
  };
  ExpectRefused(how, "eyes are ", "must be 0.04 to 0.09 m");
}

TEST_F(MeshHeadTest, AHeadThatLooksBackIsRefused) {
  HeadObj how;
  how.y_up = false;
  ExpectRefused(how, "eyes lie behind", "is y_up right?");
}

TEST_F(MeshHeadTest, AMouthBesideTheEyesIsRefused) {
  HeadObj how;
  how.material = [](const Vector3f& p) {
    const std::string adult = AdultMaterial(p);
    return adult == "lips" ? std::string("skin") : adult == "brow" ? std::string("lips") : adult;
  };
  ExpectRefused(how, "mouth lies -0.0", "must be 0.03 m or more");
}

TEST_F(MeshHeadTest, AMeshThatIsNotStarShapedIsRefused) {
  HeadObj how;  // the back of the head is drawn into the face
  how.place = [](const Vector3f& p) {
    return Vector3f(p.x(), p.y(), p.z() > 0.05f ? p.z() - 0.09f : p.z());
  };
  ExpectRefused(how, "is not star-shaped", "must be at most 5 %");
}

TEST_F(MeshHeadTest, AMaskIsRefused) {
  HeadObj how;
  how.place = [](const Vector3f& p) { return Vector3f(p.x(), p.y(), std::min(p.z(), -0.03f)); };
  ExpectRefused(how, "lies beside its middle", "must enclose it");
}

}  // namespace
}  // namespace visavis
