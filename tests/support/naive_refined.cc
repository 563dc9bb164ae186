#include "tests/support/naive_refined.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "tests/support/naive_bands.h"

namespace visavis {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

/// One eye before a head.
struct Camera {
  Camera(const EyeView& eye, const RigidTransform& X_CM)
      : fx(static_cast<double>(eye.geometry->fx)),
        fy(static_cast<double>(eye.geometry->fy)),
        cx(static_cast<double>(eye.geometry->cx)),
        cy(static_cast<double>(eye.geometry->cy)),
        R_EC(eye.geometry->R_EC.cast<double>()),
        R_EM(R_EC * X_CM.linear()),
        p_EM(R_EC * X_CM.translation() + eye.geometry->p_EC.cast<double>()),
        p_ME(-R_EM.transpose() * p_EM) {}
  Vector3d InEye(const Vector3d& p_M) const { return R_EM * p_M + p_EM; }
  Vector2d Pixel(const Vector3d& p_M) const {
    const Vector3d p = InEye(p_M);
    return {cx + fx * p.x() / p.z(), cy + fy * p.y() / p.z()};
  }
  /// Change of the pixel along @p gradient with the point's place in C.
  Vector3d SlopeInC(const Vector3d& p_E, const Vector2d& gradient) const {
    const double iz = 1 / p_E.z();
    const double u = gradient.x() * fx * iz, v = gradient.y() * fy * iz;
    return R_EC.transpose() * Vector3d(u, v, -(u * p_E.x() + v * p_E.y()) * iz);
  }
  double fx, fy, cx, cy;
  Matrix3d R_EC, R_EM;
  Vector3d p_EM, p_ME;
};

/// n.(p - p_ME): negative where turned to the eye.
double Facing(const Camera& camera, const Vector3d& p, const Vector3d& n) {
  return n.dot(p - camera.p_ME);
}

int Clamped(int score, int limit) { return std::clamp(score, -limit, limit); }

PackedScores ScoresAt(const EyeView& eye, const Vector2d& uv) {
  return eye.scores->At(static_cast<float>(uv.x()), static_cast<float>(uv.y()));
}

void AddTo(PoseEquations* equations, const Vector3d& slope, const Vector3d& arm, double residual,
           double weight) {
  Vector6d J;
  J << slope, arm.cross(slope);
  equations->H += weight * J * J.transpose();
  equations->g += weight * residual * J;
}

struct Sums {
  double n{0}, x{0}, y{0}, xx{0}, xy{0}, yy{0};
  void Add(double a, double b) {
    n += 1;
    x += a;
    y += b;
    xx += a * a;
    xy += a * b;
    yy += b * b;
  }
  double var_x() const { return xx - x * x / n; }
  double var_y() const { return yy - y * y / n; }
  double cov() const { return xy - x * y / n; }
};

}  // namespace

NaiveMeshFitness::NaiveMeshFitness(const HeadMesh& mesh, const FacePoints& face, int detail) {
  int inside = 0, outline = 0, pattern = 0;
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const Point point{mesh.vertices[i].cast<double>(), mesh.normals[i].cast<double>(), 0,
                      mesh.parts[i] == HeadPart::kHair};
    if (mesh.coloured[i] && inside++ % (2 * detail) == 0) inside_.push_back(point);
    if (mesh.contour_weights[i] > 0 && outline++ % detail == 0) outline_.push_back(point);
  }
  for (std::size_t i = 0; i < face.size(); ++i) {
    if (!face.has_generic[i] || pattern++ % (2 * detail) != 0) continue;
    pattern_.push_back({face.points[i].cast<double>(), face.normals[i].cast<double>(),
                        static_cast<double>(face.generic[kCoarseBand][i]), false});
  }
  num_points_ = static_cast<int>(inside_.size() + 2 * outline_.size() + pattern_.size());
}

MeshScore NaiveMeshFitness::Evaluate(const StereoView& view, const RigidTransform& X_CM) const {
  MeshScore score;
  for (const EyeView& eye : view) {
    score.inside += 0.5 * Inside(eye, X_CM);
    score.outside += 0.5 * Outside(eye, X_CM);
    score.ncc += 0.5 * Correlation(eye, X_CM);
  }
  score.has_ncc = true;
  return score;
}

