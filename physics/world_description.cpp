#include "physics/world_description.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <sdf/sdf.hh>
#include <sstream>

#include "formats/description/description_file.hpp"
#include "physics/files/sdf_assembly.hpp"
#include "physics/files/sdf_elements.hpp"
#include "physics/files/sdf_notes.hpp"
#include "physics/files/sdf_outline.hpp"
#include "physics/files/sdf_surface.hpp"
#include "physics/files/world_files.hpp"

namespace kenaf::physics {
namespace {

constexpr double kMaxFriction = 10, kMaxGravity_mps2 = 1000;
// The limit of the indices of Bullet's tree of a mesh; a world of that size takes some hundreds of MB.
constexpr std::size_t kMostTriangles = std::size_t{1} << 21U;

struct Reader {
  SdfNotes& notes;
  ShapeFiles files;
  WorldDescription world{};
  std::size_t triangles_left = kMostTriangles;
};

// `relative_to` empty: relative to the element's parent.
Pose resolved_pose(const sdf::SemanticPose& semantic, const sdf::ElementPtr& element, const std::string& relative_to) {
  ignition::math::Pose3d pose;
  const sdf::Errors errors = semantic.Resolve(pose, relative_to);
  if (!errors.empty()) fail_at(element, message_of(errors.front()));
  if (!pose.IsFinite() || pose.Pos().Length() > kMaxCoordinate_m)
    fail_at(element, fmt::format("a pose is not a number or further than {} m away", kMaxCoordinate_m));
  return {{pose.Pos().X(), pose.Pos().Y(), pose.Pos().Z()},
          Eigen::Quaterniond(pose.Rot().W(), pose.Rot().X(), pose.Rot().Y(), pose.Rot().Z()).normalized()};
}

double friction_of(Reader& reader, const sdf::Collision& collision) {
  sdf::ElementPtr element = collision.Element();
  for (const char* name : {"surface", "friction", "ode", "mu"}) {
    if (!element->HasElement(name)) return 1.0;
    element = element->GetElement(name);
  }
  const double mu = element->Get<double>();
  if (!(mu >= 0)) fail_at(element, "<mu> must not be below 0");
  if (mu > kMaxFriction)
    reader.notes.add(place_of(element), fmt::format("<mu> of {} is simulated as {}, the most", mu, kMaxFriction));
  return std::min(mu, kMaxFriction);
}

// `mass_kg` is 0 for a static model.
void read_collision(Reader& reader, const sdf::Collision& collision, const Pose& X_WLink, const std::string& name,
                    double mass_kg) {
  // One shape in each collision; of models that move only boxes are simulated.
  SdfNotes& notes = reader.notes;
  const Pose X_WC = compose(X_WLink, resolved_pose(collision.SemanticPose(), collision.Element(), ""));
  const sdf::Geometry& geometry = *collision.Geom();
  const double friction = friction_of(reader, collision);
  const sdf::ElementPtr shape = geometry.Element() ? geometry.Element()->GetFirstElement() : nullptr;
  if (!shape) return;
  if (shape->GetNextElement("polyline") && shape->GetName() == "polyline")
    return notes.add(place_of(shape),
                     "several <polyline> in a <geometry> are not simulated: the <collision> is left out");
  if (shape->GetNextElement()) fail_at(shape->GetNextElement(), "a <geometry> must hold one shape");
  if (mass_kg > 0 && !geometry.BoxShape())
    return notes.add(place_of(shape),
                     fmt::format("a <{}> of a model that is not <static> is not simulated", shape->GetName()));

  // A plane gets its normal as z axis, a box stays a box, everything else becomes triangles in W.
  if (const sdf::Plane* plane = geometry.PlaneShape()) {
    const auto n = plane->Normal();
    const Eigen::Vector3d normal(n.X(), n.Y(), n.Z());
    if (!normal.allFinite() || normal.norm() < 1e-9) fail_at(shape, "<normal> must not be zero");
    Pose X_WP = X_WC;
    X_WP.q = X_WC.q * Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), normal);
    reader.world.planes.push_back({X_WP, friction});
  } else if (const sdf::Box* box = geometry.BoxShape()) {
    const Eigen::Vector3d size(box->Size().X(), box->Size().Y(), box->Size().Z());
    if (!(size.minCoeff() > 0) || !(size.maxCoeff() <= kMaxCoordinate_m))
      fail_at(shape, fmt::format("<size> of a box must be more than 0 and at most {} m", kMaxCoordinate_m));
    reader.world.boxes.push_back({name, size, X_WC, friction, mass_kg});
  } else {
    TriangleSurface surface = read_surface(notes, geometry, reader.files, reader.triangles_left);
    if (surface.triangles.empty()) return;
    reader.triangles_left -= surface.triangles.size();
    for (Eigen::Vector3d& p : surface.vertices) p = X_WC.p + X_WC.q * p;
    reader.world.meshes.push_back({name, std::move(surface.vertices), std::move(surface.triangles), friction});
  }
}

