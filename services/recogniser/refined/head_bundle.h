#pragma once

#include <array>
#include <memory>
#include <vector>

#include "common/geometry/stereo_rig.h"
#include "services/recogniser/refined/color_model.h"
#include "services/recogniser/refined/prepared_head.h"
#include "services/recogniser/refined/shape_equations.h"
#include "services/recogniser/refined/working_pair.h"

namespace visavis {

/// Bundle adjustment of a head: the poses of many views of it, its shape and its texture are made
/// to agree with all pictures at once. By turns: texture from the pictures under the poses; poses
/// against texture and contours; shape, so that both eyes and all views see the same brightness at
/// a point of the surface. The head's frame stays where the given poses put it in the mean.
class HeadBundle {
 public:
  /// @p colors: how skin and hair look to the right and the left camera. @p distance_m: about
  /// where the head is, for the working resolution.
  HeadBundle(const RefinerConfig& config, const StereoRig& rig, double distance_m,
             const HeadGeometry& head, const std::array<ColorModel, 2>& colors);

  /// Takes a pair in which the head is at @p X_CM or near; both eyes must be there. Copies it.
  void Add(const StereoFrame& frame, const RigidTransform& X_CM);
  std::size_t num_views() const { return views_.size(); }
  const RigidTransform& pose(std::size_t view) const { return views_[view].X_CM; }

  /// How well model and pictures agree; means over the views.
  struct Agreement {
    double texture_ncc{0};  ///< pictures with the texture
    double stereo_ncc{0};   ///< both eyes' pictures
    double contour_px{0};   ///< rms distance of the contours
    double moved_m{0};      ///< rms movement of the shape after all that
  };
  /// One turn of all. @return the agreement before the shape is changed.
  Agreement Round();

  /// The head as it is now, with its texture under the poses as they are now.
  HeadGeometry Enrolled();

 private:
  struct View {
    std::array<std::vector<std::uint8_t>, 2> pixels;
    std::array<ImageView, 2> pictures;
    RigidTransform X_CM;
  };
  struct Model {
    Model(const RefinerConfig& config, const HeadGeometry& head)
        : prepared(config, head), texture(prepared.face) {}
    PreparedHead prepared;
    FaceTexture texture;
  };

  void Look(const View& view);
  void LearnTexture();
  Agreement RefinePoses();
  void AddShape(const View& view, Band band);
  void AddOutline(const View& view);
  double MoveSurface();

  const RefinerConfig config_;
  const HeadGeometry start_;
  const HeadTable start_table_;
  WorkingPair pair_;
  std::array<ColorModel, 2> colors_;
  std::array<ScoreMap, 2> scores_;
  std::array<BandImages, 2> bands_;
  StereoView view_;
  std::vector<View> views_;
  ShapeEquations shape_;
  std::vector<float> displaced_;  // from start_table_, by vertex
  std::unique_ptr<Model> model_;
};

}  // namespace visavis
