#include "services/simulator/mesh_export.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <tuple>

#include "services/simulator/mesh_file.h"
#include "tests/support/temporary_folder.h"

namespace visavis {
namespace {

using ::testing::HasSubstr;

Figure SmallFigure() { return BuildFigure(NamedSubject("adult_a"), {56, 44, 256}); }

class MeshExportTest : public ::testing::Test {
 protected:
  TemporaryFolder folder_;
  std::string file_{folder_ / "head.obj"};
};

TEST_F(MeshExportTest, TheMeshIsClosedAndTurnedOutwards) {
  ExportHead(SmallFigure(), file_);
  std::map<std::tuple<float, float, float>, int> places;
  std::map<std::pair<int, int>, int> edges;
  double volume = 0;
  for (const LabelledPart& part : LoadLabelledMesh(file_, {})) {
    for (const auto& triangle : part.triangles) {
      std::array<int, 3> t{};
      for (std::size_t i = 0; i < 3; ++i) {
        const Eigen::Vector3f& p = part.vertices[triangle[i]];
        t[i] = places.try_emplace({p.x(), p.y(), p.z()}, static_cast<int>(places.size()))
                   .first->second;
      }
      const auto at = [&](std::size_t i) {
        return part.vertices[triangle[i]].cast<double>().eval();
      };
      volume += at(0).dot(at(1).cross(at(2))) / 6;
      if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) continue;
      for (std::size_t i = 0; i < 3; ++i) ++edges[{t[i], t[(i + 1) % 3]}];
    }
  }
  for (const auto& [edge, count] : edges) {
    EXPECT_EQ(count, 1);
    EXPECT_EQ(edges.count({edge.second, edge.first}), 1u);
  }
  EXPECT_GT(volume, 0.003);  // [m^3]
  EXPECT_LT(volume, 0.009);
}

TEST_F(MeshExportTest, EyesAreLabelledWhereTheFigureHasThem) {
  const Figure figure = SmallFigure();
  ExportHead(figure, file_);
  std::map<Label, int> triangles;
  Eigen::Vector3f low = Eigen::Vector3f::Constant(9), high = -low;
  for (const LabelledPart& part : LoadLabelledMesh(file_, {})) {
    triangles[part.label] += static_cast<int>(part.triangles.size());
    if (part.label != Label::kEye) continue;
    for (const auto& triangle : part.triangles) {
      for (const auto i : triangle) {
        low = low.cwiseMin(part.vertices[i]);
        high = high.cwiseMax(part.vertices[i]);
      }
    }
  }
  for (const Label label : {Label::kSkin, Label::kHair, Label::kEye, Label::kBrow, Label::kLips}) {
    EXPECT_GT(triangles[label], 1) << static_cast<int>(label);
  }
  for (const auto& eye : {figure.p_M_eye_right_m, figure.p_M_eye_left_m}) {
    EXPECT_GT(eye.x(), static_cast<double>(low.x()));
    EXPECT_LT(eye.x(), static_cast<double>(high.x()));
    EXPECT_NEAR(eye.y(), 0.5 * static_cast<double>(low.y() + high.y()), 0.006);
  }
}

TEST_F(MeshExportTest, AFileThatCannotBeWrittenIsNamed) {
  EXPECT_THAT([&] { ExportHead(SmallFigure(), folder_ / "none/head.obj"); },
              ::testing::ThrowsMessage<std::runtime_error>(HasSubstr("none/head.obj")));
}

}  // namespace
}  // namespace visavis
