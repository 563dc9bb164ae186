#include "services/simulator/picture_texture.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <iterator>
#include <map>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <stdexcept>
#include <utility>

#include "services/simulator/bake.h"

namespace visavis {
namespace {

constexpr int kOpaque = 128;
constexpr int kMostCuts = 8;  ///< of a triangle into four, one after the other

int PowerOfTwo(int size, int largest) {
  int power = 1;
  while (power < size && power < largest) power *= 2;
  return power;
}

cv::Mat ReadPicture(const std::string& filename) {
  std::ifstream file(filename, std::ios::binary);
  const std::vector<char> bytes{std::istreambuf_iterator<char>(file), {}};
  cv::Mat picture;
  try {
    if (!bytes.empty()) picture = cv::imdecode(bytes, cv::IMREAD_UNCHANGED);
  } catch (const cv::Exception&) {  // said below
  }
  if (picture.empty() || picture.depth() != CV_8U)
    throw std::invalid_argument(filename + ": must be a picture of 8 bits a channel");
  return picture;
}

/// Colours times opacity, halved again and again, tell what colour is near a transparent texel.
cv::Mat Spread(const cv::Mat& bgra) {
  cv::Mat wide;
  bgra.convertTo(wide, CV_32FC4, 1.0 / 255);
  for (int y = 0; y < wide.rows; ++y) {
    for (int x = 0; x < wide.cols; ++x) {
      cv::Vec4f& p = wide.at<cv::Vec4f>(y, x);
      for (int c = 0; c < 3; ++c) p[c] *= p[3];
    }
  }
  std::vector<cv::Mat> levels = {wide};
  while (levels.back().rows > 1 && levels.back().cols > 1) {
    cv::Mat half;
    cv::resize(levels.back(), half, {}, 0.5, 0.5, cv::INTER_AREA);
    levels.push_back(half);
  }
  for (std::size_t k = levels.size() - 1; k > 0; --k) {
    cv::Mat from;
    cv::resize(levels[k], from, levels[k - 1].size(), 0, 0, cv::INTER_LINEAR);
    for (int y = 0; y < from.rows; ++y) {
      for (int x = 0; x < from.cols; ++x) {
        cv::Vec4f& p = levels[k - 1].at<cv::Vec4f>(y, x);
        p += (1 - p[3]) * from.at<cv::Vec4f>(y, x);
      }
    }
  }
  return levels[0];
}

/// How many texels of a box are opaque, by their sums from the first corner on.
class OpaqueTexels {
 public:
  explicit OpaqueTexels(const PictureTexture& picture)
      : width_(picture.texture.width()), height_(picture.texture.height()) {
    const cv::Mat opacity(height_, width_, CV_8UC1,
                          const_cast<std::uint8_t*>(picture.opacity.data()));
    cv::Mat opaque = opacity >= kOpaque;
    opaque.convertTo(opaque, CV_8U, 1.0 / 255);
    cv::integral(opaque, sums_, CV_32S);
  }

  /// Of the texels that a triangle with these texture coordinates may touch.
  struct Share {
    int opaque, all;
  };
  Share Within(const std::array<Eigen::Vector2f, 3>& uv) const {
    const Eigen::Vector2f low = uv[0].cwiseMin(uv[1]).cwiseMin(uv[2]),
                          high = uv[0].cwiseMax(uv[1]).cwiseMax(uv[2]);
    const int x0 = Texel(low.x(), width_), x1 = Texel(high.x(), width_) + 1;
    const int y0 = Texel(low.y(), height_), y1 = Texel(high.y(), height_) + 1;
    const auto sum = [&](int y, int x) { return sums_.at<int>(y, x); };
    return {sum(y1, x1) - sum(y0, x1) - sum(y1, x0) + sum(y0, x0), (x1 - x0) * (y1 - y0)};
  }
  bool IsOpaque(const Eigen::Vector2f& uv) const { return Within({uv, uv, uv}).opaque > 0; }

 private:
  static int Texel(float t, int size) {
    return std::clamp(static_cast<int>(t * static_cast<float>(size)), 0, size - 1);
  }

  const int width_, height_;
  cv::Mat sums_;
};

/// Cuts one triangle after the other.
class Cutter {
 public:
  Cutter(const PictureTexture& picture, float cell_m, Mesh* mesh)
      : opaque_(picture), cell_m_(cell_m), mesh_(mesh), from_(std::move(mesh->triangles)) {
    mesh->triangles.clear();
  }

  void CutAll() {
    for (const auto& triangle : from_) Cut(triangle, kMostCuts);
    DropUnused();
  }

