#include "common/mesh/labelled_mesh.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "tests/support/temporary_folder.h"

namespace visavis {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

class LabelledMeshTest : public ::testing::Test {
 protected:
  std::string Write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
    return folder_ / name;
  }
  /// A square of two triangles in skin and a triangle of hair, units of mm.
  std::string WriteObj(const std::string& corners = "f 1 2 3 4") const {
    Write("head.mtl", "newmtl my_skin\nKd 0.5 0.25 0.125\nnewmtl Hair\n");
    return Write(
        "head.obj",
        "mtllib head.mtl\nv 0 0 0\nv 10 0 0\nv 10 20 0\nv 0 20 5\no face\nusemtl my_skin\n" +
            corners + "\no top\nusemtl Hair\nf 1 3 4\n");
  }
  const TemporaryFolder folder_;
};

TEST_F(LabelledMeshTest, PartsHaveTheLabelAndColourOfTheirMaterial) {
  const auto parts = LoadLabelledMesh(WriteObj(), {1e-3, true, {0, 0, 0}});
  ASSERT_EQ(parts.size(), 2u);
  EXPECT_EQ(parts[0].label, Label::kSkin);
  EXPECT_EQ(parts[0].triangles.size(), 2u);
  EXPECT_LT((parts[0].diffuse - Eigen::Vector3d(0.5, 0.25, 0.125)).norm(), 1e-6);
  EXPECT_EQ(parts[1].label, Label::kHair);
  EXPECT_EQ(parts[1].triangles.size(), 1u);
}

TEST_F(LabelledMeshTest, YUpIsTurnedIntoMsAxesAfterScaleAndOrigin) {
  const std::string file = WriteObj();
  const auto farthest = [&](const MeshFileOptions& options) {
    return LoadLabelledMesh(file, options)[1].vertices[2];  // (0, 20, 5) mm
  };
  EXPECT_LT((farthest({1e-3, false, {0, 0, 0}}) - Eigen::Vector3f(0, 0.02f, 0.005f)).norm(), 1e-7f);
  EXPECT_LT(
      (farthest({1e-3, true, {0.001, 0.002, 0.003}}) - Eigen::Vector3f(-0.001f, -0.018f, -0.002f))
          .norm(),
      1e-7f);
}

TEST_F(LabelledMeshTest, AFileThatIsMissingOrNoMeshIsRefusedByName) {
  EXPECT_THAT([] { LoadLabelledMesh("/nowhere/head.obj", {}); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("/nowhere/head.obj: ")));
  for (const char* name : {"head.gltf", "head.ply", "head.stl", "head.unknown"}) {
    const std::string file = Write(name, "no mesh at all");
    EXPECT_THAT([&] { LoadLabelledMesh(file, {}); },
                ThrowsMessage<std::invalid_argument>(HasSubstr(file)));
  }
}

TEST_F(LabelledMeshTest, APlyThatIsCutShortIsRefused) {
  const std::string file =
      Write("head.ply",
            "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
            "property float z\nelement face 1\nproperty list uchar int vertex_indices\n"
            "end_header\n0 0 0\n1 0");
  EXPECT_THAT([&] { LoadLabelledMesh(file, {}); },
              ThrowsMessage<std::invalid_argument>(HasSubstr(file)));
}

TEST_F(LabelledMeshTest, AMaterialThatNamesNoPartOfAHeadIsRefused) {
  Write("head.mtl", "newmtl Material.001\n");
  const std::string file = Write(
      "head.obj", "mtllib head.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nusemtl Material.001\nf 1 2 3\n");
  EXPECT_THAT([&] { LoadLabelledMesh(file, {}); },
              ThrowsMessage<std::invalid_argument>(AllOf(HasSubstr(file), HasSubstr("Material.001"),
                                                         HasSubstr("must contain skin"))));
}

TEST_F(LabelledMeshTest, AScaleThatPutsVerticesOutOfReachIsRefused) {
  const std::string file = WriteObj();
  for (const double scale : {1e3, 1e9, 1e300}) {
    MeshFileOptions options;
    options.scale = scale;
    EXPECT_THAT([&] { LoadLabelledMesh(file, options); },
                ThrowsMessage<std::invalid_argument>(
                    AllOf(HasSubstr(file), HasSubstr("finite coordinates within 10000 m"),
                          HasSubstr("is the scale right?"))))
        << scale;
  }
  MeshFileOptions options;
  options.scale = 100;
  EXPECT_NO_THROW(LoadLabelledMesh(file, options));
}

TEST_F(LabelledMeshTest, ACornerThatIsNotThereIsRefused) {
  const std::string file = WriteObj("f 1 2 99");
  EXPECT_THROW(LoadLabelledMesh(file, {}), std::invalid_argument);
}

}  // namespace
}  // namespace visavis
