#pragma once

#include <string>
#include <vector>

#include "common/config/rule.h"
#include "services/recogniser/refined/head_geometry.h"

namespace visavis {

/// A head as a YAML file (head.yaml), as an enrolment writes it: radii by direction and where the
/// face's features are, in the head's own frame M (HeadGeometry), mm.
struct HeadFile {
  template <typename A>
  void Serialize(A* a) {
    a->Visit("eye_x_mm", &eye_x_mm, InRange(10.0, 60.0, "mm"));
    a->Visit("eye_y_mm", &eye_y_mm, InRange(-60.0, 80.0, "mm"));
    a->Visit("brow_y_mm", &brow_y_mm, InRange(-80.0, 80.0, "mm"));
    a->Visit("nostril_y_mm", &nostril_y_mm, InRange(0.0, 150.0, "mm"));
    a->Visit("mouth_y_mm", &mouth_y_mm, InRange(0.0, 150.0, "mm"));
    a->Visit("hair_tilt_deg", &hair_tilt_deg, InRange(-90.0, 90.0, "deg"));
    a->Visit("hair_offset_mm", &hair_offset_mm, InRange(-150.0, 150.0, "mm"));
    a->Visit("origin_mm", &origin_mm);
    a->Visit("measured", &measured);
    a->Visit("radii_mm", &radii_mm);
    a->Visit("hair_side_mm", &hair_side_mm);
    a->Visit("face_points_mm", &face_points_mm);
    a->Visit("face_fine", &face_fine);
    a->Visit("face_coarse", &face_coarse);
  }
  /// @throws FieldError naming key, value and rule.
  void ValidateOrThrow() const;

  double eye_x_mm{31}, eye_y_mm{13}, brow_y_mm{3.5}, nostril_y_mm{59}, mouth_y_mm{82};
  double hair_tilt_deg{34};    ///< plane between hair and skin, where hair_side_mm is empty
  double hair_offset_mm{-29};  ///< hair where -y sin(tilt) + z cos(tilt) exceeds it
  std::vector<double> origin_mm{0, 0, 0};      ///< in M, of the frame that poses are reported in
  bool measured{false};                        ///< HeadGeometry::is_measured
  std::vector<double> radii_mm;                ///< HeadTable::radii_m
  std::vector<double> hair_side_mm;            ///< HeadTable::hair_side_m, or empty
  std::vector<double> face_points_mm;          ///< LearnedFace: x y z of each point; or empty
  std::vector<double> face_fine, face_coarse;  ///< brightness there, by band
};

/// @throws ConfigError: one line with file, line, key, value and rule.
HeadGeometry LoadHeadFile(const std::string& filename);

/// What LoadHeadFile reads back: @p head by 2562 radii, a measured one by 10242, to 0.001 mm.
/// @throws std::invalid_argument naming file, key, value and rule where LoadHeadFile would refuse
/// it, and the file is not touched; std::runtime_error naming a file that cannot be written.
void SaveHeadFile(const std::string& filename, const HeadGeometry& head);

}  // namespace visavis
