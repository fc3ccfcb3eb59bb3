// SPDX-License-Identifier: BSD-3-Clause
#include "sensing/ray_caster.h"

#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <stdexcept>
#include <string>

#include "scene/layers.h"
#include "sensing/embree.h"
#include "sensing/embree_solids.h"
#include "sensing/hashed_random.h"

namespace curtain {
namespace {

constexpr int kLanes = 8;       // rays of a packet
constexpr int kPacketWide = 4;  // two rows of four: neighbours in both directions meet the same boxes

// Embree hands the context on to the filter, which finds behind it what it needs.
struct Context {
  EmbreeContext embree;  // first
  std::uint64_t pore_key;
  const double* porosity;  // by triangle of the cloth
};

// Whether a hit of the cloth counts: a ray's number and the triangle decide.
void passPores(const RTCFilterFunctionNArguments* args) {
  const auto& context = *reinterpret_cast<const Context*>(args->context);
  for (unsigned int i = 0; i < args->N; ++i) {
    if (args->valid[i] == 0) continue;
    const std::uint64_t ray = RTCRayN_id(args->ray, args->N, i);
    const std::uint64_t triangle = RTCHitN_primID(args->hit, args->N, i);
    if (hashedUniform(context.pore_key, ray << 32U | triangle) < context.porosity[triangle]) args->valid[i] = 0;
  }
}

void throwOnError(RTCDevice device) {
  constexpr std::array<const char*, 7> kWords = {"",
                                                 "unknown error",
                                                 "invalid argument",
                                                 "invalid operation",
                                                 "out of memory",
                                                 "this processor is not supported",
                                                 "cancelled"};
  const RTCError error = rtcGetDeviceError(device);
  if (error != RTC_ERROR_NONE) throw std::runtime_error(std::string("Embree: ") + kWords.at(error));
}

template <typename Points>
void copyPoints(const Points& points, float* to) {
  for (const Vec3& point : points) {
    for (int axis = 0; axis < 3; ++axis) *to++ = static_cast<float>(point[axis]);
  }
}

template <typename Triangles>
RTCGeometry newTriangles(RTCDevice device, std::size_t points, const Triangles& triangles, float*& positions) {
  const RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  positions = static_cast<float*>(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), points));
  auto* const corners = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(std::uint32_t), triangles.size()));
  throwOnError(device);
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) corners[3 * i + k] = static_cast<std::uint32_t>(triangles[i][k]);
  }
  return geometry;
}

// The last number stands for all obstacles that have none of their own.
std::uint16_t labelOf(std::size_t obstacle) {
  constexpr std::size_t kLast = std::numeric_limits<std::uint16_t>::max();
  return static_cast<std::uint16_t>(std::min(obstacle + RayHit::kFirstObstacle, kLast));
}

// Embree's worker threads take no part: there are other simulators, and cores that have better to do.
void commitAlone(RTCScene scene) {
  tbb::task_arena alone(1, 1);
  alone.execute([scene] { rtcCommitScene(scene); });
}

}  // namespace

struct RayCaster::Impl {
  struct MeshObstacle {
    std::size_t obstacle;
    RTCScene scene;
    RTCGeometry instance;
    unsigned int id;  // of the instance
  };

  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
  RTCGeometry cloth = nullptr, solid_geometry = nullptr;
  unsigned int cloth_id = 0;
  float* positions = nullptr;  // of the cloth, in Embree's buffer
  std::vector<PlacedSolid> solids;
  std::vector<std::size_t> solid_obstacles;  // their numbers
  std::vector<MeshObstacle> meshes;
  std::vector<Eigen::Matrix3f> turns;  // by the instance's id: from its frame, which Embree's normals are in
  std::vector<std::uint16_t> labels;   // by the instance's id

  std::vector<std::uint16_t> cloth_labels;  // by triangle of the cloth
  std::vector<double> porosity;             // the same

  Impl(const Simulator& simulator, std::optional<double> porosity);
  ~Impl();
  void addCloth(const Simulator& simulator, std::optional<double> of_all);
  void addMesh(std::size_t obstacle, const ShapeTriangles& shape);
  void castPacket(const RayGrid& rays, int column, int row, const RayRange& range, Context& context,
                  std::vector<RayHit>& hits) const;
};

