#pragma once

#include <array>
#include <vector>

#include "services/recogniser/refined/face_kernel.h"
#include "services/recogniser/refined/face_points.h"
#include "services/recogniser/refined/head_mesh.h"
#include "services/recogniser/refined/score_kernel.h"
#include "services/recogniser/refined/stereo_view.h"

namespace visavis {

/// How well a pose explains the pictures; each a mean over the eyes.
struct MeshScore {
  double inside{0};     ///< colours on the head: about 1 where they are a head's
  double outside{0};    ///< colours round the head: about 1 where they are a head's too (bad)
  double ncc{0};        ///< correlation of the coarse band with the face's pattern, -1 to 1
  double agreement{0};  ///< correlation of both eyes' coarse bands on the face, -1 to 1
  bool has_ncc{false};
  /// What a track's population maximises.
  double total() const;
  /// What the search maximises: a likeness that both eyes see at one depth.
  double found() const { return total() + kAgreementWeight * agreement; }

  static constexpr double kAgreementWeight = 0.8;
};

/// The fitness that the population is judged by: a solid model's inside, its surroundings (Eqs. 22
/// to 29 in spirit, with learned colours for fixed rules) and the features' pattern.
class MeshFitness {
 public:
  /// @p detail: what share of the mesh's and the face's points is looked at, one in so many.
  MeshFitness(const HeadMesh& mesh, const FacePoints& face, int detail);

  /// The face's pattern is the generic one's coarse band. All sums are exact integers, equal on
  /// every SIMD target. No allocation.
  MeshScore Evaluate(const StereoView& view, const RigidTransform& X_CM) const;

  /// The same and the eyes' agreement.
  MeshScore Look(const StereoView& view, const RigidTransform& X_CM) const;

  /// Look()'s found(), for many poses of which few are wanted: where what the right eye
  /// shows, with the left one's agreement, is less than @p worth by 0.3, that decides alone.
  double FoundIfWorth(const StereoView& view, const RigidTransform& X_CM, double worth) const;

 private:
  using Poses = std::array<KernelEye, 2>;

  void AddPattern(const FacePoints& face, std::size_t step);
  static Poses PosesOf(const StereoView& view, const RigidTransform& X_CM);
  void AddCorrelation(const StereoView& view, const Poses& poses, MeshScore* score) const;
  void AddAgreement(const StereoView& view, const Poses& poses, MeshScore* score) const;
  void AddInside(const StereoView& view, const Poses& poses, MeshScore* score) const;
  void AddOutside(const StereoView& view, const Poses& poses, MeshScore* score) const;

  ScorePoints inside_, outside_;
  PatternPoints pattern_;
};

}  // namespace visavis
