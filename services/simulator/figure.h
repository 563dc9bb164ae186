#pragma once

#include <string>
#include <vector>

#include "common/geometry/rigid_transform.h"
#include "services/simulator/mesh.h"
#include "services/simulator/subject.h"
#include "services/simulator/texture.h"

namespace visavis {

/// One piece of a body with its texture.
struct Part {
  std::string name;
  Mesh mesh;
  Texture texture;
};

/// A person ready to be rendered. Vertices in metres, in the head's frame M with the head upright
/// above the body; the body's parts keep that frame's coordinates when the head turns, the neck
/// (Mesh::head_weight) joins the two.
struct Figure {
  std::vector<Part> head;
  std::vector<Part> body;
  /// Centres of the visible eyeballs as seen from the front [m] in M: image right (the person's
  /// left), image left.
  Eigen::Vector3d p_M_eye_right_m{Eigen::Vector3d::Constant(std::nan(""))};
  Eigen::Vector3d p_M_eye_left_m{Eigen::Vector3d::Constant(std::nan(""))};
  /// Where the neck bends [m], in M.
  Eigen::Vector3d p_M_neck_m{0, 0.09, 0.02};
};

/// How finely a figure is made. Halving both halves the memory, quarters the time to build.
struct FigureDetail {
  int head_columns{112};
  int head_rows{88};
  int texture_size{1024};  ///< of the head's texture [texel], a power of two
};

Figure BuildFigure(const Subject& subject, const FigureDetail& detail = {});

/// The pieces, in M [m].
Part BuildHeadPart(const Subject& subject, const SkinSurface& surface, const FigureDetail& detail,
                   Figure* landmarks);
Part BuildEarPart(const Subject& subject, const SkinSurface& surface, bool image_right);
Part BuildLongHairPart(const Subject& subject, const SkinSurface& surface, int texture_size);
Part BuildBodyPart(const Subject& subject, const SkinSurface& surface, int texture_size);

/// A flat hand with spread fingers, about 190 mm long, fingers to -y, palm to +z, centre of the
/// palm at the origin.
std::vector<Part> BuildHand(const Srgb& skin);

}  // namespace visavis