RayCaster::Impl::Impl(const Simulator& simulator, std::optional<double> of_all) {
  device = rtcNewDevice(nullptr);
  if (device == nullptr) throw std::runtime_error("Embree can't be started on this machine");
  scene = rtcNewScene(device);
  // Robust: no ray slips through between two triangles. Dynamic: as fast to build as to look through once.
  rtcSetSceneFlags(scene, static_cast<RTCSceneFlags>(RTC_SCENE_FLAG_DYNAMIC | RTC_SCENE_FLAG_ROBUST));
  addCloth(simulator, of_all);
  const std::vector<ObstacleParams>& obstacles = simulator.scene().obstacles;
  for (std::size_t i = 0; i < obstacles.size(); ++i) {
    const ObstacleShape& shape = simulator.obstacleShape(static_cast<int>(i));
    if (obstacles[i].shape == ShapeKind::kMesh) {
      addMesh(i, shape.triangles());
      continue;
    }
    solids.emplace_back(obstacles[i], shape.bounds());
    solid_obstacles.push_back(i);
  }
  if (!solids.empty()) {
    solid_geometry = makeSolidGeometry(device, solids);
    rtcAttachGeometry(scene, solid_geometry);
  }
  throwOnError(device);
}

RayCaster::Impl::~Impl() {
  for (const MeshObstacle& mesh : meshes) {
    rtcReleaseGeometry(mesh.instance);
    rtcReleaseScene(mesh.scene);
  }
  if (solid_geometry != nullptr) rtcReleaseGeometry(solid_geometry);
  if (cloth != nullptr) rtcReleaseGeometry(cloth);
  if (scene != nullptr) rtcReleaseScene(scene);
  if (device != nullptr) rtcReleaseDevice(device);
}

void RayCaster::Impl::addCloth(const Simulator& simulator, std::optional<double> of_all) {
  const FineMeshTopology& topology = simulator.fineMeshTopology();
  const Scene& given = simulator.scene();
  const Layers layers(given);
  for (const auto& triangle : topology.triangles) {
    // Its corner on the left; of closed cloth any, which has no layers.
    const std::uint32_t left =
        *std::min_element(triangle.begin(), triangle.end(), [&](std::uint32_t a, std::uint32_t b) {
          return a % static_cast<std::uint32_t>(topology.columns) < b % static_cast<std::uint32_t>(topology.columns);
        });
    const int row = static_cast<int>(left) / topology.columns;
    const int column = static_cast<int>(left) % topology.columns / topology.folds;
    const std::size_t layer = layers.numberOf(column);
    cloth_labels.push_back(layer == 0 ? RayHit::kCloth : labelOf(given.obstacles.size() + layer - 1));
    porosity.push_back(of_all.value_or(layers.fabricAt(row, column).porosity));
  }
  const auto points = static_cast<std::size_t>(topology.rows) * static_cast<std::size_t>(topology.columns);
  cloth = newTriangles(device, points, topology.triangles, positions);
  rtcSetGeometryBuildQuality(cloth, RTC_BUILD_QUALITY_MEDIUM);
  const bool any_pores = *std::max_element(porosity.begin(), porosity.end()) > 0.0;
  if (any_pores) rtcSetGeometryIntersectFilterFunction(cloth, passPores);
  cloth_id = rtcAttachGeometry(scene, cloth);
}

void RayCaster::Impl::addMesh(std::size_t obstacle, const ShapeTriangles& shape) {
  const RTCScene own = rtcNewScene(device);
  rtcSetSceneFlags(own, RTC_SCENE_FLAG_ROBUST);
  float* corners = nullptr;
  const RTCGeometry triangles = newTriangles(device, shape.corners.size(), shape.triangles, corners);
  copyPoints(shape.corners, corners);
  rtcCommitGeometry(triangles);
  rtcAttachGeometry(own, triangles);
  rtcReleaseGeometry(triangles);  // the scene keeps it
  commitAlone(own);
  const RTCGeometry instance = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_INSTANCE);
  rtcSetGeometryInstancedScene(instance, own);
  const unsigned int id = rtcAttachGeometry(scene, instance);
  meshes.push_back({obstacle, own, instance, id});
  turns.resize(id + 1U, Eigen::Matrix3f::Identity());
  labels.resize(id + 1U, RayHit::kBackground);
  labels[id] = labelOf(obstacle);
}

bool RayCaster::available() { return true; }

RayCaster::RayCaster(const Simulator& simulator, std::optional<double> porosity)
    : impl_(std::make_unique<Impl>(simulator, porosity)) {}
RayCaster::~RayCaster() = default;