// The mass of a link whose only shape is a box: as given, or with auto (SDF 1.11) by its density.
double mass_kg_of(const sdf::Link& link) {
  constexpr double kOtherwise_kg = 1, kOtherwise_kgpm3 = 1000;  // SDF's defaults
  const sdf::Collision& collision = *link.CollisionByIndex(0);
  const sdf::ElementPtr inertial = link.Element()->FindElement(kInertialElement);
  double mass_kg = kOtherwise_kg;
  if (inertial && inertial->HasElement("mass")) {
    mass_kg = inertial->Get<double>("mass");
  } else if (inertial && inertial->Get<bool>("auto") && collision.Geom()->BoxShape()) {
    const auto& size = collision.Geom()->BoxShape()->Size();
    const double of_link_kgpm3 = inertial->Get<double>("density", kOtherwise_kgpm3).first;
    const double density_kgpm3 = collision.Element()->Get<double>("density", of_link_kgpm3).first;
    mass_kg = density_kgpm3 * size.X() * size.Y() * size.Z();
  }
  if (!(mass_kg > 0 && mass_kg < 1e6)) fail_at(link.Element(), "<mass> must be more than 0 and below 1e6 kg");
  return mass_kg;
}

// `X_WParent` is the pose of the outer model; models within a static one are static too.
void read_model(Reader& reader, const sdf::Model& model, const Pose& X_WParent, const std::string& parent_frame,
                const std::string& prefix, bool within_static) {
  const Pose X_WM = compose(X_WParent, resolved_pose(model.SemanticPose(), model.Element(), parent_frame));
  const std::string name = prefix + model.Name();

  // A model that moves must be one body with one shape.
  const bool fixed = within_static || model.Static();
  const bool one_body =
      model.LinkCount() == 1 && model.LinkByIndex(0)->CollisionCount() == 1 && model.ModelCount() == 0;
  if (!fixed && !one_body)
    return reader.notes.add(place_of(model.Element()),
                            fmt::format("model \"{}\" is not <static> and more than one body with one <collision>: "
                                        "it is left out",
                                        name));

  // Links with their collisions, then inner models. A static model has no mass.
  for (std::uint64_t l = 0; l < model.LinkCount(); ++l) {
    const sdf::Link& link = *model.LinkByIndex(l);
    const Pose X_WL = compose(X_WM, resolved_pose(link.SemanticPose(), link.Element(), "__model__"));
    const double mass_kg = fixed ? 0 : mass_kg_of(link);
    for (std::uint64_t c = 0; c < link.CollisionCount(); ++c) {
      const sdf::Collision& collision = *link.CollisionByIndex(c);
      read_collision(reader, collision, X_WL, one_body ? name : name + "/" + link.Name() + "/" + collision.Name(),
                     mass_kg);
    }
  }
  for (std::uint64_t m = 0; m < model.ModelCount(); ++m)
    read_model(reader, *model.ModelByIndex(m), X_WM, "__model__", name + "/", fixed);
}

WorldDescription read_world(Reader& reader, const sdf::World& world) {
  reader.world.name = world.Name();
  const auto gravity = world.Gravity();
  reader.world.gravity_W_mps2 = {gravity.X(), gravity.Y(), gravity.Z()};
  if (!(reader.world.gravity_W_mps2.norm() <= kMaxGravity_mps2))
    fail_at(world.Element()->GetElement("gravity"), fmt::format("<gravity> must be at most {} m/s2", kMaxGravity_mps2));

  for (std::uint64_t m = 0; m < world.ModelCount(); ++m)
    read_model(reader, *world.ModelByIndex(m), {}, "world", "", false);
  for (std::uint64_t f = 0; f < world.FrameCount(); ++f) {
    const sdf::Frame& frame = *world.FrameByIndex(f);
    if (!frame.Name().starts_with("start")) continue;
    reader.world.start_poses.push_back({frame.Name(), resolved_pose(frame.SemanticPose(), frame.Element(), "world")});
  }
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
  // The text with all that it includes, as one document.
  SdfNotes notes(unsupported);
  WorldFiles files(name_for_errors, folder, search);
  const SdfPart outline = outline_world(sdf_text, name_for_errors, notes);
  const sdf::SDFPtr document = document_of(SdfAssembly(files, notes).assemble(outline));

  // libsdformat's objects, with frames and poses.
  sdf::Root root;
  const sdf::Errors errors = root.Load(document);
  if (!errors.empty() || root.WorldCount() != 1)
    throw description::DescriptionError(
        fmt::format("{}: {}", name_for_errors, errors.empty() ? "holds no world" : message_of(errors.front())));
  Reader reader{notes, {files}};
  WorldDescription world = read_world(reader, *root.WorldByIndex(0));
  notes.finish();
  return world;
}

WorldDescription load_world(const std::string& name_or_path, std::vector<std::string>& unsupported) {
  const description::DescriptionFile file = description::read_description_file("world", name_or_path, ".sdf");
  const std::filesystem::path folder = std::filesystem::path(file.path).parent_path();
  return parse_world(file.text, file.path, folder.empty() ? "." : folder, unsupported, world_search_path());
}

}  // namespace kenaf::physics
