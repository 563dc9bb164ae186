#include "services/recogniser/head_file.h"

#include <cmath>
#include <fstream>
#include <stdexcept>
#include <utility>

#include "common/config/config_reader.h"
#include "common/config/config_writer.h"

namespace visavis {
namespace {

double Mm(float metres) { return std::round(1e6 * static_cast<double>(metres)) / 1e3; }
constexpr int kLevel = 4, kMeasuredLevel = 5;  ///< of the icosphere: learned, from a mesh
constexpr std::size_t kFewestFacePoints = 100, kMostFacePoints = 5000;
constexpr double kFarthest_mm = 400, kBrightest = 255;

double Thousandths(float x) { return std::round(1e3 * static_cast<double>(x)) / 1e3; }
float Metres(double mm) { return static_cast<float>(1e-3 * mm); }

void RequireRadii(const std::vector<double>& radii_mm) {
  if (Icosphere::LevelOf(radii_mm.size()) < 2) {
    throw FieldError("radii_mm", std::to_string(radii_mm.size()) + " numbers",
                     "must be 162, 642, 2562, 10242 or 40962: the vertices of an icosphere");
  }
  const double least = 1e3 * static_cast<double>(HeadTable::kMinRadius_m);
  const double most = 1e3 * static_cast<double>(HeadTable::kMaxRadius_m);
  for (const double radius : radii_mm) {
    if (!(radius >= least && radius <= most)) {
      throw FieldError("radii_mm", std::to_string(radius), "must each be 20 to 400 mm");
    }
  }
}

void RequireFace(const HeadFile& file) {
  const std::size_t n = file.face_points_mm.size() / 3;
  if (file.face_points_mm.size() % 3 != 0 || (n > 0 && n < kFewestFacePoints) ||
      n > kMostFacePoints) {
    throw FieldError("face_points_mm", std::to_string(file.face_points_mm.size()) + " numbers",
                     "must be x y z of 100 to 5000 points, or none");
  }
  for (const double x : file.face_points_mm) {
    if (!(std::abs(x) <= kFarthest_mm)) {
      throw FieldError("face_points_mm", std::to_string(x), "must each be -400 to 400 mm");
    }
  }
  for (const auto& [key, values] :
       {std::pair("face_fine", &file.face_fine), std::pair("face_coarse", &file.face_coarse)}) {
    if (values->size() != n) {
      throw FieldError(key, std::to_string(values->size()) + " numbers",
                       "must be one for each point of face_points_mm");
    }
    for (const double value : *values) {
      if (!(std::abs(value) <= kBrightest)) {
        throw FieldError(key, std::to_string(value), "must each be -255 to 255");
      }
    }
  }
}

LearnedFace FaceOf(const HeadFile& file, const HeadSurface& surface) {
  LearnedFace face;
  for (std::size_t i = 0; i < file.face_fine.size(); ++i) {
    face.points.emplace_back(Metres(file.face_points_mm[3 * i]),
                             Metres(file.face_points_mm[3 * i + 1]),
                             Metres(file.face_points_mm[3 * i + 2]));
    face.normals.push_back(surface.NormalAt(face.points.back()));
    face.value[kFineBand].push_back(static_cast<float>(file.face_fine[i]));
    face.value[kCoarseBand].push_back(static_cast<float>(file.face_coarse[i]));
  }
  return face;
}

}  // namespace

void HeadFile::ValidateOrThrow() const {
  RequireRadii(radii_mm);
  if (!hair_side_mm.empty() && hair_side_mm.size() != radii_mm.size()) {
    throw FieldError("hair_side_mm", std::to_string(hair_side_mm.size()) + " numbers",
                     "must be as many as radii_mm, or none");
  }
  for (const double side : hair_side_mm) {
    if (!(std::abs(side) <= 1000)) {
      throw FieldError("hair_side_mm", std::to_string(side), "must each be -1000 to 1000 mm");
    }
  }
  RequireFace(*this);
  if (origin_mm.size() != 3) {
    throw FieldError("origin_mm", std::to_string(origin_mm.size()) + " numbers", "must be three");
  }
  for (const double x : origin_mm) {
    if (!(std::abs(x) <= 1000)) {
      throw FieldError("origin_mm", std::to_string(x), "must each be -1000 to 1000 mm");
    }
  }
}

HeadGeometry LoadHeadFile(const std::string& filename) {
  const auto file = LoadConfig<HeadFile>(filename);
  HeadShape shape;
  shape.eye_x = Metres(file.eye_x_mm);
  shape.eye_y = Metres(file.eye_y_mm);
  shape.brow_y = Metres(file.brow_y_mm);
  shape.nostril_y = Metres(file.nostril_y_mm);
  shape.mouth_y = Metres(file.mouth_y_mm);
  shape.hair_tilt_rad = static_cast<float>(file.hair_tilt_deg * M_PI / 180);
  shape.hair_offset = Metres(file.hair_offset_mm);
  HeadTable table;
  for (const double radius : file.radii_mm) table.radii_m.push_back(Metres(radius));
  for (const double side : file.hair_side_mm) table.hair_side_m.push_back(Metres(side));
  const auto& o = file.origin_mm;
  HeadGeometry head{HeadSurface(shape, table), 1e-3 * Eigen::Vector3d(o[0], o[1], o[2])};
  if (!file.face_points_mm.empty()) head.face = FaceOf(file, head.surface);
  head.is_measured = file.measured;
  return head;
}

namespace {

/// Holds values against the rules that the reader holds them against.
class RuleChecker {
 public:
  template <typename T>
  void Visit(const std::string&, T*) {}
  void Visit(const std::string& key, double* value, const Rule<double>& rule) {
    if (!rule.holds(*value)) throw FieldError(key, std::to_string(*value), rule.text);
  }
};

void RequireReadable(const std::string& filename, HeadFile file) {
  try {
    RuleChecker checker;
    file.Serialize(&checker);
    file.ValidateOrThrow();
  } catch (const FieldError& e) {
    throw std::invalid_argument(filename + ": is not written: " + e.what());
  }
}

}  // namespace

void SaveHeadFile(const std::string& filename, const HeadGeometry& head) {
  const HeadShape& shape = head.surface.shape();
  HeadFile file;
  file.eye_x_mm = Mm(shape.eye_x);
  file.eye_y_mm = Mm(shape.eye_y);
  file.brow_y_mm = Mm(shape.brow_y);
  file.nostril_y_mm = Mm(shape.nostril_y);
  file.mouth_y_mm = Mm(shape.mouth_y);
  file.hair_tilt_deg = static_cast<double>(shape.hair_tilt_rad) * 180 / M_PI;
  file.hair_offset_mm = Mm(shape.hair_offset);
  for (int i = 0; i < 3; ++i) file.origin_mm[static_cast<std::size_t>(i)] = 1e3 * head.p_MR_m[i];
  file.measured = head.is_measured;
  const HeadTable table = TableOf(head.surface, head.is_measured ? kMeasuredLevel : kLevel);
  for (const float radius : table.radii_m) file.radii_mm.push_back(Mm(radius));
  for (const float side : table.hair_side_m) file.hair_side_mm.push_back(Mm(side));
  if (head.face) {
    for (std::size_t i = 0; i < head.face->points.size(); ++i) {
      for (int k = 0; k < 3; ++k) file.face_points_mm.push_back(Mm(head.face->points[i][k]));
      file.face_fine.push_back(Thousandths(head.face->value[kFineBand][i]));
      file.face_coarse.push_back(Thousandths(head.face->value[kCoarseBand][i]));
    }
  }
  RequireReadable(filename, file);
  std::ofstream out(filename);
  out << "# A head for visavis-recogniser: refined.head.file. Radii by direction, frame M, mm.\n"
      << DumpConfig(file) << "\n";
  out.close();
  if (!out) throw std::runtime_error(filename + ": cannot be written");
}

}  // namespace visavis