double NaiveMeshFitness::Inside(const EyeView& eye, const RigidTransform& X_CM) const {
  const Camera camera(eye, X_CM);
  double sum = 0, count = 0;
  for (const Point& point : inside_) {
    if (Facing(camera, point.p, point.n) >= 0) continue;
    const PackedScores s = ScoresAt(eye, camera.Pixel(point.p));
    sum += Clamped(point.hair ? HairScore(s) : SkinScore(s), 50);
    count += 1;
  }
  return sum / (40 * std::max(count, 1.0));
}

double NaiveMeshFitness::Outside(const EyeView& eye, const RigidTransform& X_CM) const {
  const Camera camera(eye, X_CM);
  double sum = 0, count = 0;
  for (const Point& point : outline_) {
    const double facing = Facing(camera, point.p, point.n);
    if (facing >= 0 || facing <= -0.22 * camera.p_ME.norm()) continue;
    for (const double beyond : {0.010, 0.022}) {
      sum += Clamped(HeadScore(ScoresAt(eye, camera.Pixel(point.p + beyond * point.n))), 50);
      count += 1;
    }
  }
  return sum / (40 * std::max(count, 1.0));
}

double NaiveMeshFitness::Correlation(const EyeView& eye, const RigidTransform& X_CM) const {
  const Camera camera(eye, X_CM);
  Sums sums;
  for (const Point& point : pattern_) {
    if (Facing(camera, point.p, point.n) > -0.2 * camera.p_ME.norm()) continue;
    const Vector2d uv = camera.Pixel(point.p);
    float value;
    if (NearestSample(eye.bands->view(kCoarseBand), uv.x(), uv.y(), &value))
      sums.Add(point.value, static_cast<double>(value));
  }
  if (sums.n < 20) return 0;
  return sums.cov() / std::sqrt(sums.var_x() * sums.var_y() + 1e-6);
}

struct NaiveRefiner::Samples {
  explicit Samples(std::size_t n) : value(n), facing(n), slope(n), seen(n) {}
  std::vector<double> value, facing;
  std::vector<Vector3d> slope;
  std::vector<bool> seen;
};

NaiveRefiner::Samples NaiveRefiner::SampleFace(const EyeView& eye,
                                               const RigidTransform& X_CM) const {
  const Camera camera(eye, X_CM);
  Samples samples(face_.size());
  for (std::size_t i = 0; i < face_.size(); ++i) {
    const Vector3d p_M = face_.points[i].cast<double>(), view = p_M - camera.p_ME;
    const double facing = -face_.normals[i].cast<double>().dot(view.normalized());
    const Vector2d uv = camera.Pixel(p_M);
    BandSample band;
    if (facing < 0.6 || !SampleBand(eye.bands->view(kFineBand), uv.x(), uv.y(), &band)) continue;
    samples.value[i] = static_cast<double>(band.value);
    samples.facing[i] = facing;
    samples.slope[i] =
        camera.SlopeInC(camera.InEye(p_M), Eigen::Vector2f(band.du, band.dv).cast<double>());
    samples.seen[i] = true;
  }
  return samples;
}

