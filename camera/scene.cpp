#include "camera/scene.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "camera/mesh_facing.hpp"
#include "camera/ray_packets.hpp"

namespace kenaf::camera {

namespace {

using Eigen::Vector3d;

struct Release {
  void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
  void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
  void operator()(RTCGeometry geometry) const { rtcReleaseGeometry(geometry); }
};
template <typename Handle>
using Owned = std::unique_ptr<std::remove_pointer_t<Handle>, Release>;

constexpr float kInfinity = std::numeric_limits<float>::infinity();

// Compiled by GCC, Embree's kernels for AVX-512 take bits beyond a packet's 16 for rays, and never end (Embree's pull
// request 574). They are left out.
#if defined(__x86_64__)
constexpr char kDevice[] = "threads=1,start_threads=0,max_isa=avx2";
#else
constexpr char kDevice[] = "threads=1,start_threads=0";
#endif

Owned<RTCDevice> make_device() {
  Owned<RTCDevice> device(rtcNewDevice(kDevice));
  if (!device) throw std::runtime_error("camera: Embree finds no way to run on this processor");
  return device;
}

// A ray along an edge that two faces share, or two boxes side by side, meets one of them. Without the flag it may pass
// between them, by the processor and the version of Embree.
Owned<RTCScene> watertight_scene(RTCDevice device, RTCSceneFlags more = RTC_SCENE_FLAG_NONE) {
  Owned<RTCScene> scene(rtcNewScene(device));
  rtcSetSceneFlags(scene.get(), RTC_SCENE_FLAG_ROBUST | more);
  return scene;
}

void commit(RTCDevice device, RTCScene scene) {
  rtcCommitScene(scene);
  if (const RTCError error = rtcGetDeviceError(device); error != RTC_ERROR_NONE)
    throw std::runtime_error(error == RTC_ERROR_OUT_OF_MEMORY
                                 ? "camera: no memory for the scene's search tree; use a world of fewer triangles"
                                 : "camera: Embree refuses the scene, error " + std::to_string(error));
}

template <typename Vertices>
void attach_triangles(RTCDevice device, RTCScene scene, unsigned id, const Vertices& vertices,
                      const std::vector<std::array<std::uint32_t, 3>>& triangles) {
  if (triangles.empty()) return;
  const Owned<RTCGeometry> geometry(rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE));
  auto* p = static_cast<float*>(rtcSetNewGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                        3 * sizeof(float), vertices.size()));
  auto* index = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
      geometry.get(), RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(std::uint32_t), triangles.size()));
  if (!p || !index) throw std::bad_alloc();
  for (const auto& vertex : vertices)
    for (int axis = 0; axis < 3; ++axis) *p++ = static_cast<float>(vertex[axis]);
  for (const auto& triangle : triangles) index = std::copy(triangle.begin(), triangle.end(), index);
  rtcCommitGeometry(geometry.get());
  rtcAttachGeometryByID(scene, geometry.get(), id);
}

// A rigid body that moves, an instance in Embree.
struct Part {
  Surface surface;
  Owned<RTCScene> scene;
  Owned<RTCGeometry> instance;
  FaceId first_face = 0;
  physics::Pose X_WL;
  std::array<double, robot::kTrackCount> track_m{};
  Vector3d centre_L;
  double radius_m = 0;  // around centre_L
};

void bound(Part& part) {
  Eigen::AlignedBox3f box;
  for (const Eigen::Vector3f& p : part.surface.vertices) box.extend(p);
  part.centre_L = box.center().cast<double>();
  part.radius_m = box.diagonal().norm() / 2;
}

struct PlacedRobot {
  physics::RobotId id;
  std::shared_ptr<const physics::RobotDescription> description;
  FaceId first_face, end_face;
};

// A face in W. An affine f(p_L) = g . p_L + c becomes (R g) . p_W + c - (R g) . p_WL.
PlacedFace placed(const Face& face, const physics::Pose& X_WL, const Vector3d& toward_sun_W) {
  const auto moved = [&](const Affine& f) {
    const Vector3d gradient = X_WL.q * f.gradient;
    return Affine{gradient, f.offset - gradient.dot(X_WL.p)};
  };
  PlacedFace out{};
  out.normal_W = X_WL.q * face.normal;
  out.distance = face.distance + out.normal_W.dot(X_WL.p);
  out.s = moved(face.s);
  out.t = moved(face.t);
  out.facing.offset = std::max(0.0, out.normal_W.dot(toward_sun_W));
  out.material = face.material;
  out.half = face.half;
  return out;
}

