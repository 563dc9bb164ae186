#pragma once

#include <vector>

#include "common/image/image.h"
#include "services/recogniser/refined/eye.h"
#include "services/recogniser/refined/head_mesh.h"

namespace visavis {

/// How much the colours of a head's skin and hair, at a pose, differ from those round it: knows no
/// colours before, so it finds whoever stands out, in any light. Of poses beside a head it is low,
/// since there the model covers both.
class ColorContrast {
 public:
  explicit ColorContrast(const HeadMesh& mesh);

  /// 0 (the same colours) to 1 (none in common), by the intersection of histograms. No
  /// allocation. @param picture at @p eye's resolution
  double Of(const ImageView& picture, const EyeGeometry& eye, const RigidTransform& X_CM) const;

 private:
  struct Point {
    Eigen::Vector3f p, normal;  ///< M [m]
    float along_normal;         ///< p . normal
  };
  std::vector<Point> skin_, hair_, outline_;
};

}  // namespace visavis
