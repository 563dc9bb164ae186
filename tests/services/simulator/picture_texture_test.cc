#include "services/simulator/picture_texture.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>

#include "tests/support/temporary_folder.h"

namespace visavis {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

class PictureTextureTest : public ::testing::Test {
 protected:
  std::string Write(const cv::Mat& picture) const {
    const std::string file = folder_ / "skin.png";
    cv::imwrite(file, picture);
    return file;
  }

  /// Blue and opaque where @p is_there(column), else red and clear.
  template <typename IsThere>
  PictureTexture Striped(const IsThere& is_there) const {
    cv::Mat picture(32, 64, CV_8UC4);
    for (int y = 0; y < picture.rows; ++y) {
      for (int x = 0; x < picture.cols; ++x)
        picture.at<cv::Vec4b>(y, x) =
            is_there(x) ? cv::Vec4b(255, 0, 0, 255) : cv::Vec4b(0, 0, 255, 0);
    }
    return ReadPictureTexture(Write(picture), 0, Label::kHair, 2048);
  }

  const TemporaryFolder folder_;
};

/// A square of 0.1 m in the picture's whole width and height.
Mesh Square() {
  Mesh mesh = MakeGrid(1, 1);
  mesh.vertices.clear();
  for (const Eigen::Vector2f& uv : mesh.uv)
    mesh.vertices.emplace_back(0.1f * uv.x(), 0.1f * uv.y(), 0.0f);
  mesh.normals.assign(mesh.vertices.size(), -Eigen::Vector3f::UnitZ());
  return mesh;
}

float AreaOf(const Mesh& mesh) {
  float area = 0;
  for (const auto& [a, b, c] : mesh.triangles) {
    area += 0.5f *
            (mesh.vertices[b] - mesh.vertices[a]).cross(mesh.vertices[c] - mesh.vertices[a]).norm();
  }
  return area;
}

TEST_F(PictureTextureTest, AreSrgbColoursWithTheFirstRowOnTop) {
  cv::Mat picture(4, 2, CV_8UC3, cv::Scalar(10, 100, 200));
  picture.row(0) = cv::Scalar(255, 255, 255);
  const PictureTexture read = ReadPictureTexture(Write(picture), 0.5, Label::kSkin, 2048);
  EXPECT_EQ(read.texture.width(), 2);
  EXPECT_EQ(read.texture.height(), 4);
  EXPECT_EQ(read.texture.at(0, 0).red, 255);
  const Texel texel = read.texture.at(1, 2);
  EXPECT_EQ(texel.label, Label::kSkin);
  EXPECT_NEAR(texel.gloss, 128, 1);
  // sRGB 200, 100, 10 as roots of linear reflectances 0.578, 0.127, 0.00304.
  EXPECT_NEAR(texel.red, 255 * std::sqrt(0.578), 1);
  EXPECT_NEAR(texel.green, 255 * std::sqrt(0.127), 1);
  EXPECT_NEAR(texel.blue, 255 * std::sqrt(0.00304), 1);
  EXPECT_TRUE(read.opacity.empty());
}

TEST_F(PictureTextureTest, IsScaledToPowersOfTwoAtMostTheLargest) {
  const std::string file = Write(cv::Mat(100, 300, CV_8UC1, cv::Scalar(80)));
  const PictureTexture read = ReadPictureTexture(file, 0, Label::kSkin, 256);
  EXPECT_EQ(read.texture.width(), 256);
  EXPECT_EQ(read.texture.height(), 128);
  EXPECT_EQ(read.texture.at(255, 127).red, read.texture.at(0, 0).green);
}

TEST_F(PictureTextureTest, CutsAwayWhatIsTransparent) {
  const PictureTexture striped = Striped([](int x) { return x >= 20; });
  Mesh mesh = Square();
  CutOut(striped, 0.001f, &mesh);
  mesh.ValidateOrThrow();
  EXPECT_NEAR(AreaOf(mesh), 0.01 * 44 / 64, 0.1 * 0.001);  // to a cell along the edge
  float leftmost = 1;
  for (const Eigen::Vector3f& p : mesh.vertices) leftmost = std::min(leftmost, p.x());
  EXPECT_NEAR(leftmost, 0.1 * 20 / 64, 0.001);
  EXPECT_EQ(mesh.normals[0], Eigen::Vector3f(-Eigen::Vector3f::UnitZ()));
}

TEST_F(PictureTextureTest, CutsOnlyAtTheEdge) {
  const PictureTexture striped = Striped([](int x) { return x >= 32; });
  Mesh mesh = Square();
  CutOut(striped, 0.001f, &mesh);
  // Cells of 1 mm all over would be more than 10000 triangles.
  EXPECT_LT(mesh.triangles.size(), 2000u);
}

TEST_F(PictureTextureTest, AnOpaquePictureCutsNothing) {
  const PictureTexture whole = Striped([](int) { return true; });
  Mesh mesh = Square();
  CutOut(whole, 0.001f, &mesh);
  EXPECT_EQ(mesh.triangles.size(), 2u);
}

TEST_F(PictureTextureTest, NothingOfTheTransparentColourIsSeenAtTheEdge) {
  const PictureTexture striped = Striped([](int x) { return x >= 20; });
  EXPECT_EQ(striped.texture.at(19, 5).red, 0);
  EXPECT_EQ(striped.texture.at(19, 5).blue, 255);
  EXPECT_EQ(striped.texture.at(2, 5).red, 0);
}

TEST_F(PictureTextureTest, RefusesAFileThatIsNoPicture) {
  EXPECT_THAT([] { ReadPictureTexture("/nowhere/skin.png", 0, Label::kSkin, 64); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("/nowhere/skin.png: must be")));
}

}  // namespace
}  // namespace visavis
