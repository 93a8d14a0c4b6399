// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
// Ray casting by Embree 3. Scenes are built by one thread, so that the trees and with them the choice between equal
// hits do not depend on the number of threads. (A device of one thread would hold the whole process to one thread.)
#include "loopmark/simulation/world.hpp"

#include <embree3/rtcore.h>
#include <tbb/global_control.h>

#include <array>
#include <stdexcept>

#include "loopmark/core/random.hpp"
#include "vehicles.hpp"

namespace loopmark::simulation {
namespace {

struct DeviceDeleter {
  void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
};
struct SceneDeleter {
  void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
};
using DevicePointer = std::unique_ptr<RTCDeviceTy, DeviceDeleter>;
using ScenePointer = std::unique_ptr<RTCSceneTy, SceneDeleter>;

DevicePointer make_device() {
  DevicePointer device(rtcNewDevice("set_affinity=0"));
  if (!device) {
    throw std::runtime_error("Embree cannot start: error " + std::to_string(rtcGetDeviceError(nullptr)));
  }
  return device;
}

ScenePointer make_scene(RTCDevice device, const Mesh& mesh) {
  ScenePointer scene(rtcNewScene(device));
  rtcSetSceneFlags(scene.get(), static_cast<RTCSceneFlags>(RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_COMPACT));
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                               3 * sizeof(float), mesh.vertices.size()));
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      vertices[3 * i + static_cast<std::size_t>(axis)] = mesh.vertices[i][axis];
    }
  }
  auto* corners = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(std::uint32_t), mesh.triangles.size()));
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    std::copy(mesh.triangles[i].begin(), mesh.triangles[i].end(), corners + 3 * i);
  }
  rtcCommitGeometry(geometry);
  rtcAttachGeometryByID(scene.get(), geometry, 0);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(scene.get());
  if (rtcGetDeviceError(device) != RTC_ERROR_NONE) {
    throw std::runtime_error("Embree cannot build the scene");
  }
  return scene;
}

RTCRayHit to_embree(const Ray& ray) {
  RTCRayHit query{};
  query.ray.org_x = ray.origin.x();
  query.ray.org_y = ray.origin.y();
  query.ray.org_z = ray.origin.z();
  query.ray.dir_x = ray.direction.x();
  query.ray.dir_y = ray.direction.y();
  query.ray.dir_z = ray.direction.z();
  query.ray.tfar = ray.range_m;
  query.ray.time = ray.moment;
  query.ray.mask = 0xffffffffU;
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  return query;
}

std::array<float, 12> column_major(const Pose& pose) {
  std::array<float, 12> values{};
  for (int column = 0; column < 4; ++column) {
    for (int row = 0; row < 3; ++row) {
      values[static_cast<std::size_t>(3 * column + row)] = static_cast<float>(pose.matrix()(row, column));
    }
  }
  return values;
}

void add_parked_cars(Mesh& mesh, const Town& town, int day) {
  for (std::size_t i = 0; i < town.parking.size(); ++i) {
    Rng rng(task_seed(town.options.seed, {20, static_cast<std::uint64_t>(day), i}));
    if (rng.uniform() >= town.parking[i].chance) {
      continue;
    }
    const auto kind = static_cast<internal::VehicleKind>(rng.below(4));
    Pose place = town.parking[i].T_world_car;
    place = place * pose_from_yaw(rng.uniform(-0.03, 0.03), {rng.uniform(-0.3, 0.3), rng.uniform(-0.12, 0.12), 0.0});
    append(mesh, internal::make_vehicle(kind, static_cast<std::uint8_t>(rng.below(256))), place);
  }
}

}  // namespace