bool same_pose(const physics::Pose& a, const physics::Pose& b) {
  return a.p == b.p && a.q.coeffs() == b.q.coeffs();
}

}  // namespace

void RayBatch::resize(std::size_t count) {
  for (auto* numbers : {&from_x, &from_y, &from_z, &along_x, &along_y, &along_z, &near, &far}) numbers->resize(count);
  face.resize(count);
}

struct Scene::Implementation {
  physics::WorldDescription world;  // planes and meshes only
  Owned<RTCDevice> device;
  std::vector<std::vector<std::array<float, 3>>> facing;  // of each mesh

  Owned<RTCScene> fixed;  // geometry 0: the boxes, then each mesh
  std::vector<BoxSnapshot> fixed_boxes;
  Surface fixed_surface;
  FaceId boxes_first_face = 0;
  std::vector<FaceId> mesh_first_face;

  Owned<RTCScene> moving;
  std::vector<physics::BoxId> loose_boxes;
  std::vector<Vector3d> loose_sizes;
  std::vector<PlacedRobot> robots;
  std::vector<Part> parts;  // loose boxes first
  FaceId fixed_face_count = 0, face_count = 0;
  std::vector<Sphere> bounds;

  void build_fixed() {
    // All fixed boxes are one geometry. Faces are numbered: planes, boxes, then mesh after mesh.
    fixed = watertight_scene(device.get());
    rtcSetSceneBuildQuality(fixed.get(), RTC_BUILD_QUALITY_MEDIUM);
    fixed_surface = {};
    for (const BoxSnapshot& box : fixed_boxes) add_box(fixed_surface, box.size_m, box.X_WBox, Material::fixed_box);
    attach_triangles(device.get(), fixed.get(), 0, fixed_surface.vertices, fixed_surface.triangles);
    boxes_first_face = static_cast<FaceId>(world.planes.size());
    FaceId next = boxes_first_face + static_cast<FaceId>(fixed_surface.faces.size());
    mesh_first_face.clear();

    // Each mesh is a geometry of its own, with a face for each triangle.
    for (const physics::TriangleMesh& mesh : world.meshes) {
      const auto id = static_cast<unsigned>(1 + mesh_first_face.size());
      attach_triangles(device.get(), fixed.get(), id, mesh.vertices_W, mesh.triangles);
      mesh_first_face.push_back(next);
      next += static_cast<FaceId>(mesh.triangles.size());
    }
    commit(device.get(), fixed.get());
    fixed_face_count = next;
  }

