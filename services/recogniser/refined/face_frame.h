#pragma once

#include <array>
#include <vector>

#include "common/geometry/rigid_transform.h"
#include "services/recogniser/refined/face_points.h"
#include "services/recogniser/refined/icosphere.h"
#include "services/recogniser/refined/learned_face.h"

namespace visavis {

/// Where the head's frame lies on a face of known shape and looks. Whoever has seen the face from
/// whatever side finds the same: the frame's plane x = 0 is the plane of symmetry of looks and
/// shape; how far it nods is told by the features' height and the slope of the generic face.
class FaceFrame {
 public:
  explicit FaceFrame(const HeadSurface& generic);

  /// X_MN of the frame N in which @p face and @p surface are given: the head's frame M is turned
  /// from N by some degrees, and has its origin about @p p_NM, as the outlines have told.
  RigidTransform Find(const LearnedFace& face, const HeadSurface& surface,
                      const Eigen::Vector3d& p_NM) const;

 private:
  /// Brightness of a band by direction; not known where no point is near.
  struct Looks {
    std::vector<float> value;
    std::vector<unsigned char> known;  ///< by vertex of the sphere

    bool Knows(const Icosphere::Place& place) const {
      const auto& [a, b, c] = place.corners;
      return known[static_cast<std::size_t>(a)] && known[static_cast<std::size_t>(b)] &&
             known[static_cast<std::size_t>(c)];
    }
  };
  struct Asked {
    const std::vector<Eigen::Vector3f>& points;
    const std::vector<float>& value;  ///< of one band, at the points
    const std::vector<float>& radii;  ///< [m] of its surface, by vertex
    const Looks &generic, &looks;
    double contrast;  ///< rms of the face's brightness
    /// By point, where its place and its mirrored one were found last: they hardly move.
    std::vector<std::array<std::size_t, 2>> triangles;
  };

  std::array<Looks, kNumBands> LooksOf(
      const std::vector<Eigen::Vector3f>& points,
      const std::array<std::vector<float>, kNumBands>& value) const;
  /// [m] of @p surface, by vertex of the sphere.
  std::vector<float> RadiiOf(const HeadSurface& surface) const;
  RigidTransform Refine(Asked* asked, const RigidTransform& X_MN,
                        const Eigen::Vector3d& p_NM) const;
  /// What speaks against X_MN, each in its standard deviation.
  void Misfits(Asked* asked, const RigidTransform& X_MN, Eigen::VectorXd* misfits) const;

  const Icosphere sphere_;
  const std::vector<float> generic_radii_;
  std::array<Looks, kNumBands> generic_looks_;
};

}  // namespace visavis
