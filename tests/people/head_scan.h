#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "common/geometry/rigid_transform.h"
#include "common/mesh/label.h"
#include "services/simulator/figure.h"
#include "services/simulator/ray_scene.h"

namespace visavis {

/// A head of the training set, as rays from outside meet it. T is its figure's frame, M the head
/// frame that it is to have.
class HeadScan {
 public:
  /// @p source: a mesh file (.obj), or the name of a procedural subject.
  /// @throws std::invalid_argument as LoadFigure and NamedSubject do.
  explicit HeadScan(const std::string& source);

  bool is_procedural() const { return is_procedural_; }
  /// M with the eyes where every head has them (AdultEyes), upright.
  RigidTransform X_TM_by_eyes() const;

  /// [m] from M's origin along the unit vector @p direction to the skin, as if there were no hair;
  /// NaN where there is none. At most kLowest_m below M's origin: the neck is cut there.
  float BareRadius(const RigidTransform& X_TM, const Eigen::Vector3f& direction) const;
  /// The same with hair and clothes. A beard is skin.
  struct Outermost {
    float radius_m;  ///< NaN: nothing
    bool is_hair;
  };
  Outermost OutermostAt(const RigidTransform& X_TM, const Eigen::Vector3f& direction) const;

  static constexpr float kLowest_m = 0.14f;

 private:
  struct Piece {
    std::vector<Eigen::Vector3f> vertices;
    std::vector<std::array<std::uint32_t, 3>> triangles;
    std::vector<Label> labels;  ///< by triangle
  };
  struct Rays {
    RayScene scene;
    std::vector<Piece> pieces;

    void Take(const std::vector<Part>& parts, bool bare);
  };
  struct Hit {
    float radius_m;
    Label label;
    bool is_from_inside;
  };
  static Hit Cast(const Rays& rays, const RigidTransform& X_TM, const Eigen::Vector3f& direction);

  bool is_procedural_;
  Eigen::Vector3d p_TE_m_;  ///< between the eyes, on the surface
  Rays bare_, dressed_;
};

}  // namespace visavis
