#include "tests/people/looks_training.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/people/weighted.h"

namespace visavis {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int kModes = static_cast<int>(kLooksModes);
constexpr int kRounds = 6, kFillRounds = 6;
constexpr int kFewestCells = 200;          ///< that a gain is fitted to
constexpr double kLeastCorrelation = 0.2;  ///< of a picture with the mean
// Of what would explain all of a picture's contrast: who looks like nobody else counts as the
// others.
constexpr double kLeastGain = 0.7;
constexpr double kKnownShare = 0.6;  ///< of the recordings: cells that fewer show are unknown
constexpr double kUnit = 0.104;      ///< root mean square of the fine mean: AdultLooks' unit
const double kNaN = std::numeric_limits<double>::quiet_NaN();

/// Gain and offset of a picture.
struct Exposure {
  double gain{0}, offset{0};  ///< gain 0: the picture does not count
};

Exposure FitExposure(const std::vector<float>& values, const VectorXd& mean,
                     const std::vector<bool>& on_face) {
  double n = 0, x = 0, y = 0, xx = 0, xy = 0, yy = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double m = mean[static_cast<Index>(i)];
    if (!on_face[i] || std::isnan(values[i]) || std::isnan(m)) continue;
    const auto v = static_cast<double>(values[i]);
    n += 1;
    x += m;
    y += v;
    xx += m * m;
    xy += m * v;
    yy += v * v;
  }
  if (n < kFewestCells) return {};
  const double var_x = xx - x * x / n, var_y = yy - y * y / n, cov = xy - x * y / n;
  if (!(cov > kLeastCorrelation * std::sqrt(var_x * var_y))) return {};
  const double gain = std::max(cov / var_x, kLeastGain * std::sqrt(var_y / var_x));
  return {gain, (y - gain * x) / n};
}

/// The exposure under which the picture's own contrast is 1.
Exposure OwnExposure(const std::vector<float>& values, const std::vector<bool>& on_face) {
  double n = 0, y = 0, yy = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!on_face[i] || std::isnan(values[i])) continue;
    const auto v = static_cast<double>(values[i]);
    n += 1;
    y += v;
    yy += v * v;
  }
  if (n < kFewestCells) return {};
  return {std::sqrt(std::max(yy / n - y * y / (n * n), 1e-9)), y / n};
}

/// The looks of each recording in one band, a column; NaN where a cell is not seen.
class BandLooks {
 public:
  BandLooks(const LooksGrid& grid, const std::vector<RecordedLooks>& recordings, Band band,
            const std::vector<bool>& on_face)
      : grid_(grid), recordings_(recordings), band_(band), on_face_(on_face) {
    Average([&](const std::vector<float>& values) { return OwnExposure(values, on_face_); });
    for (int round = 0; round < kRounds; ++round) {
      const VectorXd mean = mean_;
      Average(
          [&](const std::vector<float>& values) { return FitExposure(values, mean, on_face_); });
    }
  }

  const MatrixXd& looks() const { return looks_; }
  const VectorXd& mean() const { return mean_; }  ///< symmetric
  const VectorXd& seen() const { return seen_; }  ///< share of the recordings
  /// Median of the pictures' gains [levels].
  double gain() const { return gain_; }

 private:
  /// A recording's pictures, each by its gain squared: as noise of one size counts.
  template <typename ExposureOf>
  void Average(const ExposureOf& exposure_of) {
    const Index n = grid_.size();
    looks_.resize(n, static_cast<Index>(recordings_.size()));
    WeightedValues gains;
    for (std::size_t r = 0; r < recordings_.size(); ++r) {
      VectorXd sum = VectorXd::Zero(n), weights = sum;
      for (const LooksView& view : recordings_[r].views) {
        const std::vector<float>& values = view[band_];
        const Exposure exposure = exposure_of(values);
        if (exposure.gain <= 0) continue;
        gains.Add(exposure.gain, recordings_[r].weight);
        for (Index i = 0; i < n; ++i) {
          const auto v = static_cast<double>(values[static_cast<std::size_t>(i)]);
          if (std::isnan(v)) continue;
          sum[i] += exposure.gain * (v - exposure.offset);
          weights[i] += exposure.gain * exposure.gain;
        }
      }
      looks_.col(static_cast<Index>(r)) = sum.cwiseQuotient(weights);  // 0 / 0: not seen
    }
    gain_ = gains.empty() ? 1 : gains.Median();
    FindMean();
  }