 private:
  using Triangle = std::array<std::uint32_t, 3>;

  void Cut(const Triangle& t, int cuts_left) {
    const std::array<Eigen::Vector2f, 3> uv = {mesh_->uv[t[0]], mesh_->uv[t[1]], mesh_->uv[t[2]]};
    const OpaqueTexels::Share share = opaque_.Within(uv);
    const auto edge = [&](std::size_t i) {
      return (mesh_->vertices[t[i]] - mesh_->vertices[t[(i + 1) % 3]]).norm();
    };
    const bool is_uniform = share.opaque == 0 || share.opaque == share.all;
    if (is_uniform || cuts_left == 0 || std::max({edge(0), edge(1), edge(2)}) <= cell_m_) {
      if (opaque_.IsOpaque((uv[0] + uv[1] + uv[2]) / 3)) mesh_->triangles.push_back(t);
      return;
    }
    const std::uint32_t ab = Middle(t[0], t[1]), bc = Middle(t[1], t[2]), ca = Middle(t[2], t[0]);
    Cut({t[0], ab, ca}, cuts_left - 1);
    Cut({ab, t[1], bc}, cuts_left - 1);
    Cut({ca, bc, t[2]}, cuts_left - 1);
    Cut({ab, bc, ca}, cuts_left - 1);
  }

  /// The vertices that no triangle names.
  void DropUnused() {
    Mesh kept;
    std::vector<std::uint32_t> place(mesh_->vertices.size());
    for (Triangle& triangle : mesh_->triangles) {
      for (std::uint32_t& i : triangle) {
        if (place[i] == 0) {
          kept.vertices.push_back(mesh_->vertices[i]);
          kept.normals.push_back(mesh_->normals[i]);
          kept.uv.push_back(mesh_->uv[i]);
          place[i] = static_cast<std::uint32_t>(kept.vertices.size());
        }
        i = place[i] - 1;
      }
    }
    kept.triangles = std::move(mesh_->triangles);
    *mesh_ = std::move(kept);
  }

  std::uint32_t Middle(std::uint32_t a, std::uint32_t b) {
    const auto [place, is_new] = middles_.try_emplace(
        {std::min(a, b), std::max(a, b)}, static_cast<std::uint32_t>(mesh_->vertices.size()));
    if (is_new) {
      mesh_->vertices.emplace_back((mesh_->vertices[a] + mesh_->vertices[b]) / 2);
      mesh_->normals.emplace_back((mesh_->normals[a] + mesh_->normals[b]).normalized());
      mesh_->uv.emplace_back((mesh_->uv[a] + mesh_->uv[b]) / 2);
    }
    return place->second;
  }

  const OpaqueTexels opaque_;
  const float cell_m_;
  Mesh* const mesh_;
  const std::vector<Triangle> from_;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles_;
};

}  // namespace

PictureTexture ReadPictureTexture(const std::string& filename, double gloss, Label label,
                                  int largest) {
  cv::Mat picture = ReadPicture(filename);
  if (picture.channels() == 1) cv::cvtColor(picture, picture, cv::COLOR_GRAY2BGRA);
  if (picture.channels() == 3) cv::cvtColor(picture, picture, cv::COLOR_BGR2BGRA);
  const cv::Size size(PowerOfTwo(picture.cols, largest), PowerOfTwo(picture.rows, largest));
  if (picture.size() != size) cv::resize(picture, picture, size, 0, 0, cv::INTER_AREA);
  double least_opacity = 255;
  cv::Mat opacity;
  cv::extractChannel(picture, opacity, 3);
  cv::minMaxLoc(opacity, &least_opacity);
  PictureTexture result{Texture(size.width, size.height), {}};
  if (least_opacity < static_cast<double>(kOpaque))
    result.opacity.assign(opacity.begin<std::uint8_t>(), opacity.end<std::uint8_t>());
  const cv::Mat spread = Spread(picture);
  Paint paint;
  paint.gloss = gloss;
  paint.label = label;
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      const cv::Vec4f& p = spread.at<cv::Vec4f>(y, x);
      const auto channel = [&](int c) { return static_cast<double>(p[c] / std::max(p[3], 1e-6f)); };
      paint.colour = {channel(2), channel(1), channel(0)};
      result.texture.at(x, y) = EncodeTexel(paint);
    }
  }
  result.texture.BuildLevels();
  return result;
}

void CutOut(const PictureTexture& picture, float cell_m, Mesh* mesh) {
  if (picture.opacity.empty()) return;
  Cutter(picture, cell_m, mesh).CutAll();
}

}  // namespace visavis
