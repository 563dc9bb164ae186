#pragma once

#include <array>
#include <vector>

#include "services/recogniser/refined/appearance.h"
#include "services/recogniser/refined/learned_face.h"

namespace visavis {

/// How this face looks, learned from poses that were good: brightness at points in each band, in
/// the units of the first picture that the band is learned from. The points begin on the generic
/// head's surface.
class FaceTexture {
 public:
  explicit FaceTexture(const FacePoints& face);

  /// Neither this nor Remember() allocates once both were called.
  void Forget();
  /// Takes over @p face, as if it had been learned for long.
  void Remember(const LearnedFace& face);
  /// Whether it was taken over, not learned here: its frame is fixed, and so is it.
  bool fixed() const { return fixed_; }
  /// The points known in every band that was learned.
  LearnedFace Learned() const;
  /// The points in the M frame.
  const FacePoints& points() const { return points_; }
  /// Moves all points together: those at p go to @p X_MN p.
  void Move(const RigidTransform& X_MN);
  /// Averages @p samples of one eye in, after gain and offset. The first sight counts fully, later
  /// ones less and less.
  void Learn(Band band, const FaceSamples& samples);

  bool learned() const { return learned_[kFineBand] || learned_[kCoarseBand]; }
  const std::vector<float>& pattern(Band band) const { return value_[band]; }
  /// Points that were seen in @p band, and are compared there.
  const std::vector<unsigned char>& known(Band band) const { return known_[band]; }

 private:
  const FacePoints& generic_;
  FacePoints points_;
  bool fixed_{false};
  std::array<bool, kNumBands> learned_{};
  std::array<std::vector<float>, kNumBands> value_, weight_;
  std::array<std::vector<unsigned char>, kNumBands> known_;
};

}  // namespace visavis
