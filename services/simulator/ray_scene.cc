#include "services/simulator/ray_scene.h"

#include <embree3/rtcore.h>

#include <cstring>
#include <stdexcept>
#include <string>

#include "common/core/check.h"

namespace visavis {
namespace {

constexpr int kPacket = 8;

}  // namespace

struct RayScene::Handles {
  // One build thread: the same tree, so the same picture, every time; no threads of its own.
  RTCDevice device{rtcNewDevice("threads=1,set_affinity=0")};
  RTCScene scene{nullptr};
  std::vector<RTCGeometry> geometries;
  std::vector<std::size_t> sizes;

  Handles() {
    if (device == nullptr) {
      throw std::runtime_error("Embree: no device, error " +
                               std::to_string(rtcGetDeviceError(nullptr)));
    }
    scene = rtcNewScene(device);
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
  }
  Handles(const Handles&) = delete;
  Handles& operator=(const Handles&) = delete;
  ~Handles() {
    for (const RTCGeometry geometry : geometries) rtcReleaseGeometry(geometry);
    rtcReleaseScene(scene);
    rtcReleaseDevice(device);
  }
};

RayScene::RayScene() : handles_(std::make_unique<Handles>()) {}
RayScene::~RayScene() = default;
RayScene::RayScene(RayScene&&) noexcept = default;
RayScene& RayScene::operator=(RayScene&&) noexcept = default;

void RayScene::Add(const std::vector<Eigen::Vector3f>& vertices,
                   const std::vector<std::array<std::uint32_t, 3>>& triangles) {
  const RTCGeometry geometry = rtcNewGeometry(handles_->device, RTC_GEOMETRY_TYPE_TRIANGLE);
  void* positions = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                            3 * sizeof(float), vertices.size());
  std::memcpy(positions, vertices.data(), vertices.size() * 3 * sizeof(float));
  void* indices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                          3 * sizeof(std::uint32_t), triangles.size());
  std::memcpy(indices, triangles.data(), triangles.size() * 3 * sizeof(std::uint32_t));
  rtcCommitGeometry(geometry);
  rtcAttachGeometryByID(handles_->scene, geometry,
                        static_cast<unsigned>(handles_->geometries.size()));
  handles_->geometries.push_back(geometry);
  handles_->sizes.push_back(vertices.size());
}

void RayScene::SetVertices(int index, const std::vector<Eigen::Vector3f>& vertices) {
  const auto i = static_cast<std::size_t>(index);
  VISAVIS_THROW_UNLESS(i < handles_->geometries.size(), index);
  VISAVIS_THROW_UNLESS(vertices.size() == handles_->sizes[i], vertices.size());
  const RTCGeometry geometry = handles_->geometries[i];
  std::memcpy(rtcGetGeometryBufferData(geometry, RTC_BUFFER_TYPE_VERTEX, 0), vertices.data(),
              vertices.size() * 3 * sizeof(float));
  rtcUpdateGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0);
  rtcCommitGeometry(geometry);
}

void RayScene::Commit() { rtcCommitScene(handles_->scene); }

void RayScene::Intersect(const Eigen::Vector3f& origin, RayBatch* batch) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  RTCRayHit8 rays;
  alignas(32) int valid[kPacket];
  for (int begin = 0; begin < batch->size; begin += kPacket) {
    for (int k = 0; k < kPacket; ++k) {
      const auto i = static_cast<std::size_t>(begin + k);
      valid[k] = begin + k < batch->size ? -1 : 0;
      rays.ray.org_x[k] = origin.x();
      rays.ray.org_y[k] = origin.y();
      rays.ray.org_z[k] = origin.z();
      rays.ray.dir_x[k] = batch->dx[i];
      rays.ray.dir_y[k] = batch->dy[i];
      rays.ray.dir_z[k] = batch->dz[i];
      rays.ray.tnear[k] = 0;
      rays.ray.tfar[k] = batch->t[i];
      rays.ray.time[k] = 0;
      rays.ray.mask[k] = ~0u;
      rays.ray.id[k] = 0;
      rays.ray.flags[k] = 0;
      rays.hit.geomID[k] = RTC_INVALID_GEOMETRY_ID;
      rays.hit.instID[0][k] = RTC_INVALID_GEOMETRY_ID;
    }
    rtcIntersect8(valid, handles_->scene, &context, &rays);
    for (int k = 0; k < kPacket && begin + k < batch->size; ++k) {
      const auto i = static_cast<std::size_t>(begin + k);
      batch->hit[i] = rays.hit.geomID[k] != RTC_INVALID_GEOMETRY_ID;
      if (!batch->hit[i]) continue;
      batch->t[i] = rays.ray.tfar[k];
      batch->u[i] = rays.hit.u[k];
      batch->v[i] = rays.hit.v[k];
      batch->mesh[i] = rays.hit.geomID[k];
      batch->triangle[i] = rays.hit.primID[k];
    }
  }
}

void RayScene::Occlude(const Eigen::Vector3f& origin,
                       const std::array<Eigen::Vector3f, kFan>& directions, float far_m,
                       unsigned* open) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  RTCRay8 rays;
  alignas(32) int valid[kFan];
  for (unsigned k = 0; k < kFan; ++k) {
    valid[k] = (*open >> k & 1) != 0 ? -1 : 0;
    rays.org_x[k] = origin.x();
    rays.org_y[k] = origin.y();
    rays.org_z[k] = origin.z();
    rays.dir_x[k] = directions[k].x();
    rays.dir_y[k] = directions[k].y();
    rays.dir_z[k] = directions[k].z();
    rays.tnear[k] = 0;
    rays.tfar[k] = far_m;
    rays.time[k] = 0;
    rays.mask[k] = ~0u;
    rays.id[k] = 0;
    rays.flags[k] = 0;
  }
  rtcOccluded8(valid, handles_->scene, &context, &rays);
  for (unsigned k = 0; k < kFan; ++k) {
    if (valid[k] != 0 && rays.tfar[k] < 0) *open &= ~(1u << k);
  }
}

}  // namespace visavis
