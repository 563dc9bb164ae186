#include "services/simulator/mesh_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <opencv2/imgcodecs.hpp>

#include "tests/support/temporary_folder.h"

namespace visavis {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

/// Two boxes-with-corners of material names given, 0.2 m large in units of 1 / @p scale.
class MeshFileTest : public ::testing::Test {
 protected:
  std::string Write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
    return folder_ / name;
  }

  std::string WriteObj(const std::string& material, double size) const {
    Write("head.mtl", "newmtl " + material + "\nKd 0.5 0.25 0.125\nnewmtl Shirt\nKd 0 0 1\n");
    std::string obj = "mtllib head.mtl\n";
    for (const double x : {-0.5, 0.5}) {
      for (const double y : {-0.5, 0.5}) {
        for (const double z : {-0.5, 0.5}) {
          obj += "v " + std::to_string(size * x) + " " + std::to_string(size * y) + " " +
                 std::to_string(size * z) + "\n";
        }
      }
    }
    obj +=
        "o head\nusemtl " + material + "\nf 1 2 4 3\nf 5 7 8 6\nf 1 5 6 2\nf 3 4 8 7\nf 2 6 8 4\n";
    obj += "o shirt\nusemtl Shirt\nf 1 3 7 5\n";
    return Write("head.obj", obj);
  }

  const TemporaryFolder folder_;
};

TEST_F(MeshFileTest, ReadsAnObjByMaterialInMetresAndMAxes) {
  const Figure figure = LoadFigure(WriteObj("Skin_fair", 200), {1e-3, true, {0.01, 0.02, 0.03}});
  ASSERT_EQ(figure.head.size(), 1u);
  ASSERT_EQ(figure.body.size(), 1u);
  EXPECT_EQ(figure.head[0].texture.at(0, 0).label, Label::kSkin);
  EXPECT_EQ(figure.body[0].texture.at(0, 0).label, Label::kClothes);
  Eigen::Vector3f low = Eigen::Vector3f::Constant(9), high = -low;
  for (const Eigen::Vector3f& p : figure.head[0].mesh.vertices) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  // y and z are turned round; the origin moves with its own axes.
  EXPECT_LT((low - Eigen::Vector3f(-0.11f, -0.08f, -0.07f)).norm(), 1e-6f);
  EXPECT_LT((high - Eigen::Vector3f(0.09f, 0.12f, 0.13f)).norm(), 1e-6f);
}

TEST_F(MeshFileTest, TakesTheMaterialsDiffuseColourAsLinearReflectance) {
  const Figure figure = LoadFigure(WriteObj("skin", 0.2), {});
  const Texel texel = figure.head[0].texture.at(0, 0);
  EXPECT_NEAR(texel.red, 255 * std::sqrt(0.5), 1);
  EXPECT_NEAR(texel.green, 255 * std::sqrt(0.25), 1);
  EXPECT_NEAR(texel.blue, 255 * std::sqrt(0.125), 1);
}

TEST_F(MeshFileTest, ReadsGltf) {
  // One triangle: three positions of three little-endian floats, (0,0,0) (0.2,0,0) (0,0.2,0).
  const std::string gltf =
      R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],
    "materials":[{"name":"Hair","pbrMetallicRoughness":{"baseColorFactor":[0.1,0.1,0.1,1]}}],
    "meshes":[{"name":"scalp","primitives":[{"attributes":{"POSITION":0},"material":0}]}],
    "buffers":[{"byteLength":36,"uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAzcxMPgAAAAAAAAAAAAAAAM3MTD4AAAAA"}],
    "bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":36}],
    "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[0.2,0.2,0]}]})";
  const Figure figure = LoadFigure(Write("head.gltf", gltf), {});
  ASSERT_EQ(figure.head.size(), 1u);
  EXPECT_EQ(figure.head[0].texture.at(0, 0).label, Label::kHair);
  EXPECT_EQ(figure.head[0].mesh.triangles.size(), 1u);
}

TEST_F(MeshFileTest, ShowsTheMaterialsPicture) {
  cv::Mat picture(2, 2, CV_8UC3, cv::Scalar(255, 255, 255));
  picture.at<cv::Vec3b>(0, 1) = {0, 0, 255};  // red at the top right
  cv::imwrite(folder_ / "skin.png", picture);
  Write("head.mtl", "newmtl skin\nmap_Kd skin.png\n");
  const Figure figure =
      LoadFigure(Write("head.obj",
                       "mtllib head.mtl\no head\nusemtl skin\nv 0 0 0\nv 0.2 0 0\nv 0.2 0.2 0\n"
                       "vt 0 0\nvt 1 0\nvt 1 1\nf 1/1 2/2 3/3\n"),
                 {});
  const Part& part = figure.head[0];
  EXPECT_EQ(part.texture.at(1, 0).red, 255);
  EXPECT_EQ(part.texture.at(1, 0).blue, 0);
  EXPECT_EQ(part.texture.at(0, 0).blue, 255);
  for (std::size_t i = 0; i < part.mesh.vertices.size(); ++i) {
    // y up in the file, v down in the picture.
    EXPECT_FLOAT_EQ(part.mesh.uv[i].x(), 5 * part.mesh.vertices[i].x());
    EXPECT_FLOAT_EQ(part.mesh.uv[i].y(), 1 + 5 * part.mesh.vertices[i].y());
  }
}

