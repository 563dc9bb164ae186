#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "services/recogniser/estimator.h"
#include "services/recogniser/refined/color_model.h"
#include "services/recogniser/refined/distance_ranges.h"
#include "services/recogniser/refined/head_anchor.h"
#include "services/recogniser/refined/head_geometry.h"
#include "services/recogniser/refined/head_learner.h"
#include "services/recogniser/refined/pose_covariance.h"
#include "services/recogniser/refined/prepared_head.h"
#include "services/recogniser/refined/refined_config.h"

namespace visavis {

/// Evolutionary search over a stereo model-based fitness, carried by feedforward, its elite refined
/// by Gauss-Newton over contours, the face's pattern, learned texture and left-right agreement.
class RefinedEstimator final : public Estimator {
 public:
  /// @p background: where heads are learned; aliased, null: within a frame.
  RefinedEstimator(const RefinedSettings& settings, const HeadGeometry& head, const StereoRig& rig,
                   Background* background = nullptr);

  const Estimate& Process(const StereoFrame& frame, const CameraStep& step,
                          StageTimer* timer) override;
  void Reset() override;
  void SetFeedforward(FeedforwardMode mode) override { settings_.feedforward = mode; }
  void SetSearchSpace(const SearchSpace& space) override;
  int frames_of_a_search() const override { return static_cast<int>(ranges_.size()); }
  void SetEffort(const Effort& effort) override { effort_ = effort; }
  const std::array<ColorModel, 2>& colors() const { return colors_; }
  const FaceTexture& texture() const { return texture_; }
  /// Whether the face that is looked for is the enrolled one.
  bool knows_enrolled() const { return enrolled_ && texture_.fixed() && !learned_; }
  std::pair<int, const HeadGeometry*> learned_head() const override {
    return {learned_heads_, learned_ ? &learned_->head : nullptr};
  }
  /// In M (see HeadGeometry), while the poses of estimates and settings are those of R.
  const std::vector<Individual>& population() const override { return population_.individuals(); }
  std::int64_t total_generations() const override { return total_generations_; }

  /// A pose that was refined, and what speaks for it.
  struct Candidate {
    Refined refined;
    MeshScore score;  ///< against the generic pattern

    /// Natural logarithm of the odds that it is a face where it is said to be, against a likeness
    /// of one; a logistic regression.
    double log_odds() const;
  };

  /// What the last search refined, most likely first.
  const std::vector<Candidate>& candidates() const { return candidates_; }
  /// What the last frame chose, believed or not.
  const Candidate& chosen() const { return candidate_; }

