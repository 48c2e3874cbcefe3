#include "physics/world_description.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <sstream>

#include "formats/description/description_file.hpp"
#include "physics/files/sdf_assembly.hpp"
#include "physics/files/sdf_document.hpp"
#include "physics/files/sdf_element.hpp"
#include "physics/files/sdf_frames.hpp"
#include "physics/files/sdf_notes.hpp"
#include "physics/files/sdf_surface.hpp"
#include "physics/files/sdf_values.hpp"
#include "physics/files/world_files.hpp"

namespace kenaf::physics {
namespace {

constexpr double kMaxFriction = 10, kMaxGravity_mps2 = 1000;
// The limit of the indices of Bullet's tree of a mesh; a world of that size takes some hundreds of MB.
constexpr std::size_t kMostTriangles = std::size_t{1} << 21U;

struct Reader {
  SdfNotes& notes;
  const SdfFrames& frames;
  ShapeFiles files;
  WorldDescription world{};
  std::size_t triangles_left = kMostTriangles;
};

double friction_of(Reader& reader, const SdfElement& collision) {
  const SdfElement* element = &collision;
  for (const char* name : {"surface", "friction", "ode"}) {
    element = child_of(*element, name);
    if (!element) return 1.0;
  }
  const double mu = number_in(*element, "mu", 1);
  const SdfElement* said = child_of(*element, "mu");
  if (!(mu >= 0)) fail_at(*said, "<mu> must not be below 0");
  if (mu > kMaxFriction)
    reader.notes.add(place_of(*said), fmt::format("<mu> of {} is simulated as {}, the most", mu, kMaxFriction));
  return std::min(mu, kMaxFriction);
}

// A plane has its normal as z axis.
GroundPlane read_plane(const SdfElement& plane, const Pose& X_WC, double friction) {
  const Eigen::Vector3d normal = vector3_in(plane, "normal", {0, 0, 1});
  if (!normal.allFinite() || normal.norm() < 1e-9) fail_at(plane, "<normal> must not be zero");
  Pose X_WP = X_WC;
  X_WP.q = X_WC.q * Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), normal);
  return {X_WP, friction};
}

Eigen::Vector3d size_of(const SdfElement& box) {
  const Eigen::Vector3d size_m = vector3_in(box, "size", {1, 1, 1});
  if (!(size_m.array() > 0).all() || !(size_m.array() <= SdfFrames::kMaxCoordinate_m).all())
    fail_at(box, fmt::format("<size> of a box must be more than 0 and at most {} m", SdfFrames::kMaxCoordinate_m));
  return size_m;
}

// The shape of a collision, or null if it has none that is simulated.
const SdfElement* shape_of(Reader& reader, const SdfElement& collision, bool is_fixed) {
  const SdfElement* geometry = child_of(collision, "geometry");
  if (!geometry || geometry->children.empty()) return nullptr;
  const SdfElement& shape = geometry->children.front();
  const auto is_polyline = [](const SdfElement& each) { return each.name == "polyline"; };
  if (geometry->children.size() > 1 && std::ranges::all_of(geometry->children, is_polyline)) {
    reader.notes.add(place_of(shape),
                     "several <polyline> in a <geometry> are not simulated: the <collision> is left out");
    return nullptr;
  }
  if (geometry->children.size() > 1) fail_at(geometry->children[1], "a <geometry> must hold one shape");
  if (!is_fixed && shape.name != "box") {
    reader.notes.add(place_of(shape),
                     fmt::format("a <{}> of a model that is not <static> is not simulated", shape.name));
    return nullptr;
  }
  return &shape;
}

// `mass_kg` is 0 for a static model.
void read_collision(Reader& reader, const SdfElement& collision, const Pose& X_WLink, const std::string& name,
                    double mass_kg) {
  const Pose X_WC = compose(X_WLink, reader.frames.pose_in_scope(collision));
  const double friction = friction_of(reader, collision);
  const SdfElement* shape = shape_of(reader, collision, mass_kg == 0);
  if (!shape) return;

  // A plane stays a plane, a box a box; everything else becomes triangles in W.
  if (shape->name == "plane") return reader.world.planes.push_back(read_plane(*shape, X_WC, friction));
  if (shape->name == "box") return reader.world.boxes.push_back({name, size_of(*shape), X_WC, friction, mass_kg});
  TriangleSurface surface = read_surface(reader.notes, *shape, reader.files, reader.triangles_left);
  reader.triangles_left -= surface.triangles.size();
  for (Eigen::Vector3d& p : surface.vertices) p = X_WC.p + X_WC.q * p;
  reader.world.meshes.push_back({name, std::move(surface.vertices), std::move(surface.triangles), friction});
}

