#include "acquire/rig/detail/ray_scene.h"

#include <cstring>
#include <limits>
#include <utility>

#include <embree3/rtcore.h>

namespace striae::rig::detail {

struct RayScene::Embree {
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
  Embree() = default;
  Embree(const Embree&) = delete;
  Embree& operator=(const Embree&) = delete;
  ~Embree() {
    if (scene != nullptr) rtcReleaseScene(scene);
    if (device != nullptr) rtcReleaseDevice(device);
  }
};

namespace {

RTCRay MakeRay(const Eigen::Vector3d& from, const Eigen::Vector3d& along, float end) {
  RTCRay ray{};
  ray.org_x = static_cast<float>(from.x());
  ray.org_y = static_cast<float>(from.y());
  ray.org_z = static_cast<float>(from.z());
  ray.dir_x = static_cast<float>(along.x());
  ray.dir_y = static_cast<float>(along.y());
  ray.dir_z = static_cast<float>(along.z());
  ray.tfar = end;
  ray.mask = std::numeric_limits<unsigned>::max();
  return ray;
}

/// False when Embree cannot hold the mesh.
bool Fill(RTCDevice device, RTCScene scene, const TriangleMesh& mesh) {
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                               3 * sizeof(float), mesh.vertex.size()));
  auto* indices = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(std::uint32_t), mesh.triangle.size()));
  const bool filled = vertices != nullptr && indices != nullptr;
  if (filled) {
    for (const Eigen::Vector3d& v : mesh.vertex) {
      for (int i = 0; i < 3; ++i) *vertices++ = static_cast<float>(v[i]);
    }
    std::memcpy(indices, mesh.triangle.data(), mesh.triangle.size() * sizeof(mesh.triangle[0]));
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
  }
  rtcReleaseGeometry(geometry);
  return filled;
}

}  // namespace

RayScene::RayScene(std::shared_ptr<const Embree> embree) : embree_(std::move(embree)) {}

Result<RayScene> RayScene::Build(const TriangleMesh& mesh) {
  auto embree = std::make_shared<Embree>();
  // One thread builds the tree, so that the tree never depends on the machine.
  embree->device = rtcNewDevice("threads=1,set_affinity=0");
  if (embree->device == nullptr) return Fail(ErrorCode::kInternal, "Embree does not start on this processor");
  embree->scene = rtcNewScene(embree->device);
  rtcSetSceneFlags(embree->scene, RTC_SCENE_FLAG_ROBUST);  // no ray slips between neighbouring facets
  if (!Fill(embree->device, embree->scene, mesh)) {
    return Fail(ErrorCode::kInternal, "Embree has not enough memory for the mesh; use a coarser one");
  }
  rtcCommitScene(embree->scene);
  if (rtcGetDeviceError(embree->device) != RTC_ERROR_NONE) {
    return Fail(ErrorCode::kInternal, "Embree cannot build its tree for the mesh; use a coarser one");
  }
  return RayScene(std::move(embree));
}

std::optional<Hit> RayScene::First(const Eigen::Vector3d& from, const Eigen::Vector3d& direction) const {
  RTCRayHit ray{};
  ray.ray = MakeRay(from, direction, std::numeric_limits<float>::infinity());
  ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  rtcIntersect1(embree_->scene, &context, &ray);
  if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
  return Hit{ray.hit.primID, ray.hit.u, ray.hit.v, ray.ray.tfar};
}

bool RayScene::Sees(const Eigen::Vector3d& from, const Eigen::Vector3d& to) const {
  RTCRay ray = MakeRay(from, to - from, 1);
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  rtcOccluded1(embree_->scene, &context, &ray);
  return ray.tfar >= 0;
}

}  // namespace striae::rig::detail
