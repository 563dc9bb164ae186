// Makes the coefficients of RefinedEstimator::Candidate::log_odds. Usage: train_odds LIST OFFSETS
//
// LIST, OFFSETS: as train_head reads and writes them: a line for each recording, LOG SOURCE; a line
// for each head, SOURCE y z nod [mm, mm, deg]. In frames throughout each recording, the estimator
// searches for a face of which it knows nothing; a logistic regression tells the poses that it came
// to that are right, within 12 mm and 8 deg, from those that are wrong, by more than 30 mm or
// 18 deg; what is between counts for neither. Prints how many poses there were, the coefficients in
// the order of log_odds, and percentiles of the log odds of what was likeliest in each search.
// scripts/train-head --odds makes the list.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <exception>
#include <fstream>
#include <initializer_list>
#include <iomanip>
#include <iostream>
#include <iterator>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "common/core/clock.h"
#include "common/geometry/head_angles.h"
#include "services/recogniser/log_player.h"
#include "services/recogniser/recogniser_config.h"
#include "services/recogniser/refined/refined_estimator.h"
#include "tests/people/logistic_regression.h"

namespace visavis {
namespace {

constexpr int kEvery = 6;  ///< frames: in recordings of random poses each shows another
constexpr double kRight_m = 0.012, kRight_rad = 8 * M_PI / 180;
constexpr double kWrong_m = 0.030, kWrong_rad = 18 * M_PI / 180;
constexpr double kRidge = 1e-3;

using Features = Eigen::Matrix<double, 6, 1>;
constexpr std::array<const char*, 6> kNames{"1",      "likeness", "stereo_ncc^8",
                                            "inside", "outside",  "rms_px"};

/// As in log_odds.
Features FeaturesOf(const RefinedEstimator::Candidate& c) {
  Features features;
  features << 1, c.refined.likeness, std::pow(std::max(c.refined.stereo_ncc, 0.5), 8),
      c.score.inside, c.score.outside, c.refined.contour.rms_px();
  return features;
}

enum class Verdict { kRight, kWrong, kNeither };

Verdict Judge(const RigidTransform& X_CM_truth, const RigidTransform& X_CM) {
  const RecognitionError error = ComputeRecognitionError(X_CM_truth, X_CM);
  const double off_m = error.position.norm(), off_rad = error.total_angle;
  if (off_m < kRight_m && off_rad < kRight_rad) return Verdict::kRight;
  return off_m > kWrong_m || off_rad > kWrong_rad ? Verdict::kWrong : Verdict::kNeither;
}

struct Sample {
  Features features;
  Verdict verdict;
};

/// All that one search came to.
using SearchSamples = std::vector<Sample>;

std::map<std::string, RigidTransform> ReadOffsets(const std::string& filename) {
  std::ifstream file(filename);
  if (!file) throw std::runtime_error(filename + ": can't be read");
  std::map<std::string, RigidTransform> X_TM;
  std::string line;
  for (int number = 1; std::getline(file, line); ++number) {
    std::istringstream words(line);
    std::string source;
    double y_mm = 0, z_mm = 0, nod_deg = 0;
    if (!(words >> source >> y_mm >> z_mm >> nod_deg))
      throw std::runtime_error(filename + ":" + std::to_string(number) +
                               ": must be SOURCE y z nod");
    X_TM[source] = MakeTransform(ExpRotation({M_PI / 180 * nod_deg, 0, 0}),
                                 Eigen::Vector3d(0, 1e-3 * y_mm, 1e-3 * z_mm));
  }
  return X_TM;
}

SearchSamples SamplesOf(const RefinedEstimator& estimator, const RigidTransform& X_CM_truth) {
  std::vector<RefinedEstimator::Candidate> candidates = estimator.candidates();
  candidates.push_back(estimator.chosen());
  SearchSamples samples;
  for (const auto& candidate : candidates) {
    const RigidTransform& X_CM = candidate.refined.X_CM;
    const Sample sample{FeaturesOf(candidate), Judge(X_CM_truth, X_CM)};
    if (X_CM.matrix().allFinite() && sample.features.allFinite()) samples.push_back(sample);
  }
  return samples;
}

/// Adds what is found in a recording of a head whose M is at @p X_TM.
void SearchIn(const std::string& log, const RigidTransform& X_TM,
              std::vector<SearchSamples>* searches) {
  LogPlayer player(log);
  RefinedSettings settings = RecogniserConfig{}.RefinedSettings();
  settings.refined.learned_views = 0;
  RefinedEstimator estimator(settings, HeadGeometry{}, player.rig());
  StageTimer timer(&MonotonicSeconds);
  int frame = 0;
  while (const LogPlayer::Pair* pair = player.Next()) {
    if (!pair->truth || frame++ % kEvery != 0) continue;
    estimator.Reset();
    timer.Restart();
    estimator.Process(pair->frame, pair->step, &timer);
    searches->push_back(SamplesOf(estimator, *pair->truth * X_TM));
  }
}

std::vector<SearchSamples> SearchInAll(const std::string& list, const std::string& offsets) {
  const std::map<std::string, RigidTransform> X_TM = ReadOffsets(offsets);
  std::ifstream file(list);
  if (!file) throw std::runtime_error(list + ": can't be read");
  std::vector<SearchSamples> searches;
  std::string line;
  for (int number = 1; std::getline(file, line); ++number) {
    std::istringstream words(line);
    std::string log, source;
    if (!(words >> log >> source))
      throw std::runtime_error(list + ":" + std::to_string(number) + ": must be LOG SOURCE");
    const auto offset = X_TM.find(source);
    if (offset == X_TM.end()) throw std::runtime_error(source + ": is not in " + offsets);
    SearchIn(log, offset->second, &searches);
  }
  return searches;
}

Features Fit(const std::vector<SearchSamples>& searches) {
  std::vector<Sample> judged;
  for (const SearchSamples& samples : searches) {
    std::copy_if(samples.begin(), samples.end(), std::back_inserter(judged),
                 [](const Sample& sample) { return sample.verdict != Verdict::kNeither; });
  }
  const auto count = static_cast<Eigen::Index>(judged.size());
  Eigen::MatrixXd features(count, Features::SizeAtCompileTime);
  Eigen::VectorXd truths(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const Sample& sample = judged[static_cast<std::size_t>(i)];
    features.row(i) = sample.features.transpose();
    truths[i] = sample.verdict == Verdict::kRight;
  }
  if (truths.sum() == 0 || truths.sum() == static_cast<double>(count))
    throw std::runtime_error("of " + std::to_string(count) + " poses all are " +
                             (truths.sum() == 0 ? "wrong" : "right"));
  std::cout << searches.size() << " searches; " << count << " poses, " << truths.sum()
            << " of them right\n";
  return LogisticRegression(features, truths, kRidge);
}

void PrintPercentiles(const char* name, std::vector<double> log_odds,
                      std::initializer_list<int> percents) {
  std::sort(log_odds.begin(), log_odds.end());
  std::cout << "likeliest of a search, " << name << ", " << log_odds.size() << ":";
  for (const int percent : percents) {
    if (log_odds.empty()) break;
    const std::size_t rank = log_odds.size() * static_cast<std::size_t>(percent) / 100;
    std::cout << "  " << percent << " % " << log_odds[std::min(rank, log_odds.size() - 1)];
  }
  std::cout << '\n';
}

void PrintLikeliest(const std::vector<SearchSamples>& searches, const Features& coefficients) {
  std::vector<double> right, wrong;
  for (const SearchSamples& samples : searches) {
    const auto likeliest =
        std::max_element(samples.begin(), samples.end(), [&](const Sample& a, const Sample& b) {
          return a.features.dot(coefficients) < b.features.dot(coefficients);
        });
    if (likeliest == samples.end() || likeliest->verdict == Verdict::kNeither) continue;
    (likeliest->verdict == Verdict::kRight ? right : wrong)
        .push_back(likeliest->features.dot(coefficients));
  }
  PrintPercentiles("right", right, {1, 3, 5, 10, 50});
  PrintPercentiles("wrong", wrong, {50, 90, 95, 99, 100});
}

void Train(const std::string& list, const std::string& offsets) {
  const std::vector<SearchSamples> searches = SearchInAll(list, offsets);
  const Features coefficients = Fit(searches);
  std::cout << std::fixed << std::setprecision(2) << "coefficients:";
  for (std::size_t k = 0; k < kNames.size(); ++k)
    std::cout << "  " << kNames[k] << ' ' << coefficients[static_cast<Eigen::Index>(k)];
  std::cout << '\n' << std::setprecision(1);
  PrintLikeliest(searches, coefficients);
}

}  // namespace
}  // namespace visavis

int main(int argc, char* argv[]) {
  if (argc != 3) {
    std::fputs("usage: train_odds LIST OFFSETS\n", stderr);
    return 2;
  }
  try {
    visavis::Train(argv[1], argv[2]);
    return 0;
  } catch (const std::exception& e) {
    std::fprintf(stderr, "train_odds: %s\n", e.what());
    return 1;
  }
}