// What the looks a add to the sum of squares is minimised over a, and the pose's equations are what
// remains: rows of 6 + 12 unknowns, the last 12 eliminated.
void NaiveRefiner::AddLooks(const std::array<Samples, 2>& samples, const RigidTransform& X_CM,
                            PoseEquations* equations) const {
  constexpr int kModes = kLooksModes;
  constexpr double kIndependence = 0.12;
  using Looks = Eigen::Matrix<double, kModes, 1>;
  const auto modes = [&](std::size_t i) {
    Looks m;
    for (int k = 0; k < kModes; ++k)
      m[k] = static_cast<double>(face_.modes[i][static_cast<std::size_t>(k)]);
    return m;
  };
  const auto mean = [&](std::size_t i) { return static_cast<double>(face_.generic[kFineBand][i]); };
  const auto weight = [&](std::size_t i) {
    return 1 / (std::pow(static_cast<double>(face_.doubt[i]), 2) + 0.04);
  };
  struct Light {
    double count, gain, offset;
  };
  const auto light = [&](const Samples& eye, const Looks& a) {
    double n = 0, w = 0, x = 0, y = 0;
    for (std::size_t i = 0; i < face_.size(); ++i) {
      if (!eye.seen[i] || !face_.has_generic[i]) continue;
      n += 1;
      w += weight(i);
      x += weight(i) * (mean(i) + modes(i).dot(a));
      y += weight(i) * eye.value[i];
    }
    x /= w;
    y /= w;
    double var_x = 0, var_y = 0, cov = 0;
    for (std::size_t i = 0; i < face_.size(); ++i) {
      if (!eye.seen[i] || !face_.has_generic[i]) continue;
      const double dx = mean(i) + modes(i).dot(a) - x, dy = eye.value[i] - y;
      var_x += weight(i) * dx * dx;
      var_y += weight(i) * dy * dy;
      cov += weight(i) * dx * dy;
    }
    const double gain = std::max(cov / var_x, 0.4 * std::sqrt((var_y + 0.0025 * w) / var_x));
    return Light{n, gain, y - gain * x};
  };
  Looks a = Looks::Zero();
  for (int round = 0; round < 2; ++round) {
    Eigen::Matrix<double, kModes, kModes> H = Eigen::Matrix<double, kModes, kModes>::Identity();
    Looks g = Looks::Zero();
    for (const Samples& eye : samples) {
      const Light l = light(eye, a);
      if (l.count < 40) continue;
      for (std::size_t i = 0; i < face_.size(); ++i) {
        if (!eye.seen[i] || !face_.has_generic[i]) continue;
        const Looks m = modes(i);
        H += kIndependence * weight(i) * m * m.transpose();
        g += kIndependence * weight(i) * ((eye.value[i] - l.offset) / l.gain - mean(i)) * m;
      }
    }
    a = H.fullPivLu().solve(g);
  }
  using All = Eigen::Matrix<double, 6 + kModes, 1>;
  Eigen::Matrix<double, 6 + kModes, 6 + kModes> H = All::Zero().asDiagonal();
  H.bottomRightCorner<kModes, kModes>().setIdentity();
  All g = All::Zero();
  g.tail<kModes>() = -a;
  for (const Samples& eye : samples) {
    const Light l = light(eye, a);
    if (l.count < 40) continue;
    for (std::size_t i = 0; i < face_.size(); ++i) {
      if (!eye.seen[i] || !face_.has_generic[i]) continue;
      const double residual = l.gain * (mean(i) + modes(i).dot(a)) + l.offset - eye.value[i];
      const double variance = l.gain * l.gain / weight(i) + 0.25;
      All row;
      row << eye.slope[i], (X_CM.linear() * face_.points[i].cast<double>()).cross(eye.slope[i]),
          -l.gain * modes(i);
      const double w =
          config_.pattern_weight * kIndependence / (variance + 0.25 * residual * residual);
      H += w * row * row.transpose();
      g += w * residual * row;
    }
  }
  const auto eliminated = H.bottomRightCorner<kModes, kModes>().fullPivLu();
  const Eigen::Matrix<double, 6, kModes> H_pa = H.topRightCorner<6, kModes>();
  const Matrix6d H_pose = H.topLeftCorner<6, 6>() - H_pa * eliminated.solve(H_pa.transpose());
  equations->H += H_pose;
  equations->g += g.head<6>() - H_pa * eliminated.solve(g.tail<kModes>());
}

void NaiveRefiner::AddStereo(const Samples& right, const Samples& left, const RigidTransform& X_CM,
                             PoseEquations* equations) const {
  const auto counts = [&](std::size_t i) {
    return right.seen[i] && left.seen[i] && right.facing[i] >= 0.7 && left.facing[i] >= 0.7;
  };
  Sums m;
  for (std::size_t i = 0; i < face_.size(); ++i) {
    if (counts(i)) m.Add(left.value[i], right.value[i]);
  }
  if (m.n < 40) return;
  const double ratio = std::sqrt(m.var_y() / m.var_x()), offset = (m.y - ratio * m.x) / m.n;
  const double sigma = 0.35 * std::sqrt(m.var_y() / m.n) + 0.5;
  for (std::size_t i = 0; i < face_.size(); ++i) {
    if (!counts(i)) continue;
    const double residual = ratio * left.value[i] + offset - right.value[i];
    const double robust = 1 + residual * residual / (4 * sigma * sigma);
    AddTo(equations, right.slope[i] - ratio * left.slope[i],
          X_CM.linear() * face_.points[i].cast<double>(), residual,
          2 * config_.stereo_weight / (sigma * sigma * robust));
  }
}

