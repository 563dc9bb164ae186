#pragma once

#include <array>
#include <vector>

#include "services/recogniser/refined/face_points.h"
#include "services/recogniser/refined/pose_equations.h"
#include "services/recogniser/refined/stereo_view.h"

namespace visavis {

/// A band of one eye's picture at every face point under one pose.
struct FaceSamples {
  explicit FaceSamples(std::size_t size) : value(size), facing(size), slope(size), seen(size) {}

  /// Room for at least @p size points.
  void Hold(std::size_t size) {
    if (value.size() >= size) return;
    value.resize(size);
    facing.resize(size);
    slope.resize(size);
    seen.resize(size);
  }

  std::vector<float> value, facing;    ///< facing: cosine, 1 where turned straight to the eye
  std::vector<Eigen::Vector3f> slope;  ///< change of value with the point's place in C [1/m]
  std::vector<unsigned char> seen;     ///< in the picture and turned to the eye
};

/// Samples @p band where the face is turned to the eye by a cosine of at least @p min_facing.
void SampleFace(const FacePoints& face, const EyeView& eye, const EyePose& pose, Band band,
                float min_facing, FaceSamples* samples);

/// value = gain * pattern + offset over the points seen, and how well that explains them.
struct GainOffset {
  int count{0};
  double gain{0}, offset{0};
  double pattern_rms{0};
  double correlation{0};  ///< normalised cross-correlation, -1 to 1
};
/// @p usable: points that the pattern speaks of.
GainOffset FitPattern(const FaceSamples& samples, const std::vector<float>& pattern,
                      const std::vector<unsigned char>& usable);

/// The pattern should be seen where the pose puts it, up to gain and offset. @p relative_sigma:
/// expected deviation, in units of the pattern's own contrast. @return the fit before the step.
GainOffset AddPattern(const FacePoints& face, const FaceSamples& samples,
                      const Eigen::Matrix3f& R_CM, const std::vector<float>& pattern,
                      const std::vector<unsigned char>& usable, float relative_sigma, float weight,
                      PoseEquations* equations);

/// How far both eyes see the same, -1 to 1, up to gain and offset; 0 where they see too little.
double StereoCorrelation(const FaceSamples& right, const FaceSamples& left, std::size_t size);

/// right = gain * left + offset over the points that both eyes see well; the gain from the
/// contrasts, which noise raises alike on both sides. pattern_rms is the right eye's contrast.
GainOffset FitEyes(const FaceSamples& right, const FaceSamples& left, std::size_t size);

/// Both eyes should see the same at a point of the surface, up to gain and offset;
/// @p relative_sigma: expected difference, in units of the face's own contrast. Points turned far
/// aside do not pull: what is behind the head blurs into them.
void AddStereo(const FacePoints& face, const FaceSamples& right, const FaceSamples& left,
               const Eigen::Matrix3f& R_CM, float relative_sigma, float weight,
               PoseEquations* equations);

}  // namespace visavis
