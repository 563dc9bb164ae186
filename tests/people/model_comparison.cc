#include "tests/people/model_comparison.h"

#include <Eigen/QR>
#include <cmath>
#include <iomanip>
#include <vector>

#include "services/recogniser/refined/adult_head.h"
#include "services/recogniser/refined/icosphere.h"

namespace visavis {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Values of the old and of the new model at the same places.
class Pairs {
 public:
  void Add(double old_value, double new_value) {
    n_ += 1;
    x_ += old_value;
    y_ += new_value;
    xx_ += old_value * old_value;
    yy_ += new_value * new_value;
    xy_ += old_value * new_value;
  }
  void Add(float old_value, float new_value) {
    Add(static_cast<double>(old_value), static_cast<double>(new_value));
  }
  double rms_difference() const { return std::sqrt((xx_ - 2 * xy_ + yy_) / n_); }
  double rms_old() const { return std::sqrt(xx_ / n_); }
  double rms_new() const { return std::sqrt(yy_ / n_); }
  double correlation() const {
    return (xy_ - x_ * y_ / n_) / std::sqrt((xx_ - x_ * x_ / n_) * (yy_ - y_ * y_ / n_));
  }

 private:
  double n_{0}, x_{0}, y_{0}, xx_{0}, yy_{0}, xy_{0};
};

void Print(const char* what, const Pairs& pairs, double unit, std::ostream* out) {
  *out << std::left << std::setw(36) << what << std::fixed << std::setprecision(3) << "old rms "
       << pairs.rms_old() / unit << ", new " << pairs.rms_new() / unit << ", difference "
       << pairs.rms_difference() / unit << ", correlation " << pairs.correlation() << '\n';
}

/// Share of the columns' squares that lies in the span of the columns of @p modes.
double SpannedShare(const MatrixXd& columns, const MatrixXd& modes) {
  const Eigen::HouseholderQR<MatrixXd> qr(modes);
  const MatrixXd basis = qr.householderQ() * MatrixXd::Identity(modes.rows(), modes.cols());
  return (basis.transpose() * columns).squaredNorm() / columns.squaredNorm();
}

void CompareShapes(const ShapeModel& shape, std::ostream* out) {
  const AdultHead& old = TheAdult();
  const Icosphere sphere(Icosphere::LevelOf(shape.table.radii_m.size()));
  const auto n = static_cast<Index>(sphere.vertices().size());
  MatrixXd modes = MatrixXd::Zero(n, shape.modes_m.cols());
  for (std::size_t i = 0; i < shape.region.size(); ++i)
    modes.row(shape.region[i]) = shape.modes_m.row(static_cast<Index>(i));
  Pairs face, face_sigma, rest, rest_sigma, hair;
  for (std::size_t i = 0; i < sphere.vertices().size(); ++i) {
    const Eigen::Vector3f& direction = sphere.vertices()[i];
    const float radius = old.surface.Radius(direction);
    const bool is_face = !modes.row(static_cast<Index>(i)).isZero();
    (is_face ? face : rest).Add(radius, shape.table.radii_m[i]);
    (is_face ? face_sigma : rest_sigma).Add(old.surface.Sigma(direction), shape.table.sigma_m[i]);
    hair.Add(old.surface.HairSide(radius * direction), shape.table.hair_side_m[i]);
  }
  Print("radii of the face [mm]", face, 1e-3, out);
  Print("their deviations [mm]", face_sigma, 1e-3, out);
  Print("radii elsewhere [mm]", rest, 1e-3, out);
  Print("their deviations [mm]", rest_sigma, 1e-3, out);
  Print("distance to the hair [mm]", hair, 1e-3, out);
  if (old.shape_modes_m.rows() != n) return;
  *out << "variance of shapes: old " << 1e6 * old.shape_modes_m.squaredNorm() << " mm2, new "
       << 1e6 * modes.squaredNorm() << " mm2; of the old " << SpannedShare(old.shape_modes_m, modes)
       << " within the new, of the new " << SpannedShare(modes, old.shape_modes_m)
       << " within the old\n";
}

void CompareLooks(const LooksModel& looks, std::ostream* out) {
  const AdultLooks& old = TheAdult().looks;
  const LooksGrid& grid = looks.grid;
  std::array<Pairs, kNumBands> means;
  Pairs doubt;
  MatrixXd old_modes(grid.size(), static_cast<Index>(kLooksModes)), new_modes = looks.modes;
  int known = 0, both = 0;
  for (int cell = 0; cell < grid.size(); ++cell) {
    const AdultLooks::Place place = old.At(grid.x_m(cell), grid.y_m(cell));
    const bool is_known = looks.known[static_cast<std::size_t>(cell)];
    known += is_known;
    if (!is_known || !place.known) {
      old_modes.row(cell).setZero();
      new_modes.row(cell).setZero();
      continue;
    }
    ++both;
    for (std::size_t band = 0; band < kNumBands; ++band)
      means[band].Add(static_cast<double>(place.mean[band]), looks.mean[band][cell]);
    doubt.Add(static_cast<double>(place.doubt), looks.doubt[kFineBand][cell]);
    for (std::size_t k = 0; k < kLooksModes; ++k)
      old_modes(cell, static_cast<Index>(k)) = static_cast<double>(place.modes[k]);
  }
  *out << "cells known: " << known << " of " << grid.size() << ", " << both << " to both\n";
  Print("mean look, fine band", means[kFineBand], 1, out);
  Print("mean look, coarse band", means[kCoarseBand], 1, out);
  Print("doubt, fine band", doubt, 1, out);
  *out << "variance of looks: old " << old_modes.squaredNorm() / both << ", new "
       << new_modes.squaredNorm() / both << "; of the old " << SpannedShare(old_modes, new_modes)
       << " within the new, of the new " << SpannedShare(new_modes, old_modes)
       << " within the old\n";
}

}  // namespace

void PrintComparison(const TrainedHead& head, std::ostream* out) {
  CompareShapes(head.shape, out);
  CompareLooks(head.looks, out);
}

}  // namespace visavis