void NaiveRefiner::AddContours(const EyeView& eye, const RigidTransform& X_CM, int reach,
                               PoseEquations* equations) const {
  const Camera camera(eye, X_CM);
  struct Contour {
    double distance{-1};
    Vector3d p, n;
    double weight{0};
    int edge{0};  // hair, skin, hairline
  };
  std::array<Contour, 96> silhouette;
  const Vector3d middle = camera.InEye({0, 0.008, 0});
  for (const auto& [ia, ib] : mesh_.edges) {
    const auto a = static_cast<std::size_t>(ia), b = static_cast<std::size_t>(ib);
    const Vector3d p_a = mesh_.vertices[a].cast<double>(), n_a = mesh_.normals[a].cast<double>();
    const Vector3d p_b = mesh_.vertices[b].cast<double>(), n_b = mesh_.normals[b].cast<double>();
    const double f_a = Facing(camera, p_a, n_a), f_b = Facing(camera, p_b, n_b);
    if ((f_a < 0) == (f_b < 0)) continue;
    const double t = f_a / (f_a - f_b);
    const Vector3d p = (1 - t) * p_a + t * p_b, q = camera.InEye(p);
    const Vector2d from_middle = q.head<2>() / q.z() - middle.head<2>() / middle.z();
    const double turn = std::atan2(from_middle.y(), from_middle.x()) / (2 * M_PI) + 0.5;
    Contour& kept = silhouette[static_cast<std::size_t>(std::min(95, static_cast<int>(96 * turn)))];
    if (from_middle.squaredNorm() <= kept.distance) continue;
    const bool hair_a = mesh_.parts[a] == HeadPart::kHair,
               hair_b = mesh_.parts[b] == HeadPart::kHair;
    const float weight = mesh_.contour_weights[a] * mesh_.contour_weights[b];
    kept = {from_middle.squaredNorm(), p, (1 - t) * n_a + t * n_b,
            hair_a == hair_b ? config_.outline_weight * static_cast<double>(weight) : 0,
            hair_a ? 0 : 1};
  }
  std::vector<Contour> contours(silhouette.begin(), silhouette.end());
  for (std::size_t i = 0; i < hairline_.points.size(); ++i) {
    const Vector3d p = hairline_.points[i].cast<double>(), view = p - camera.p_ME;
    if (p.dot(view) > -0.35 * p.norm() * view.norm()) continue;
    contours.push_back({1, p, -hairline_.into_hair[i].cast<double>(),
                        config_.hairline_weight * config_.outline_weight, 2});
  }
  for (const Contour& c : contours) {
    if (c.distance < 0 || c.weight <= 0) continue;
    const Vector3d p = camera.InEye(c.p), n = camera.R_EM * c.n;
    Vector2d normal(camera.fx * (n.x() - p.x() / p.z() * n.z()),
                    camera.fy * (n.y() - p.y() / p.z() * n.z()));
    normal.normalize();
    std::vector<double> sums;
    double sum = 0;
    bool known = true;
    for (int k = -reach; k <= reach; ++k) {
      const PackedScores s = ScoresAt(eye, camera.Pixel(c.p) + k * normal);
      known = known && IsKnown(s);
      const int score = c.edge == 0   ? HairScore(s)
                        : c.edge == 1 ? SkinScore(s)
                                      : HairScore(s) - SkinScore(s);
      sum += 0.48 / 20 * Clamped(score, 40);
      sums.push_back(sum);
    }
    sums.pop_back();
    const double best = *std::max_element(sums.begin(), sums.end());
    double total = 0, first = 0, second = 0;
    for (std::size_t k = 0; k < sums.size(); ++k) {
      const double probability = std::exp(sums[k] - best);
      const double at = static_cast<double>(k) - reach + 0.5;
      total += probability;
      first += probability * at;
      second += probability * at * at;
    }
    const double mean = first / total, variance = second / total - mean * mean;
    if (!known || variance > 0.28 * reach * reach) continue;
    AddTo(equations, camera.SlopeInC(p, normal), X_CM.linear() * c.p, mean,
          c.weight / (variance + 0.5) / (1 + mean * mean / 9));
  }
}

PoseEquations NaiveRefiner::Generic(const StereoView& view, const RigidTransform& X_CM) const {
  PoseEquations equations;
  for (const EyeView& eye : view) AddContours(eye, X_CM, 6, &equations);
  const Samples right = SampleFace(view[0], X_CM), left = SampleFace(view[1], X_CM);
  AddLooks({right, left}, X_CM, &equations);
  AddStereo(right, left, X_CM, &equations);
  Matrix6d R = Matrix6d::Zero();
  R.topLeftCorner<3, 3>() = R.bottomRightCorner<3, 3>() = X_CM.linear();
  PoseEquations in_head;
  in_head.H = R.transpose() * equations.H * R;
  in_head.g = R.transpose() * equations.g;
  return in_head;
}

}  // namespace visavis
