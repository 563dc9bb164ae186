#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "services/recogniser/refined/background.h"
#include "services/recogniser/refined/color_model.h"
#include "services/recogniser/refined/face_frame.h"
#include "services/recogniser/refined/head_bundle.h"
#include "services/recogniser/refined/new_sides.h"

namespace visavis {

/// Learns the shape, the looks and the frame of a head while it is tracked: the views of the first
/// seconds, one a direction, are bundled beside the frames, anew as soon as half as many have come,
/// or fewer in 150 frames.
/// A head learned is there so many frames after its learning was begun, not before: a log played
/// again gives the same.
class HeadLearner {
 public:
  /// @p background is aliased; null: the learning is done within a frame.
  HeadLearner(const RefinerConfig& config, const StereoRig& rig, double distance_m,
              const HeadGeometry& start, int most_views, Background* background);
  ~HeadLearner();

  /// Where the head is expected: views are kept at the resolution that suits it. Holds from the
  /// next head on where views of this one were taken.
  void SetDistance(double distance_m);
  /// Another head from here on.
  void Forget();
  /// A frame without the track.
  void Lose() { sides_.Unsettle(); }
  /// A pair that shows the head at @p X_CM well, in the frame of what was learned last. Takes it if
  /// it shows a new side.
  void Add(const StereoFrame& frame, const RigidTransform& X_CM,
           const std::array<ColorModel, 2>& colors);

  struct Learned {
    std::unique_ptr<PreparedHead> head;  ///< with its face
    RigidTransform X_MN;                 ///< of the frame that views were told in before
    double likeness{0};                  ///< of the face to faces, see FaceFrame
  };
  /// Once a frame with a track: what was learned, where it is time for it; else a null head.
  Learned Step();

 private:
  struct Work;  // what the background touches

  int num_views() const { return static_cast<int>(sides_.poses().size()); }
  bool IsDue() const;

  const RefinerConfig config_;
  const StereoRig rig_;
  double distance_m_;
  const HeadGeometry start_;
  WorkingPair pair_;
  const int most_views_;
  NoBackground no_background_;
  Background* const background_;
  NewSides sides_;                    ///< of the views
  std::vector<HeadView> new_views_;   ///< not bundled yet
  std::array<ColorModel, 2> colors_;  ///< of the last view
  int frames_{0}, learned_views_{0}, learned_frame_{0}, begun_{-1};
  std::shared_ptr<Work> work_;
};

}  // namespace visavis