TEST_F(MeshFileTest, APictureRepeatsBeyondItsBorders) {
  cv::imwrite(folder_ / "skin.png", cv::Mat(2, 2, CV_8UC3, cv::Scalar(9, 9, 9)));
  Write("head.mtl", "newmtl skin\nmap_Kd skin.png\n");
  const Figure figure =
      LoadFigure(Write("head.obj",
                       "mtllib head.mtl\no head\nusemtl skin\nv 0 0 0\nv 0.2 0 0\nv 0.2 0.2 0\n"
                       "vt 2 -1\nvt 2.5 -1\nvt 2.5 -0.25\nf 1/1 2/2 3/3\n"),
                 {});
  const Mesh& mesh = figure.head[0].mesh;
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    EXPECT_NEAR(mesh.uv[i].x(), 2.5f * mesh.vertices[i].x(), 1e-6f);
    EXPECT_NEAR(mesh.uv[i].y(), 1 + 3.75f * mesh.vertices[i].y(), 1e-6f);
  }
}

TEST_F(MeshFileTest, TheNeckFollowsTheHeadAtTheChinAndTheBodyBelow) {
  Write("head.mtl", "newmtl skin\nnewmtl neck\n");
  const Figure figure = LoadFigure(
      Write("head.obj",
            "mtllib head.mtl\nv 0 0.2 0\nv 0.1 0.2 0\nv 0 0.1 0\nv 0.1 0.1 0\nv 0 0.058 0\n"
            "v 0 -0.1 0\no head\nusemtl skin\nf 1 2 3\no neck\nusemtl neck\nf 3 4 5\nf 4 5 6\n"),
      {});
  for (const Part& part : figure.head) {
    if (part.texture.at(0, 0).label == Label::kSkin) {
      EXPECT_TRUE(part.mesh.head_weight.empty());  // all of it follows the head
      continue;
    }
    ASSERT_EQ(part.mesh.head_weight.size(), part.mesh.vertices.size());
    for (std::size_t i = 0; i < part.mesh.vertices.size(); ++i) {
      const float up = -part.mesh.vertices[i].y();
      EXPECT_NEAR(part.mesh.head_weight[i], up > 0.09f ? 1 : up < 0 ? 0 : 0.5, 1e-5);
    }
  }
}

TEST_F(MeshFileTest, RefusesAPictureThatIsNotThere) {
  Write("head.mtl", "newmtl skin\nmap_Kd gone.png\n");
  const std::string file = Write("head.obj",
                                 "mtllib head.mtl\nusemtl skin\nv 0 0 0\nv 0.2 0 0\n"
                                 "v 0.2 0.2 0\nvt 0 0\nf 1/1 2/1 3/1\n");
  EXPECT_THAT([&] { LoadFigure(file, {}); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("gone.png: must be a picture")));
}

TEST_F(MeshFileTest, RefusesAMissingFileByName) {
  EXPECT_THAT([] { LoadFigure("/nowhere/head.obj", {}); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("/nowhere/head.obj: ")));
}

TEST_F(MeshFileTest, RefusesTextThatIsNoMesh) {
  const std::string file = Write("head.gltf", "no mesh at all");
  EXPECT_THAT([&] { LoadFigure(file, {}); }, ThrowsMessage<std::invalid_argument>(HasSubstr(file)));
}

TEST_F(MeshFileTest, RefusesAMaterialOfUnknownKind) {
  const std::string file = WriteObj("Material.001", 0.2);
  EXPECT_THAT([&] { LoadFigure(file, {}); },
              ThrowsMessage<std::invalid_argument>(AllOf(HasSubstr(file), HasSubstr("Material.001"),
                                                         HasSubstr("must contain skin"))));
}

TEST_F(MeshFileTest, RefusesAHeadInTheWrongUnit) {
  const std::string file = WriteObj("skin", 200);
  EXPECT_THAT([&] { LoadFigure(file, {}); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("is the scale right")));
}

TEST_F(MeshFileTest, RefusesClothesWithoutAHead) {
  const std::string file = WriteObj("cloth", 0.2);
  EXPECT_THAT([&] { LoadFigure(file, {}); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("no triangles of a head")));
}

}  // namespace
}  // namespace visavis
