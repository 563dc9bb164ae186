#include "services/recogniser/frame_preparer.h"

namespace visavis {
namespace {

// The undistorted picture keeps size and intrinsics; where its pixel lies in the camera's picture.
std::optional<ImageRemap> MakeUndistort(const Pinhole& camera) {
  if (!camera.has_distortion()) return std::nullopt;
  return ImageRemap(camera.width, camera.height, [&](int x, int y) {
    const Projection source =
        Project(camera, {(x - camera.cx) / camera.fx, (y - camera.cy) / camera.fy, 1});
    return ImageRemap::Source{source.uv.x(), source.uv.y()};
  });
}

}  // namespace

FramePreparer::FramePreparer(const StereoRig& rig) {
  right_.undistort = MakeUndistort(rig.right);
  left_.undistort = MakeUndistort(rig.left);
}

ImageView FramePreparer::Prepare(const ImageView& image, Side* side) {
  const ImageView decoded = side->decoder.Decode(image);
  return side->undistort ? side->undistort->Apply(decoded) : decoded;
}

StereoFrame FramePreparer::Prepare(const StereoImages& images) {
  StereoFrame frame;
  frame.utime_us = images.utime_us;
  if (images.right) frame.right = Prepare(*images.right, &right_);
  if (images.left) frame.left = Prepare(*images.left, &left_);
  return frame;
}

}  // namespace visavis