  void add_part(Surface surface) {
    Part part;
    part.scene = watertight_scene(device.get());
    attach_triangles(device.get(), part.scene.get(), 0, surface.vertices, surface.triangles);
    commit(device.get(), part.scene.get());
    part.instance.reset(rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_INSTANCE));
    rtcSetGeometryInstancedScene(part.instance.get(), part.scene.get());
    rtcSetGeometryTimeStepCount(part.instance.get(), 1);
    rtcAttachGeometryByID(moving.get(), part.instance.get(), static_cast<unsigned>(parts.size()));
    part.first_face = face_count;
    face_count += static_cast<FaceId>(surface.faces.size());
    part.surface = std::move(surface);
    bound(part);
    parts.push_back(std::move(part));
  }

  // Call after build_fixed(), whose faces are numbered first. Parts are in the order of the snapshot: loose boxes, then
  // each robot's body and arms.
  void build_moving(const WorldSnapshot& snapshot) {
    // An empty scene that is cheap to rebuild, as it is rebuilt for each picture.
    face_count = fixed_face_count;
    parts.clear();
    robots.clear();
    loose_boxes.clear();
    loose_sizes.clear();
    moving = watertight_scene(device.get(), RTC_SCENE_FLAG_DYNAMIC);
    rtcSetSceneBuildQuality(moving.get(), RTC_BUILD_QUALITY_LOW);

    // Loose boxes, remembered to see whether a later snapshot has the same.
    for (const BoxSnapshot& box : snapshot.boxes) {
      if (box.fixed) continue;
      loose_boxes.push_back(box.id);
      loose_sizes.push_back(box.size_m);
      Surface surface;
      add_box(surface, box.size_m, {}, Material::loose_box);
      add_part(std::move(surface));
    }

    // Robots, each with the range of its faces.
    for (const RobotSnapshot& robot : snapshot.robots) {
      PlacedRobot placed_robot{robot.id, robot.description, face_count, face_count};
      add_part(body_surface(*robot.description));
      for (std::size_t i = 0; i < robot::kFlipperCount; ++i)
        if (const auto which = static_cast<robot::Flipper>(i); robot.description->has(which))
          add_part(flipper_surface(*robot.description, which));
      placed_robot.end_face = face_count;
      robots.push_back(placed_robot);
    }
  }

  bool same_fixed(const WorldSnapshot& snapshot) const {
    std::size_t i = 0;
    for (const BoxSnapshot& box : snapshot.boxes) {
      if (!box.fixed) continue;
      if (i == fixed_boxes.size() || box.id != fixed_boxes[i].id || box.size_m != fixed_boxes[i].size_m ||
          !same_pose(box.X_WBox, fixed_boxes[i].X_WBox))
        return false;
      ++i;
    }
    return i == fixed_boxes.size();
  }

  bool same_moving(const WorldSnapshot& snapshot) const {
    std::size_t i = 0;
    for (const BoxSnapshot& box : snapshot.boxes) {
      if (box.fixed) continue;
      if (i == loose_boxes.size() || box.id != loose_boxes[i] || box.size_m != loose_sizes[i]) return false;
      ++i;
    }
    return i == loose_boxes.size() && std::ranges::equal(robots, snapshot.robots, [](const auto& a, const auto& b) {
             return a.id == b.id && a.description == b.description;
           });
  }

  static void place(Part& part, const physics::Pose& X_WL) {
    part.X_WL = X_WL;
    const Eigen::Matrix3f R = X_WL.q.toRotationMatrix().cast<float>();
    const Eigen::Vector3f p = X_WL.p.cast<float>();
    const std::array<float, 12> columns{R(0, 0), R(1, 0), R(2, 0), R(0, 1), R(1, 1), R(2, 1),
                                        R(0, 2), R(1, 2), R(2, 2), p.x(),   p.y(),   p.z()};
    rtcSetGeometryTransform(part.instance.get(), 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, columns.data());
    rtcCommitGeometry(part.instance.get());
  }

  void place_all(const WorldSnapshot& snapshot) {
    // Poses in the order of build_moving(); a robot's belts get the travel of its tracks.
    auto part = parts.begin();
    for (const BoxSnapshot& box : snapshot.boxes)
      if (!box.fixed) place(*part++, box.X_WBox);
    for (const RobotSnapshot& robot : snapshot.robots) {
      const auto first = part;
      place(*part++, robot.X_WB);
      for (std::size_t i = 0; i < robot::kFlipperCount; ++i)
        if (const auto which = static_cast<robot::Flipper>(i); robot.description->has(which))
          place(*part++, compose(robot.X_WB, flipper_pose(*robot.description, which, robot.flipper_rad[i])));
      for (auto own = first; own != part; ++own) own->track_m = robot.track_m;
    }
    commit(device.get(), moving.get());
    bounds.clear();
    for (const BoxSnapshot& box : fixed_boxes) bounds.push_back({box.X_WBox.p, box.size_m.norm() / 2});
    for (const Part& placed_part : parts)
      bounds.push_back({placed_part.X_WL.p + placed_part.X_WL.q * placed_part.centre_L, placed_part.radius_m});
  }

  // A triangle of a mesh: texture by x and y of W, and brightness interpolated between its corners. With e1, e2 from
  // corner 0 and A = e1 x e2, the gradient of a value f given at the corners is
  //   g = ((f1 - f0) e2 x A + (f2 - f0) A x e1) / |A|^2, so that g . e1 = f1 - f0 and g . e2 = f2 - f0.
  PlacedFace mesh_face(std::size_t mesh, std::size_t triangle) const {
    const physics::TriangleMesh& source = world.meshes[mesh];
    const auto& [a, b, c] = source.triangles[triangle];
    const Vector3d& p = source.vertices_W[a];
    const Vector3d e1 = source.vertices_W[b] - p, e2 = source.vertices_W[c] - p;
    const Vector3d area = e1.cross(e2);
    PlacedFace out{};
    out.material = Material::terrain;
    out.of_mesh = true;
    out.s = {Vector3d::UnitX(), 0};
    out.t = {Vector3d::UnitY(), 0};
    out.normal_W = area.norm() > 0 ? Vector3d(area.normalized()) : Vector3d::UnitZ();
    out.distance = out.normal_W.dot(p);
    const auto& f = facing[mesh][triangle];
    if (area.norm() > 0)
      out.facing.gradient = ((f[1] - f[0]) * e2.cross(area) + (f[2] - f[0]) * area.cross(e1)) / area.squaredNorm();
    out.facing.offset = f[0] - out.facing.gradient.dot(p);
    return out;
  }

  FaceId face_of_hit(const RTCHit16& hits, std::size_t i) const {
    if (hits.geomID[i] == RTC_INVALID_GEOMETRY_ID) return kNothing;
    if (hits.instID[0][i] != RTC_INVALID_GEOMETRY_ID) {
      const Part& part = parts[hits.instID[0][i]];
      return part.first_face + part.surface.face_of_triangle[hits.primID[i]];
    }
    if (hits.geomID[i] == 0) return boxes_first_face + fixed_surface.face_of_triangle[hits.primID[i]];
    return mesh_first_face[hits.geomID[i] - 1] + hits.primID[i];
  }
};