 private:
  void ForgetFace();
  void RememberEnrolled();
  /// Whether the face that is tracked as a stranger's is the enrolled one after all.
  void LookForEnrolled();
  WorkingPair& pair() { return ranges_.pair(range_); }
  const WorkingPair& pair() const { return ranges_.pair(range_); }
  /// From here on the pictures are those of the @p range.
  void WorkIn(std::size_t range);
  /// Where the search begins.
  std::size_t FirstRange() const;
  void CentreOn(const Eigen::Vector3d& p_CM);
  void FollowHead();
  /// The pictures of the frame, of all of the @p range's space.
  void LookInto(std::size_t range);
  void TakePictures();
  /// Maps of the whole pictures, or of the part round @p X_CM.
  void BuildMaps(const RigidTransform* X_CM);
  /// Whether all that the pictures show of a face at @p X_CM is in the maps.
  bool IsMapped(const RigidTransform& X_CM) const;
  void Feedforward(const CameraStep& step);
  Candidate Scored(const Refined& refined) const;
  Candidate RefineFrom(const RigidTransform& X_CM, const FaceTexture* texture, int iterations,
                       int reach_px);
  Candidate Track();
  /// The same from where the head is found, if that is partly outside of the maps.
  Candidate Follow();
  /// Where the learned face was lost, if it is there again: from behind a hand.
  std::optional<Candidate> WhereLost();
  Candidate Search();
  /// The same; where several faces are in view and none is known, the one that is wanted.
  Candidate SearchNearest();
  /// ColorContrast of one eye; the other would tell the same.
  double Contrast(const RigidTransform& X_CM) const;
  bool WasRejected(const Vector6d& phi) const;
  void RejectPlaces();
  /// What the search maximises; a value below @p worth may be too low by less than what is
  /// missing.
  double Fitness(const MeshFitness& fitness, const Vector6d& phi, double worth);
  /// The best of distinct places.
  std::vector<RigidTransform> Places();
  std::vector<Vector6d> Niches() const;
  void RefineStarts(const std::vector<RigidTransform>& places);
  /// Refines @p rough where that is promising. @return whether it is, beyond doubt, the face that
  /// is looked for.
  bool IsSureFace(Candidate* rough);
  std::vector<Eigen::Matrix3d> BestTurns(const Eigen::Vector3d& p_CM);
  void KeepPromising();
  void SortPlausible();
  std::optional<Candidate> KnownAmongCandidates();
  Candidate BestVerified();
  Candidate TryTurned(const Candidate& candidate);
  Candidate TryEveryTurn(const Candidate& candidate);
  Candidate TryAskew(const Candidate& candidate);
  Candidate BestTurned(const Candidate& candidate, const std::vector<Eigen::Matrix3d>& turns);
  /// What remains of @p candidate when the colours are learned from it: of a head more than before,
  /// of a chance likeness less. The colour models are left as learned.
  Candidate Verify(const Candidate& candidate);
  /// The learned texture's view of a pose that the generic face found.
  Candidate Recognise(const Candidate& candidate);
  bool BothEyes() const { return view_[0].seen() && view_[1].seen(); }
  bool IsPlausible(const RigidTransform& X_CM) const;
  bool IsFace(const Candidate& candidate) const;
  bool IsClearFace(const Candidate& candidate) const;
  /// Its colours are a head's, whatever its face is.
  bool IsHead(const Candidate& candidate) const;
  bool IsPromising(const Candidate& candidate) const;
  bool IsKnownFace(const Candidate& candidate, double least_texture_ncc) const;
  /// The learned face, where it was not a frame before.
  bool IsKnownAgain(const Candidate& candidate) const;
  /// What the face of the texture that @p candidate was refined with must show.
  bool HasLooks(const Candidate& candidate, double least_texture_ncc) const;
  /// A space of poses of R as one of poses of M: their places differ by the offset, at any small
  /// angle.
  SearchSpace InM(SearchSpace space) const;
  bool IsNewFace();
  void Judge(bool good);
  void Learn(const StereoFrame& frame);
  void TakeLearned();
  PreparedHead& head() { return learned_ ? *learned_ : head_; }
  const PreparedHead& head() const { return learned_ ? *learned_ : head_; }
  void LearnColors(const RigidTransform& X_CM);
  void MoveAnchor();
  /// Of the pose of R. @p good: the face was seen.
  Matrix6d Covariance(bool good) const;

  /// @p count lowered to @p share of it, not below @p least.
  static int Lowered(int count, double share, int least);

  RefinedSettings settings_;
  Effort effort_;
  PreparedHead head_;                      ///< that was looked for first
  std::unique_ptr<PreparedHead> learned_;  ///< in its place, once it was learned
  const RigidTransform X_MR_;              ///< the frame that poses are reported in
  const StereoRig rig_;
  DistanceRanges ranges_;
  std::size_t range_{0};           ///< that is worked in
  std::size_t searched_range_{0};  ///< that was searched last, not round a place
  FaceTexture texture_;
  std::optional<FaceTexture> enrolled_;
  HeadLearner learner_;
  int learned_heads_{0};
  HeadAnchor anchor_;
  PoseCovariance covariance_;
  std::array<ColorModel, 2> colors_, colors_best_;
  std::array<ColorModel, 2> colors_before_;  ///< this frame's search
  /// A stranger was seen in the space that is centred; the search looked elsewhere since.
  bool is_stranger_centred_{false}, is_aside_{false};
  std::array<int, 2> color_channels_{};  ///< of the pictures that colors_ are of; 0: not started
  ColorModel::Counts counts_;
  std::array<ScoreMap, 2> scores_;
  std::array<BandImages, 2> bands_;
  const StereoFrame* frame_{nullptr};  ///< that is processed; aliased
  std::array<std::optional<ImageView>, 2> pictures_;
  StereoView view_;
  RealPopulation population_;
  bool is_centred_{false};                    ///< the population's space is round centre_
  std::optional<Eigen::Vector3d> centre_;     ///< of the search space once a head was tracked
  std::optional<RigidTransform> X_CM_;        ///< of the last frame, carried to this one
  std::optional<RigidTransform> known_X_CM_;  ///< where the learned face was last seen, likewise
  Candidate candidate_;
  std::vector<Individual> best_shots_;  ///< of this frame's search
  std::vector<Candidate> candidates_;
  std::vector<Eigen::Vector3d> rejected_;  ///< p_CM of places that proved to be no face
  Estimate estimate_;
  std::int64_t frames_{0}, total_generations_{0};
  int good_in_a_row_{0}, bad_in_a_row_{0}, strange_in_a_row_{0}, one_eye_in_a_row_{0};
};

}  // namespace visavis
