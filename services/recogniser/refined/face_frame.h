#pragma once

#include <array>
#include <vector>

#include "common/geometry/rigid_transform.h"
#include "services/recogniser/refined/adult_head.h"
#include "services/recogniser/refined/icosphere.h"
#include "services/recogniser/refined/learned_face.h"

namespace visavis {

/// Where the head's frame lies on a face of known shape and looks: where both are most like those
/// of adults (AdultHead), whichever these are, and most like their own mirror images. Whoever has
/// seen the face from whatever side finds the same.
class FaceFrame {
 public:
  /// @p adult is aliased.
  explicit FaceFrame(const AdultHead& adult);

  struct Found {
    RigidTransform X_MN;
    double likeness;  ///< of the face there, as LooksFit's
  };
  /// M in the frame N in which @p face and @p surface are given; it may be turned from N by some
  /// 15 deg and lie 30 mm away.
  Found Find(const LearnedFace& face, const HeadSurface& surface) const;
  /// The same where N is right already to some 4 deg: in half the time.
  Found FindNear(const LearnedFace& face, const HeadSurface& surface) const;

 private:
  /// Brightness by direction; not known where no point is near.
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
    std::vector<Eigen::Vector3f> points;
    std::vector<float> value;         ///< of the fine band, at the points
    double weight;                    ///< of a point: 1 where all of the face are asked
    const std::vector<float>& radii;  ///< [m] of its surface, by vertex
    const Looks& looks;
    double contrast;  ///< rms of the face's brightness
    /// By point, where its mirrored place and its own were found last: they hardly move.
    std::vector<std::array<std::size_t, 2>> triangles;
  };

  Looks LooksOf(const std::vector<Eigen::Vector3f>& points, const std::vector<float>& value) const;
  Found FindFrom(const std::vector<RigidTransform>& starts, const LearnedFace& face,
                 const HeadSurface& surface) const;
  /// The best of @p starts, after some steps, where @p few of the points are asked.
  RigidTransform BestOf(const std::vector<RigidTransform>& starts, Asked* few) const;
  /// [m] of @p surface, by vertex of the sphere.
  std::vector<float> RadiiOf(const HeadSurface& surface) const;
  RigidTransform Refine(Asked* asked, const RigidTransform& X_MN, int most_steps,
                        double* badness) const;
  /// What speaks against X_MN, each in its standard deviation.
  void Misfits(Asked* asked, const RigidTransform& X_MN, Eigen::VectorXd* misfits) const;
  void AddMirrored(Asked* asked, const RigidTransform& X_MN, double* misfits) const;
  /// @return the likeness
  double AddLooks(const Asked& asked, const RigidTransform& X_MN, double* misfits) const;
  void AddShape(Asked* asked, const RigidTransform& X_MN, double* misfits) const;

  const AdultHead& adult_;
  const Icosphere sphere_;
  const Icosphere shape_sphere_;
  const Eigen::VectorXd adult_radii_m_;  ///< by vertex of the shape's sphere
};

}  // namespace visavis