void RayCaster::place(const Moment& moment, const Pose& sensor) {
  Impl& im = *impl_;
  Eigen::Isometry3d world = Eigen::Isometry3d::Identity();  // in the sensor's frame
  world.linear() = sensor.orientation.conjugate().toRotationMatrix();
  world.translation() = -(world.linear() * sensor.position);
  float* to = im.positions;
  for (const Vec3& position : moment.mesh.positions) {
    const Vec3 seen = world * position;
    for (int axis = 0; axis < 3; ++axis) *to++ = static_cast<float>(seen[axis]);
  }
  rtcUpdateGeometryBuffer(im.cloth, RTC_BUFFER_TYPE_VERTEX, 0);
  rtcCommitGeometry(im.cloth);
  const auto poseOf = [&](std::size_t obstacle) {
    const Pose& pose = moment.obstacles[obstacle];
    return world * Eigen::Isometry3d(Eigen::Translation3d(pose.position) * pose.orientation);
  };
  for (std::size_t i = 0; i < im.solids.size(); ++i) {
    const std::size_t obstacle = im.solid_obstacles[i];
    im.solids[i].place(moment.present[obstacle] != 0, poseOf(obstacle));
  }
  if (im.solid_geometry != nullptr) rtcCommitGeometry(im.solid_geometry);
  for (const Impl::MeshObstacle& mesh : im.meshes) {
    moment.present[mesh.obstacle] != 0 ? rtcEnableGeometry(mesh.instance) : rtcDisableGeometry(mesh.instance);
    const Eigen::Matrix4f pose = poseOf(mesh.obstacle).matrix().cast<float>();
    rtcSetGeometryTransform(mesh.instance, 0, RTC_FORMAT_FLOAT4X4_COLUMN_MAJOR, pose.data());
    im.turns[mesh.id] = pose.topLeftCorner<3, 3>();
    rtcCommitGeometry(mesh.instance);
  }
  commitAlone(im.scene);
  throwOnError(im.device);
}

void RayCaster::cast(const RayGrid& rays, const RayRange& range, std::uint64_t pore_key,
                     std::vector<RayHit>& hits) const {
  const Impl& im = *impl_;
  hits.resize(rays.size());
  Context context;
  initCoherent(context.embree);
  context.pore_key = pore_key;
  context.porosity = im.porosity.data();
  for (int row = 0; row < rays.height; row += kLanes / kPacketWide) {
    for (int column = 0; column < rays.width; column += kPacketWide)
      im.castPacket(rays, column, row, range, context, hits);
  }
}

void RayCaster::Impl::castPacket(const RayGrid& rays, int column, int row, const RayRange& range, Context& context,
                                 std::vector<RayHit>& hits) const {
  alignas(32) std::array<int, kLanes> valid;
  alignas(32) RTCRayHit8 packet;
  const auto place = [&](int lane) {
    return static_cast<std::size_t>(row + lane / kPacketWide) * static_cast<std::size_t>(rays.width) +
           static_cast<std::size_t>(column + lane % kPacketWide);
  };
  for (int lane = 0; lane < kLanes; ++lane) {
    const bool inside = row + lane / kPacketWide < rays.height && column + lane % kPacketWide < rays.width;
    valid[static_cast<std::size_t>(lane)] = inside ? -1 : 0;
    const std::size_t ray = inside ? place(lane) : 0;
    packet.ray.org_x[lane] = packet.ray.org_y[lane] = packet.ray.org_z[lane] = 0.0F;
    packet.ray.dir_x[lane] = rays.x[ray];
    packet.ray.dir_y[lane] = rays.y[ray];
    packet.ray.dir_z[lane] = rays.z[ray];
    packet.ray.tnear[lane] = range.nearest;
    packet.ray.tfar[lane] = range.farthest;
    packet.ray.time[lane] = 0.0F;
    packet.ray.mask[lane] = ~0U;
    packet.ray.id[lane] = static_cast<unsigned int>(ray);
    packet.ray.flags[lane] = 0;
    packet.hit.geomID[lane] = packet.hit.instID[0][lane] = RTC_INVALID_GEOMETRY_ID;
  }
  intersectCoherent(valid.data(), scene, context.embree, packet);
  for (int lane = 0; lane < kLanes; ++lane) {
    if (valid[static_cast<std::size_t>(lane)] == 0) continue;
    RayHit& hit = hits[place(lane)];
    const unsigned int geometry = packet.hit.geomID[lane], instance = packet.hit.instID[0][lane];
    hit.triangle = RayHit::kNothing;
    hit.label = RayHit::kBackground;
    if (geometry == RTC_INVALID_GEOMETRY_ID) continue;
    const bool of_cloth = instance == RTC_INVALID_GEOMETRY_ID && geometry == cloth_id;
    hit.triangle = of_cloth ? static_cast<std::int32_t>(packet.hit.primID[lane]) : RayHit::kObstacle;
    hit.distance = packet.ray.tfar[lane];
    hit.b1 = packet.hit.u[lane];
    hit.b2 = packet.hit.v[lane];
    hit.normal = {packet.hit.Ng_x[lane], packet.hit.Ng_y[lane], packet.hit.Ng_z[lane]};
    if (instance != RTC_INVALID_GEOMETRY_ID) hit.normal = turns[instance] * hit.normal;
    hit.label = of_cloth                              ? cloth_labels[packet.hit.primID[lane]]
                : instance != RTC_INVALID_GEOMETRY_ID ? labels[instance]
                                                      : labelOf(solid_obstacles[packet.hit.primID[lane]]);
  }
}

}  // namespace curtain
