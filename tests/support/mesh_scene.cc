#include "tests/support/mesh_scene.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "services/recogniser/refined/adult_head.h"
#include "services/recogniser/refined/head_geometry.h"

namespace visavis {
namespace {

using Eigen::Vector3f;

Color Shaded(const Color& color, float factor) {
  Color shaded;
  for (std::size_t k = 0; k < 3; ++k) {
    shaded[k] = static_cast<std::uint8_t>(
        std::lround(std::clamp(factor * static_cast<float>(color[k]), 0.0f, 255.0f)));
  }
  return shaded;
}

/// Brightness of the face of an adult, about 0: what all have in common, and @p a of each mode.
float Features(const Vector3f& p_M, const std::vector<float>& a) {
  if (p_M.z() > -0.030f) return 0;
  const AdultLooks::Place place = TheAdult().looks.At(p_M.x(), p_M.y());
  if (!place.known) return 0;
  float sum = place.mean[kFineBand] + 0.5f * place.mean[kCoarseBand];
  for (std::size_t k = 0; k < a.size(); ++k) sum += a[k] * place.modes[k];
  return sum;
}

}  // namespace

SharedHead::SharedHead()
    : surface(HeadShape{}, TableOf(TheAdult().surface, 4)),
      mesh(MeshOf(surface, 4)),
      face(FacePointsOf(surface, 0.005)) {}

const SharedHead& SharedAdultHead() {
  static const SharedHead head;
  return head;
}

Color FlatHead(const Vector3f& p_M) {
  return SharedAdultHead().surface.HairSide(p_M) > 0 ? kSceneHair : kSceneSkin;
}

Color FeaturedHead(const Vector3f& p_M) {
  const Color flat = FlatHead(p_M);
  if (flat == kSceneHair) return flat;
  return Shaded(flat, 0.95f + 0.5f * Features(p_M, {}) + 0.03f * Grain(p_M));
}

Color StrangerHead(const Vector3f& p_M) {
  const Color flat = FlatHead(p_M);
  if (flat == kSceneHair) return flat;
  const float features = Features(p_M, {1.5f, -1.5f, 1.2f, -1.2f, 1, -1});
  return Shaded(flat, 0.85f + 0.4f * features + 0.11f * Grain(p_M + Vector3f(0.05f, 0.02f, 0)));
}

Color GrainyHead(const Vector3f& p_M) {
  const Color flat = FlatHead(p_M);
  return flat == kSceneHair ? flat : Shaded(flat, 0.9f + 0.13f * Grain(p_M));
}

float Grain(const Vector3f& p_M) {
  const auto wave = [&](float x, float y, float z, float length_m, float phase) {
    return std::sin(
        static_cast<float>(2 * M_PI) / length_m * Vector3f(x, y, z).normalized().dot(p_M) + phase);
  };
  return 0.45f * (wave(1, 0.2f, 0.3f, 0.013f, 0.4f) + wave(-0.3f, 1, 0.2f, 0.017f, 1.9f) +
                  wave(1, 1, -0.4f, 0.021f, 3.0f) + wave(1, -0.8f, 0, 0.012f, 5.2f));
}

MeshScene::Eye::Eye(const Pinhole& camera, const RigidTransform& X_CE)
    : geometry(camera, X_CE),
      scores(camera.width, camera.height),
      bands(camera.width, camera.height),
      pixels(static_cast<std::size_t>(camera.width * camera.height)),
      gray(pixels.size()),
      classes(pixels.size()),
      depth(pixels.size()) {}

MeshScene::MeshScene(const StereoRig& rig)
    : eyes_{Eye(rig.right, RigidTransform::Identity()), Eye(rig.left, rig.X_CL)} {}

ImageView MeshScene::picture(std::size_t eye) const {
  const Eye& e = eyes_[eye];
  const int width = e.geometry.width, height = e.geometry.height;
  if (e.is_gray) return {e.gray.data(), width, height, width, e.gray.size(), PixelFormat::kGray};
  return {e.pixels.data()->data(), width, height, 3 * width, 3 * e.pixels.size(),
          PixelFormat::kRgb};
}

// Pixel by pixel of the triangle's box: barycentric weights, linear in the picture; what they
// weigh is linear there after division by depth.
void MeshScene::Fill(const std::array<Vector3f, 3>& corners_M,
                     const std::array<Vector3f, 3>& corners_E, const Painter& painter, Eye* eye) {
  const EyeGeometry& g = eye->geometry;
  Eigen::Matrix3f A;
  for (int k = 0; k < 3; ++k) {
    const Vector3f& p = corners_E[static_cast<std::size_t>(k)];
    A.col(k) << g.cx + g.fx * p.x() / p.z(), g.cy + g.fy * p.y() / p.z(), 1;
  }
  const Eigen::Matrix3f to_weights = A.inverse();
  const Vector3f low = A.rowwise().minCoeff(), high = A.rowwise().maxCoeff();
  const int x0 = std::max(0, static_cast<int>(std::ceil(low.x())));
  const int y0 = std::max(0, static_cast<int>(std::ceil(low.y())));
  const int x1 = std::min(g.width - 1, static_cast<int>(std::floor(high.x())));
  const int y1 = std::min(g.height - 1, static_cast<int>(std::floor(high.y())));
  for (int y = y0; y <= y1; ++y) {
    for (int x = x0; x <= x1; ++x) {
      const Vector3f weights =
          to_weights * Vector3f(static_cast<float>(x), static_cast<float>(y), 1);
      if (weights.minCoeff() < -1e-4f) continue;
      float inverse_depth = 0;
      Vector3f p_M = Vector3f::Zero();
      for (std::size_t k = 0; k < 3; ++k) {
        const float share = weights[static_cast<int>(k)] / corners_E[k].z();
        inverse_depth += share;
        p_M += share * corners_M[k];
      }
      const auto at = static_cast<std::size_t>(y * g.width + x);
      if (1 / inverse_depth >= eye->depth[at]) continue;
      eye->depth[at] = 1 / inverse_depth;
      p_M /= inverse_depth;
      eye->pixels[at] = painter(p_M);
      eye->classes[at] = SharedAdultHead().surface.HairSide(p_M) > 0 ? kHairColor : kSkinColor;
    }
  }
}

void MeshScene::PaintWall(Eye* eye) {
  std::fill(eye->pixels.begin(), eye->pixels.end(), kSceneWall);
  std::fill(eye->classes.begin(), eye->classes.end(), kSurroundings);
  std::fill(eye->depth.begin(), eye->depth.end(), std::numeric_limits<float>::infinity());
}

void MeshScene::Paint(const RigidTransform& X_CM, const Painter& painter, Eye* eye) {
  const HeadMesh& mesh = SharedAdultHead().mesh;
  const EyePose pose(eye->geometry, X_CM);
  for (const auto& triangle : mesh.triangles) {
    std::array<Vector3f, 3> corners_M, corners_E;
    for (std::size_t k = 0; k < 3; ++k) {
      corners_M[k] = mesh.vertices[static_cast<std::size_t>(triangle[k])];
      corners_E[k] = pose.InEye(corners_M[k]);
    }
    const Vector3f n = (corners_E[1] - corners_E[0]).cross(corners_E[2] - corners_E[0]);
    if (n.dot(corners_E[0]) < 0) Fill(corners_M, corners_E, painter, eye);
  }
}

void MeshScene::LearnColors(const ImageView& picture, Eye* eye) {
  eye->colors.StartFrom(picture);
  const Channels channels(picture.format);
  const auto counts = std::make_unique<ColorModel::Counts>();
  for (int round = 0; round < 6; ++round) {
    counts->Clear();
    for (std::size_t i = 0; i < eye->pixels.size(); ++i) {
      const std::uint8_t* pixel = picture.data + i * static_cast<std::size_t>(channels.step);
      counts->Add(static_cast<ColorClass>(eye->classes[i]), ColorModel::BinOf(pixel, channels));
    }
    eye->colors.Learn(counts.get());
  }
}

const StereoView& MeshScene::Show(const RigidTransform& X_CM, const Painter& painter) {
  return ShowAll({X_CM}, painter);
}

const StereoView& MeshScene::ShowAll(const std::vector<RigidTransform>& X_CM,
                                     const Painter& painter) {
  return Show(X_CM, painter, false);
}

const StereoView& MeshScene::ShowGray(const RigidTransform& X_CM, const Painter& painter) {
  return Show({X_CM}, painter, true);
}

const StereoView& MeshScene::Show(const std::vector<RigidTransform>& X_CM, const Painter& painter,
                                  bool is_gray) {
  for (std::size_t i = 0; i < 2; ++i) {
    Eye& eye = eyes_[i];
    PaintWall(&eye);
    for (const RigidTransform& X : X_CM) Paint(X, painter, &eye);
    eye.is_gray = is_gray;
    std::transform(eye.pixels.begin(), eye.pixels.end(), eye.gray.begin(), [](const Color& c) {
      return static_cast<std::uint8_t>((77 * c[0] + 150 * c[1] + 29 * c[2] + 128) / 256);
    });
    LearnColors(picture(i), &eye);
    const PixelBox whole{0, 0, eye.geometry.width / 16 * 16, eye.geometry.height / 16 * 16};
    eye.scores.Build(picture(i), eye.colors, whole);
    eye.bands.Build(picture(i), whole);
    view_[i] = {&eye.geometry, &eye.scores, &eye.bands};
  }
  return view_;
}

}  // namespace visavis