// The mass of a link whose only shape is a box: as given, or with auto (SDF 1.11) by its density.
double mass_kg_of(const SdfElement& link, const SdfElement& collision) {
  constexpr double kOtherwise_kg = 1, kOtherwise_kgpm3 = 1000;  // SDF's defaults
  const SdfElement* inertial = child_of(link, "inertial");
  const SdfElement* geometry = child_of(collision, "geometry");
  const SdfElement* box = geometry ? child_of(*geometry, "box") : nullptr;
  double mass_kg = inertial ? number_in(*inertial, "mass", kOtherwise_kg) : kOtherwise_kg;
  if (box && inertial && !child_of(*inertial, "mass") && truth_attribute_of(*inertial, "auto", false)) {
    const double of_link_kgpm3 = number_in(*inertial, "density", kOtherwise_kgpm3);
    mass_kg = number_in(collision, "density", of_link_kgpm3) * size_of(*box).prod();
  }
  if (!(mass_kg > 0 && mass_kg < 1e6)) fail_at(link, "<mass> must be more than 0 and below 1e6 kg");
  return mass_kg;
}

std::vector<const SdfElement*> children_of(const SdfElement& element, std::string_view name) {
  std::vector<const SdfElement*> found;
  for (const SdfElement& child : element.children)
    if (child.name == name) found.push_back(&child);
  return found;
}

// `X_WParent` is the pose of the outer model; models within a static one are static too.
void read_model(Reader& reader, const SdfElement& model, const Pose& X_WParent, const std::string& prefix,
                bool within_static) {
  const Pose X_WM = compose(X_WParent, reader.frames.pose_in_scope(model));
  const std::string name = prefix + std::string(attribute_of(model, "name"));
  const std::vector<const SdfElement*> links = children_of(model, "link"), models = children_of(model, "model");

  // A model that moves must be one body with one shape; one without a body has no effect.
  const bool is_fixed = truth_in(model, "static", false) || within_static || (links.empty() && models.empty());
  const bool one_body = links.size() == 1 && models.empty() && children_of(*links[0], "collision").size() == 1;
  if (!is_fixed && !one_body)
    return reader.notes.add(
        place_of(model),
        fmt::format("model \"{}\" is not <static> and more than one body with one <collision>: it is left out", name));

  // Links with their collisions, then inner models. A static model has no mass.
  for (const SdfElement* link : links) {
    const Pose X_WL = compose(X_WM, reader.frames.pose_in_scope(*link));
    for (const SdfElement* collision : children_of(*link, "collision")) {
      const std::string of_collision =
          fmt::format("{}/{}/{}", name, attribute_of(*link, "name"), attribute_of(*collision, "name"));
      read_collision(reader, *collision, X_WL, one_body ? name : of_collision,
                     is_fixed ? 0 : mass_kg_of(*link, *collision));
    }
  }
  for (const SdfElement* inner : models) read_model(reader, *inner, X_WM, name + "/", is_fixed);
}

WorldDescription read_world(Reader& reader, const SdfElement& world) {
  reader.world.name = attribute_of(world, "name");
  reader.world.gravity_W_mps2 = vector3_in(world, "gravity", {0, 0, -9.8});
  if (!(reader.world.gravity_W_mps2.norm() <= kMaxGravity_mps2))
    fail_at(*child_of(world, "gravity"), fmt::format("<gravity> must be at most {} m/s2", kMaxGravity_mps2));

  for (const SdfElement* model : children_of(world, "model")) read_model(reader, *model, {}, "", false);
  for (const SdfElement* frame : children_of(world, "frame"))
    if (const std::string_view name = attribute_of(*frame, "name"); name.starts_with("start"))
      reader.world.start_poses.push_back({std::string(name), reader.frames.pose_in_scope(*frame)});
  if (reader.world.start_poses.empty()) reader.world.start_poses.push_back({"PlayerStart_0", {}});
  return std::move(reader.world);
}

}  // namespace

std::vector<std::filesystem::path> world_search_path() {
  std::vector<std::filesystem::path> folders;
  const char* set = std::getenv("KENAF_WORLD_PATH");
  std::stringstream names(set ? set : "");
  for (std::string name; std::getline(names, name, ':');)
    if (!name.empty()) folders.emplace_back(name);
  return folders;
}

WorldDescription parse_world(std::string_view sdf_text, const std::string& name_for_errors,
                             const std::filesystem::path& folder, std::vector<std::string>& unsupported,
                             const std::vector<std::filesystem::path>& search) {
  SdfNotes notes(unsupported);
  WorldFiles files(name_for_errors, folder, search);
  const SdfElement document = SdfAssembly(files, notes).assemble(sdf_world(sdf_text, name_for_errors, notes));
  const SdfFrames frames(document);
  Reader reader{notes, frames, {files}};
  WorldDescription world = read_world(reader, document);
  notes.finish();
  return world;
}

WorldDescription load_world(const std::string& name_or_path, std::vector<std::string>& unsupported) {
  const description::DescriptionFile file = description::read_description_file("world", name_or_path, ".sdf");
  const std::filesystem::path folder = std::filesystem::path(file.path).parent_path();
  return parse_world(file.text, file.path, folder.empty() ? "." : folder, unsupported, world_search_path());
}

}  // namespace kenaf::physics
