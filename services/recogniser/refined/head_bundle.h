#pragma once

#include <array>
#include <memory>
#include <utility>
#include <vector>

#include "common/geometry/stereo_rig.h"
#include "services/recogniser/refined/color_model.h"
#include "services/recogniser/refined/prepared_head.h"
#include "services/recogniser/refined/shape_equations.h"
#include "services/recogniser/refined/working_pair.h"

namespace visavis {

/// A view of a head that is kept: the part of both pictures round it, at the working resolution.
struct HeadView {
  struct Crop {
    PixelBox box;
    PixelFormat format{PixelFormat::kGray};
    std::vector<std::uint8_t> pixels;  ///< rows of the box
  };
  std::array<Crop, 2> crops;  ///< right, left
  RigidTransform X_CM;
};
/// Copies what @p frame, which must have both eyes, shows within @p radius_m of a head at @p X_CM.
HeadView ViewOf(const StereoFrame& frame, const RigidTransform& X_CM, double radius_m,
                WorkingPair* pair);

/// Bundle adjustment of a head: the poses of many views of it, its shape and its texture are made
/// to agree with all pictures at once. By turns: texture from the pictures under the poses; poses
/// against texture and contours; shape, so that both eyes and all views see the same brightness at
/// a point of the surface. The head's frame stays where the given poses put it in the mean. The
/// surface of a measured head stays as it is: the texture is moved on it as a whole instead.
class HeadBundle {
 public:
  /// @p colors: how skin and hair look to the right and the left camera. @p distance_m: about
  /// where the head is, for the working resolution. @p compared: what both eyes should see alike on
  /// the shape. kBrightness tells of it everywhere and makes it some millimetres too flat, as what
  /// shines looks different to each eye; kFineBand does not, but needs views from all sides.
  HeadBundle(const RefinerConfig& config, const StereoRig& rig, double distance_m,
             const HeadGeometry& head, const std::array<ColorModel, 2>& colors, Band compared);

  void Add(HeadView view) { views_.push_back(std::move(view)); }
  void Add(const StereoFrame& frame, const RigidTransform& X_CM) {
    Add(ViewOf(frame, X_CM, kHeadRadius_m, &pair_));
  }
  void SetColors(const std::array<ColorModel, 2>& colors) { colors_ = colors; }
  std::size_t num_views() const { return views_.size(); }
  const RigidTransform& pose(std::size_t view) const { return views_[view].X_CM; }

  /// How well model and pictures agree; means over the views.
  struct Agreement {
    double texture_ncc{0};  ///< pictures with the texture
    double stereo_ncc{0};   ///< both eyes' pictures
    double contour_px{0};   ///< rms distance of the contours
    double moved_m{0};      ///< rms movement of the shape; the way of the texture on a measured one
  };
  /// One turn of all. @return the agreement before the shape is changed.
  Agreement Round();

  /// The prior that holds the shape to the one it began with holds it to what it is now.
  void Rebase();

  /// Moves the head's frame on it: poses and shape are told from M afterwards. Not of a measured
  /// head, whose frame is its own.
  void MoveFrame(const RigidTransform& X_MN);

  /// The head as it is now, with its texture under the poses as they are now.
  HeadGeometry Enrolled();

 private:
  struct Model {
    Model(const RefinerConfig& config, const HeadGeometry& head)
        : faced(config, head), texture(faced.face) {}
    FacedHead faced;
    FaceTexture texture;
  };

  /// The crop in its place in a picture that shows nothing else; valid until the next call.
  ImageView Unfold(const HeadView::Crop& crop, std::size_t eye);
  /// @p at_colors: at those of skin and hair too, not at brightness alone.
  void Look(const HeadView& view, bool at_colors);
  void LearnTexture();
  Agreement RefinePoses();
  void AddShape(const HeadView& view, Band band);
  void AddStereoShape(const HeadView& view);
  void AddOutline(const HeadView& view);
  double MoveSurface();
  /// Moves all views' poses alike, on a measured surface. @return how far [m]
  double MoveTexture();
  void RebuildModel();

  const RefinerConfig config_;
  const HeadGeometry start_;
  const Band compared_;
  HeadTable start_table_;
  WorkingPair pair_;
  std::array<ColorModel, 2> colors_;
  std::array<std::vector<std::uint8_t>, 2> unfolded_;
  std::array<ScoreMap, 2> scores_;
  std::array<BandImages, 2> bands_;
  StereoView view_;
  std::vector<HeadView> views_;
  ShapeEquations shape_;
  const ShapeEquations::Prior prior_;
  std::vector<float> displaced_;  // from start_table_, by vertex
  std::unique_ptr<Model> model_;
};

}  // namespace visavis
