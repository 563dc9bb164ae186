#pragma once

#include <cstdint>
#include <vector>

#include "services/recogniser/refined/equation_kernel.h"
#include "services/recogniser/refined/kernel_types.h"

namespace visavis {

/// The box of a ScoreMap that is filled: x0 <= column < x1.
struct ScoreView {
  const std::uint32_t* scores;  ///< PackedScores, row by row
  int stride;                   ///< [pixels]
  float x0, y0, x1, y1;
};

/// Points of a surface in the M frame [m] and which of the scores counts there, padded with points
/// that are turned away from every eye.
struct ScorePoints : SurfacePoints {
  std::vector<std::int32_t> shift;  ///< of the score's byte: 0 hair, 8 skin, 16 head

  /// @p n: zero for a point that is never turned away.
  void Add(const Eigen::Vector3f& p, const Eigen::Vector3f& n, float n_dot_p_m, int score_shift);
  void Pad();
};

/// Sum of scores clamped to +-kScoreLimit, and how many they are.
struct ScoreSum {
  std::int32_t sum{0}, count{0};
};
inline constexpr int kScoreLimit = 50;

/// Where the scores of a point are looked at: so far beyond it along its normal.
struct ScoreRings {
  int n;
  float beyond_m[2];
};

/// Adds up the scores at all rings of those points whose n.(p - p_ME) [m] lies between @p lowest
/// and 0, both excluded. Where nothing is known counts as 0. Exact integers.
ScoreSum SumScores(const KernelEye& eye, const ScoreView& map, const ScorePoints& points,
                   const ScoreRings& rings, float lowest);

/// Vertices as the silhouette's search takes them, padded as above. No edge at vertex i crosses the
/// silhouette where |n.(p - p_ME)| > reach[i] + reach_a_m[i] |p_ME|.
struct OutlineVertices {
  std::vector<float> normal_x, normal_y, normal_z, n_dot_p, reach, reach_a_m;
};

/// Writes n.(p - p_ME) [m] of all vertices to @p facing and the indices of those that the
/// silhouette may pass by, ascending, to @p near (room for all and kLanes more). @return how many.
int FindNearOutline(const KernelEye& eye, const OutlineVertices& vertices, float* facing,
                    std::int32_t* near);

/// Crossings of mesh edges with the silhouette: their ends a, b in M and n.(p - p_ME) there.
struct Crossings {
  static constexpr int kSize = 256;
  using Column = std::array<float, kSize>;

  int n{0};
  std::array<std::int32_t, kSize> a, b;  ///< vertices
  Column ax, ay, az, bx, by, bz, facing_a, facing_b;
  // Results: the place in M, its distance from the middle in the picture, squared, at focal length
  // 1, and the direction there, a share of the turn that begins at -x.
  Column x, y, z, distance;
  std::array<std::int32_t, kSize> bin;
};

/// Fills the results. @param middle the head's middle in the picture, focal length 1.
void PlaceCrossings(const KernelEye& eye, const float middle[2], int num_directions,
                    Crossings* crossings);

/// What turns to what along a contour's outward normal.
enum class Edge : std::int32_t { kHair, kSkin, kHairline };

/// Points of contours in M [m] with their outward normals.
struct ContourPoints {
  static constexpr int kSize = EquationRows::kSize;
  using Column = std::array<float, kSize>;

  int n{0};
  Column x, y, z, normal_x, normal_y, normal_z, weight;
  std::array<std::int32_t, kSize> edge;

  void Add(const Eigen::Vector3f& p, const Eigen::Vector3f& n, Edge kind, float point_weight);
  /// Fills the last block up with points of weight 0.
  void Pad();
};

/// exp(-kIndependence i / kScorePerNat) of every difference that sums of scores along a normal can
/// have.
std::vector<float> ContourLikelihoods();
inline constexpr int kMaxContourReach = 16;

/// For each point the place along its normal where inside turns to outside, as a row of the normal
/// equations (residual: its distance, px); all 0 where nothing can be told. @param reach_px how far
/// along the normals, at most kMaxContourReach.
void MeasureContours(const KernelEye& eye, const ScoreView& map, const ContourPoints& points,
                     int reach_px, const std::vector<float>& likelihoods, EquationRows* rows);

}  // namespace visavis