  void FindMean() {
    const Index n = grid_.size();
    mean_.resize(n);
    seen_.resize(n);
    for (int i = 0; i < grid_.size(); ++i) {
      double sum = 0, weights = 0, all = 0;
      for (std::size_t r = 0; r < recordings_.size(); ++r) {
        for (const int cell : {i, grid_.Mirrored(i)}) {
          const double v = looks_(cell, static_cast<Index>(r));
          all += recordings_[r].weight;
          if (std::isnan(v)) continue;
          sum += recordings_[r].weight * v;
          weights += recordings_[r].weight;
        }
      }
      mean_[i] = weights > 0 ? sum / weights : kNaN;
      seen_[i] = weights / all;
    }
    // Between the fits nothing holds the scale.
    double square = 0, count = 0;
    for (Index i = 0; i < n; ++i) {
      if (!on_face_[static_cast<std::size_t>(i)] || std::isnan(mean_[i])) continue;
      square += mean_[i] * mean_[i];
      count += 1;
    }
    const double rms = std::sqrt(square / count);
    mean_ /= rms;
    looks_ /= rms;
    gain_ *= rms;
  }

  const LooksGrid grid_;
  const std::vector<RecordedLooks>& recordings_;
  const Band band_;
  const std::vector<bool>& on_face_;
  MatrixXd looks_;
  VectorXd mean_, seen_;
  double gain_{1};
};

/// Deviations from the mean over the known cells, of each recording as it is and mirrored.
MatrixXd DeviationsOf(const BandLooks& band, const LooksGrid& grid, const std::vector<int>& cells) {
  const MatrixXd& looks = band.looks();
  MatrixXd deviations(static_cast<Index>(cells.size()), 2 * looks.cols());
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const auto row = static_cast<Index>(i);
    const double mean = band.mean()[cells[i]];
    deviations.row(row).head(looks.cols()) = looks.row(cells[i]).array() - mean;
    deviations.row(row).tail(looks.cols()) = looks.row(grid.Mirrored(cells[i])).array() - mean;
  }
  return deviations;
}

/// What of @p deviations lies in the span of orthogonal @p modes.
MatrixXd Explained(const MatrixXd& deviations, const MatrixXd& modes) {
  const VectorXd squares = modes.colwise().squaredNorm().cwiseMax(1e-12);
  return modes * squares.cwiseInverse().asDiagonal() * (modes.transpose() * deviations);
}

VectorXd DeviationOf(const MatrixXd& left, const Eigen::Array<bool, -1, -1>& seen,
                     const VectorXd& weights) {
  VectorXd deviation(left.rows());
  for (Index i = 0; i < left.rows(); ++i) {
    double square = 0, all = 0;
    for (Index k = 0; k < left.cols(); ++k) {
      if (!seen(i, k)) continue;
      square += weights[k] * left(i, k) * left(i, k);
      all += weights[k];
    }
    deviation[i] = std::sqrt(square / all);
  }
  return deviation;
}

}  // namespace

LooksModel TrainLooks(const LooksGrid& grid, const std::vector<RecordedLooks>& recordings,
                      const std::vector<bool>& on_face) {
  const BandLooks fine(grid, recordings, kFineBand, on_face),
      coarse(grid, recordings, kCoarseBand, on_face);
  LooksModel model;
  std::vector<int> cells;
  for (int i = 0; i < grid.size(); ++i) {
    model.known.push_back(fine.seen()[i] >= kKnownShare);
    if (model.known.back()) cells.push_back(i);
  }
  VectorXd weights(2 * static_cast<Index>(recordings.size()));
  for (std::size_t r = 0; r < recordings.size(); ++r) {
    const auto k = static_cast<Index>(r);
    weights[k] = weights[k + weights.size() / 2] = 0.5 * recordings[r].weight;
  }
  double square = 0;
  for (const int cell : cells) square += fine.mean()[cell] * fine.mean()[cell];
  const double unit = kUnit / std::sqrt(square / static_cast<double>(cells.size()));
  // The coarse band in the same unit, as the pictures have them.
  const std::array<double, kNumBands> units = {unit, unit * coarse.gain() / fine.gain()};
  for (const BandLooks* band : {&fine, &coarse}) {
    const std::size_t b = band == &fine ? kFineBand : kCoarseBand;
    MatrixXd deviations = DeviationsOf(*band, grid, cells);
    const Eigen::Array<bool, -1, -1> seen = deviations.array().isFinite();
    // What is not seen is what the modes make of the rest, in turn with the modes.
    deviations = seen.select(deviations, 0);
    MatrixXd modes;
    for (int round = 0; round < kFillRounds; ++round) {
      modes = PrincipalModes(deviations, weights, kModes);
      deviations = seen.select(deviations, Explained(deviations, modes));
    }
    const VectorXd doubt = DeviationOf(deviations - Explained(deviations, modes), seen, weights);
    model.mean[b] = model.doubt[b] = VectorXd::Zero(grid.size());
    if (b == kFineBand) model.modes = MatrixXd::Zero(grid.size(), kModes);
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const auto row = static_cast<Index>(i);
      model.mean[b][cells[i]] = units[b] * band->mean()[cells[i]];
      model.doubt[b][cells[i]] = units[b] * doubt[row];
      if (b == kFineBand) model.modes.row(cells[i]) = units[b] * modes.row(row);
    }
  }
  return model;
}

}  // namespace visavis