namespace {

// The rays from `first` on, up to 16. Returns how many.
std::size_t load_packet(const RayBatch& rays, std::size_t first, PacketMask& cast, RTCRay16& out) {
  const std::size_t count = std::min(kPacket, rays.size() - first);
  const auto load = [&](const std::vector<float>& from, float* to) { std::copy_n(from.data() + first, count, to); };
  load(rays.from_x, out.org_x);
  load(rays.from_y, out.org_y);
  load(rays.from_z, out.org_z);
  load(rays.along_x, out.dir_x);
  load(rays.along_y, out.dir_y);
  load(rays.along_z, out.dir_z);
  load(rays.near, out.tnear);
  load(rays.far, out.tfar);
  std::fill_n(out.time, kPacket, 0.0F);
  std::fill_n(out.mask, kPacket, ~0U);
  std::fill_n(out.flags, kPacket, 0U);
  for (std::size_t i = 0; i < kPacket; ++i) cast.of[i] = i < count ? -1 : 0;
  return count;
}

// A plane in single precision, for rays by the thousand: height above it, and its change along the ray.
struct FloatPlane {
  explicit FloatPlane(const physics::GroundPlane& plane)
      : normal((plane.X_WP.q * Vector3d::UnitZ()).cast<float>()),
        distance(static_cast<float>((plane.X_WP.q * Vector3d::UnitZ()).dot(plane.X_WP.p))) {}
  float height(const RayBatch& rays, std::size_t i) const {
    return normal.x() * rays.from_x[i] + normal.y() * rays.from_y[i] + normal.z() * rays.from_z[i] - distance;
  }
  float climb(const RayBatch& rays, std::size_t i) const {
    return normal.x() * rays.along_x[i] + normal.y() * rays.along_y[i] + normal.z() * rays.along_z[i];
  }
  Eigen::Vector3f normal;
  float distance;
};

}  // namespace

Scene::Scene(const physics::WorldDescription& world, const Vector3d& toward_sun_W)
    : toward_sun_W_(toward_sun_W.normalized()), impl_(std::make_unique<Implementation>()) {
  if (!toward_sun_W_.allFinite() || !(toward_sun_W_.z() > 0))
    throw std::invalid_argument("camera: the sun must be above the ground");
  impl_->world.planes = world.planes;
  impl_->world.meshes = world.meshes;
  impl_->device = make_device();
  for (const physics::TriangleMesh& mesh : world.meshes) impl_->facing.push_back(mesh_facing(mesh, toward_sun_W_));
  impl_->build_fixed();
  impl_->build_moving({});
  impl_->place_all({});
}

Scene::~Scene() = default;

void Scene::update(const WorldSnapshot& snapshot) {
  const bool same_fixed = impl_->same_fixed(snapshot);
  if (!same_fixed) {
    impl_->fixed_boxes.clear();
    std::ranges::copy_if(snapshot.boxes, std::back_inserter(impl_->fixed_boxes), &BoxSnapshot::fixed);
    impl_->build_fixed();
  }
  // Faces of moving parts are numbered after those of the fixed ones.
  if (!same_fixed || !impl_->same_moving(snapshot)) impl_->build_moving(snapshot);
  impl_->place_all(snapshot);
}