ShapeList make_shapes() {
  ShapeList list;
  for (int kind = 0; kind < static_cast<int>(internal::VehicleKind::kCount); ++kind) {
    list.meshes.push_back(internal::make_vehicle(static_cast<internal::VehicleKind>(kind), 128));
    list.sizes.push_back(internal::vehicle_size(static_cast<internal::VehicleKind>(kind)));
  }
  list.vehicles = list.meshes.size();
  for (const double stride : {0.2, 0.6, 1.0}) {
    for (const double height : {1.2, 1.65, 1.85}) {
      list.meshes.push_back(internal::make_pedestrian(height, stride));
      list.sizes.emplace_back(0.6, 0.6);
    }
  }
  return list;
}

struct World::Impl {
  DevicePointer device = make_device();
  std::vector<Surface> surfaces;
  ScenePointer scene;
  ShapeList shapes = make_shapes();
  std::vector<ScenePointer> shape_scenes;

  explicit Impl(const Mesh& mesh) : surfaces(mesh.surfaces) {
    const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
    scene = make_scene(device.get(), mesh);
    for (const Mesh& shape : shapes.meshes) {
      shape_scenes.push_back(make_scene(device.get(), shape));
    }
  }
};

class World::Moving {
 public:
  ScenePointer scene;
  std::vector<MovingBody> bodies;
};

World::World(const Town& town, int day) : day_(day) {
  Mesh mesh = town.mesh;
  add_parked_cars(mesh, town, day);
  impl_ = std::make_unique<Impl>(mesh);
}

World::World(const Mesh& mesh) : impl_(std::make_unique<Impl>(mesh)) {}
World::~World() = default;
World::World(World&&) noexcept = default;
World& World::operator=(World&&) noexcept = default;

const ShapeList& World::shapes() const { return impl_->shapes; }
std::size_t World::triangles() const { return impl_->surfaces.size(); }

std::shared_ptr<const World::Moving> World::place(const std::vector<MovingBody>& bodies) const {
  if (bodies.empty()) {
    return nullptr;
  }
  auto moving = std::make_shared<Moving>();
  moving->bodies = bodies;
  moving->scene.reset(rtcNewScene(impl_->device.get()));
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    RTCGeometry instance = rtcNewGeometry(impl_->device.get(), RTC_GEOMETRY_TYPE_INSTANCE);
    rtcSetGeometryInstancedScene(instance, impl_->shape_scenes.at(bodies[i].shape).get());
    rtcSetGeometryTimeStepCount(instance, 2);
    const auto start = column_major(bodies[i].T_world_body_start);
    const auto end = column_major(bodies[i].T_world_body_end);
    rtcSetGeometryTransform(instance, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, start.data());
    rtcSetGeometryTransform(instance, 1, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, end.data());
    rtcCommitGeometry(instance);
    rtcAttachGeometryByID(moving->scene.get(), instance, static_cast<unsigned>(i));
    rtcReleaseGeometry(instance);
  }
  rtcCommitScene(moving->scene.get());
  return moving;
}

void World::cast(std::vector<Ray>& rays, const Moving* moving) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  for (Ray& ray : rays) {
    RTCRayHit query = to_embree(ray);
    rtcIntersect1(impl_->scene.get(), &context, &query);
    ray.hit = query.hit.geomID != RTC_INVALID_GEOMETRY_ID;
    if (ray.hit) {
      ray.normal = Eigen::Vector3f(query.hit.Ng_x, query.hit.Ng_y, query.hit.Ng_z).normalized();
      ray.surface = impl_->surfaces[query.hit.primID];
    }
    if (moving != nullptr) {
      query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
      rtcIntersect1(moving->scene.get(), &context, &query);
      if (query.hit.geomID != RTC_INVALID_GEOMETRY_ID) {
        const MovingBody& body = moving->bodies[query.hit.instID[0]];
        const Eigen::Vector3f normal(query.hit.Ng_x, query.hit.Ng_y, query.hit.Ng_z);
        ray.hit = true;
        ray.normal = (body.T_world_body_start.linear().cast<float>() * normal).normalized();
        ray.surface = impl_->shapes.meshes[body.shape].surfaces[query.hit.primID];
      }
    }
    ray.range_m = query.ray.tfar;
  }
}

}  // namespace loopmark::simulation
