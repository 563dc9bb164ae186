#include "services/recogniser/refined/face_texture.h"

#include <algorithm>

namespace visavis {
namespace {

constexpr float kMinRate = 0.01f;  ///< the texture never freezes wholly
constexpr double kMinGain = 0.3, kMaxGain = 3;
constexpr int kFewest = 40;

}  // namespace

FaceTexture::FaceTexture(const FacePoints& face) : generic_(face), points_(face) {
  for (auto& k : known_) k.resize(face.size());
  for (auto& v : value_) v.resize(face.size());
  for (auto& w : weight_) w.resize(face.size());
}

void FaceTexture::Move(const RigidTransform& X_MN) {
  const Eigen::Matrix3f R = X_MN.linear().cast<float>();
  const Eigen::Vector3f p = X_MN.translation().cast<float>();
  for (Eigen::Vector3f& point : points_.points) point = R * point + p;
  for (Eigen::Vector3f& normal : points_.normals) normal = R * normal;
}

void FaceTexture::Forget() {
  learned_ = {};
  fixed_ = false;
  points_ = generic_;
  for (auto& w : weight_) w.assign(generic_.size(), 0.0f);
  for (auto& v : value_) v.assign(generic_.size(), 0.0f);
  for (auto& k : known_) k.assign(generic_.size(), 0);
}

void FaceTexture::Remember(const LearnedFace& face) {
  points_.points = face.points;
  points_.normals = face.normals;
  for (auto& pattern : points_.generic) pattern.clear();
  points_.has_generic.clear();
  value_ = face.value;
  for (auto& w : weight_) w.assign(face.points.size(), 1 / kMinRate);
  for (auto& k : known_) k.assign(face.points.size(), 1);
  learned_.fill(true);
  fixed_ = true;
}

LearnedFace FaceTexture::Learned() const {
  LearnedFace face;
  const auto is_known = [&](std::size_t i) {
    for (std::size_t band = 0; band < kNumBands; ++band) {
      if (learned_[band] && !known_[band][i]) return false;
    }
    return learned();
  };
  for (std::size_t i = 0; i < points_.size(); ++i) {
    if (!is_known(i)) continue;
    face.points.push_back(points_.points[i]);
    face.normals.push_back(points_.normals[i]);
    for (std::size_t band = 0; band < kNumBands; ++band)
      face.value[band].push_back(value_[band][i]);
  }
  return face;
}

void FaceTexture::Learn(Band band, const FaceSamples& samples) {
  float gain = 1, offset = 0;
  if (learned_[band]) {
    const GainOffset fit = FitPattern(samples, value_[band], known_[band]);
    if (fit.count < kFewest) return;
    gain = static_cast<float>(std::clamp(fit.gain, kMinGain, kMaxGain));
    offset = static_cast<float>(fit.offset);
  }
  for (std::size_t i = 0; i < points_.size(); ++i) {
    if (!samples.seen[i]) continue;
    float& weight = weight_[band][i];
    const float rate = std::max(kMinRate, 1 / (weight + 1));
    value_[band][i] += rate * ((samples.value[i] - offset) / gain - value_[band][i]);
    weight += 1;
    known_[band][i] = 1;
  }
  learned_[band] = true;
}

}  // namespace visavis