void Scene::cast(RayBatch& rays) const {
  // The second scene only replaces hits that are farther.
  PacketMask cast;
  RTCRayHit16 packet{};
  for (std::size_t first = 0; first < rays.size(); first += kPacket) {
    const std::size_t count = load_packet(rays, first, cast, packet.ray);
    std::ranges::fill(packet.hit.geomID, RTC_INVALID_GEOMETRY_ID);
    std::ranges::fill(packet.hit.instID[0], RTC_INVALID_GEOMETRY_ID);
    intersect(impl_->fixed.get(), cast, packet);
    if (!impl_->parts.empty()) intersect(impl_->moving.get(), cast, packet);
    std::copy_n(packet.ray.tfar, count, rays.far.data() + first);
    for (std::size_t i = 0; i < count; ++i) rays.face[first + i] = impl_->face_of_hit(packet.hit, i);
  }

  // The planes: n . (from + t along) = d at t = -height / climb.
  for (std::size_t p = 0; p < impl_->world.planes.size(); ++p) {
    const FloatPlane plane(impl_->world.planes[p]);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const float t = -plane.height(rays, i) / plane.climb(rays, i);
      if (!(t > rays.near[i] && t < rays.far[i])) continue;
      rays.far[i] = t;
      rays.face[i] = static_cast<FaceId>(p);
    }
  }
}

void Scene::cast_any(RayBatch& rays) const {
  // Planes first: a ray that comes down through one is marked as Embree marks occluded rays, with far = -infinity.
  for (const physics::GroundPlane& ground : impl_->world.planes) {
    const FloatPlane plane(ground);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const float height = plane.height(rays, i), climb = plane.climb(rays, i);
      if (climb < 0 && height > -climb * rays.near[i] && height < -climb * rays.far[i]) rays.far[i] = -kInfinity;
    }
  }
  PacketMask cast;
  RTCRay16 packet{};
  for (std::size_t first = 0; first < rays.size(); first += kPacket) {
    const std::size_t count = load_packet(rays, first, cast, packet);
    occlude(impl_->fixed.get(), cast, packet);
    if (!impl_->parts.empty()) occlude(impl_->moving.get(), cast, packet);
    for (std::size_t i = 0; i < count; ++i) rays.face[first + i] = packet.tfar[i] == -kInfinity ? 0 : kNothing;
  }
}

PlacedFace Scene::face(FaceId id) const {
  // In the order of numbers: planes, fixed boxes, ...
  const Implementation& s = *impl_;
  if (id < s.world.planes.size()) {
    const physics::Pose& X_WP = s.world.planes[id].X_WP;
    Face face{.normal = {0, 0, 1}, .distance = 0, .s = {}, .t = {}, .material = Material::ground};
    face.s.gradient = {1, 0, 0};
    face.t.gradient = {0, 1, 0};
    return placed(face, X_WP, toward_sun_W_);
  }
  const FaceId box_face = id - s.boxes_first_face;
  if (box_face < s.fixed_surface.faces.size()) return placed(s.fixed_surface.faces[box_face], {}, toward_sun_W_);

  // ... meshes, by the last one that begins at or before the number, ...
  if (id < s.fixed_face_count) {
    const auto after = std::upper_bound(s.mesh_first_face.begin(), s.mesh_first_face.end(), id);
    const auto mesh = static_cast<std::size_t>(after - s.mesh_first_face.begin()) - 1;
    return s.mesh_face(mesh, id - s.mesh_first_face[mesh]);
  }

  // ... and moving parts, likewise; a belt's texture moves with its track.
  const auto after = std::upper_bound(s.parts.begin(), s.parts.end(), id,
                                      [](FaceId face, const Part& part) { return face < part.first_face; });
  const Part& part = *(after - 1);
  Face face = part.surface.faces[id - part.first_face];
  face.s.offset += face.s_per_track_m * part.track_m[face.track];
  return placed(face, part.X_WL, toward_sun_W_);
}

std::size_t Scene::face_count() const {
  return impl_->face_count;
}

const std::vector<Sphere>& Scene::bounds() const {
  return impl_->bounds;
}

std::pair<FaceId, FaceId> Scene::faces_of(physics::RobotId robot) const {
  for (const PlacedRobot& placed_robot : impl_->robots)
    if (placed_robot.id == robot) return {placed_robot.first_face, placed_robot.end_face};
  return {0, 0};
}

}  // namespace kenaf::camera
