#include "services/recogniser/head_file.h"

#include <cmath>
#include <fstream>
#include <stdexcept>

#include "common/config/config_reader.h"
#include "common/config/config_writer.h"

namespace visavis {
namespace {

double Mm(float metres) { return std::round(1e6 * static_cast<double>(metres)) / 1e3; }
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
  return {HeadSurface(shape, table), 1e-3 * Eigen::Vector3d(o[0], o[1], o[2])};
}

void SaveHeadFile(const std::string& filename, const HeadGeometry& head, int level) {
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
  const HeadTable table = TableOf(head.surface, level);
  for (const float radius : table.radii_m) file.radii_mm.push_back(Mm(radius));
  for (const float side : table.hair_side_m) file.hair_side_mm.push_back(Mm(side));
  std::ofstream out(filename);
  out << "# A head for visavis-recogniser: refined.head.file. Radii by direction, frame M, mm.\n"
      << DumpConfig(file) << "\n";
  out.close();
  if (!out) throw std::runtime_error(filename + ": cannot be written");
}

}  // namespace visavis
