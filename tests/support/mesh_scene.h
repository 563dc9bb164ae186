#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "common/geometry/stereo_rig.h"
#include "services/recogniser/refined/face_points.h"
#include "services/recogniser/refined/head_mesh.h"
#include "services/recogniser/refined/stereo_view.h"

namespace visavis {

using Color = std::array<std::uint8_t, 3>;  ///< red, green, blue

/// What a place of the head, in M [m], looks like.
using Painter = std::function<Color(const Eigen::Vector3f& p_M)>;

inline constexpr Color kSceneWall{96, 140, 176}, kSceneHair{52, 36, 28}, kSceneSkin{214, 160, 132};

/// The refined estimator's generic head as one that is known, made once: it takes a while.
struct SharedHead {
  SharedHead();

  HeadSurface surface;
  HeadMesh mesh;
  FacePoints face;
};
const SharedHead& SharedAdultHead();

/// Hair and skin of flat colours.
Color FlatHead(const Eigen::Vector3f& p_M);
/// The same with the brows, eyes, nostrils and mouth of the mean adult, and no two places of the
/// skin alike.
Color FeaturedHead(const Eigen::Vector3f& p_M);
/// Somebody else: features as other adults have them, skin of another grain.
Color StrangerHead(const Eigen::Vector3f& p_M);
/// Hair and skin with a fine grain all over the skin, so that each place is told from its
/// neighbours.
Color GrainyHead(const Eigen::Vector3f& p_M);

/// A smooth grain of about +-1, of waves of 12 to 21 mm in all directions.
float Grain(const Eigen::Vector3f& p_M);

/// Pictures of the head's mesh, its triangles filled and hidden ones left out, and all that the
/// refined estimator computes of them: colours learned from what was painted, scores and bands of
/// the whole pictures. No halvings: the pictures' resolution is the working one.
class MeshScene {
 public:
  explicit MeshScene(const StereoRig& rig);

  /// Paints both eyes with the head at @p X_CM on a flat wall. The view lives until the next call.
  const StereoView& Show(const RigidTransform& X_CM, const Painter& painter);
  /// The same with a head at each of @p X_CM; colours are learned from all of them.
  const StereoView& ShowAll(const std::vector<RigidTransform>& X_CM, const Painter& painter);
  /// The same as Show() in shades of grey.
  const StereoView& ShowGray(const RigidTransform& X_CM, const Painter& painter);

  ImageView picture(std::size_t eye) const;
  const EyeGeometry& geometry(std::size_t eye) const { return eyes_[eye].geometry; }
  const ColorModel& colors(std::size_t eye) const { return eyes_[eye].colors; }

 private:
  struct Eye {
    explicit Eye(const Pinhole& camera, const RigidTransform& X_CE);
    EyeGeometry geometry;
    ColorModel colors;
    ScoreMap scores;
    BandImages bands;
    std::vector<Color> pixels;
    std::vector<std::uint8_t> gray, classes;  // ColorClass
    std::vector<float> depth;
    bool is_gray{false};
  };
  const StereoView& Show(const std::vector<RigidTransform>& X_CM, const Painter& painter,
                         bool is_gray);
  static void PaintWall(Eye* eye);
  static void Paint(const RigidTransform& X_CM, const Painter& painter, Eye* eye);
  static void Fill(const std::array<Eigen::Vector3f, 3>& corners_M,
                   const std::array<Eigen::Vector3f, 3>& corners_E, const Painter& painter,
                   Eye* eye);
  static void LearnColors(const ImageView& picture, Eye* eye);

  std::array<Eye, 2> eyes_;
  StereoView view_;
};

}  // namespace visavis
