#include "physics/world_description.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sdf/sdf.hh>

#include "formats/description/description_file.hpp"
#include "physics/files/sdf_reader.hpp"
#include "physics/files/sdf_surface.hpp"
#include "physics/files/world_files.hpp"

namespace kenaf::physics {
namespace {

constexpr double kMaxFriction = 10;
// The limit of the indices of Bullet's tree of a mesh; a world of that size takes some hundreds of MB.
constexpr std::size_t kMostTriangles = std::size_t{1} << 21U;

struct Reader {
  SdfPlaces places;
  WorldFiles files;
  WorldDescription world{};
  std::size_t triangles_left = kMostTriangles;
};

// `relative_to` empty: relative to the element's parent.
Pose resolved_pose(const Reader& reader, const sdf::SemanticPose& semantic, const sdf::ElementPtr& element,
                   const std::string& relative_to) {
  ignition::math::Pose3d pose;
  const sdf::Errors errors = semantic.Resolve(pose, relative_to);
  if (!errors.empty()) reader.places.fail(element, errors.front().Message());
  if (!pose.IsFinite() || pose.Pos().Length() > kMaxCoordinate_m)
    reader.places.fail(element, fmt::format("a pose is not a number or further than {} m away", kMaxCoordinate_m));
  return {{pose.Pos().X(), pose.Pos().Y(), pose.Pos().Z()},
          Eigen::Quaterniond(pose.Rot().W(), pose.Rot().X(), pose.Rot().Y(), pose.Rot().Z()).normalized()};
}

double friction_of(const Reader& reader, const sdf::Collision& collision) {
  sdf::ElementPtr element = collision.Element();
  for (const char* name : {"surface", "friction", "ode", "mu"}) {
    if (!element->HasElement(name)) return 1.0;
    element = element->GetElement(name);
  }
  if (!element->GetExplicitlySetInFile()) return 1.0;
  const double mu = element->Get<double>();
  if (!(mu >= 0 && mu <= kMaxFriction))
    reader.places.fail(element, fmt::format("<mu> must be from 0 to {}", kMaxFriction));
  return mu;
}

// `mass_kg` is 0 for a static model.
void read_collision(Reader& reader, const sdf::Collision& collision, const Pose& X_WLink, const std::string& name,
                    double mass_kg) {
  // One shape in each collision; of models that move only boxes are simulated.
  const SdfPlaces& places = reader.places;
  const Pose X_WC = compose(X_WLink, resolved_pose(reader, collision.SemanticPose(), collision.Element(), ""));
  const sdf::Geometry& geometry = *collision.Geom();
  const double friction = friction_of(reader, collision);
  const sdf::ElementPtr shape = geometry.Element() ? geometry.Element()->GetFirstElement() : nullptr;
  if (!shape) return;
  if (shape->GetNextElement()) places.fail(shape->GetNextElement(), "a <geometry> must hold one shape");
  if (mass_kg > 0 && !geometry.BoxShape())
    return places.skip(shape, fmt::format("a <{}> of a model that is not <static> is not simulated", shape->GetName()));

  // A plane gets its normal as z axis, a box stays a box, everything else becomes triangles in W.
  if (const sdf::Plane* plane = geometry.PlaneShape()) {
    const auto n = plane->Normal();
    const Eigen::Vector3d normal(n.X(), n.Y(), n.Z());
    if (!normal.allFinite() || normal.norm() < 1e-9) places.fail(shape, "<normal> must not be zero");
    Pose X_WP = X_WC;
    X_WP.q = X_WC.q * Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), normal);
    reader.world.planes.push_back({X_WP, friction});
  } else if (const sdf::Box* box = geometry.BoxShape()) {
    const Eigen::Vector3d size(box->Size().X(), box->Size().Y(), box->Size().Z());
    if (!(size.minCoeff() > 0) || !(size.maxCoeff() <= kMaxCoordinate_m))
      places.fail(shape, fmt::format("<size> of a box must be more than 0 and at most {} m", kMaxCoordinate_m));
    reader.world.boxes.push_back({name, size, X_WC, friction, mass_kg});
  } else {
    TriangleSurface surface = read_surface(places, geometry, reader.files, reader.triangles_left);
    if (surface.triangles.empty()) return;
    reader.triangles_left -= surface.triangles.size();
    for (Eigen::Vector3d& p : surface.vertices) p = X_WC.p + X_WC.q * p;
    reader.world.meshes.push_back({name, std::move(surface.vertices), std::move(surface.triangles), friction});
  }
}

// `X_WParent` is the pose of the outer model; models within a static one are static too.
void read_model(Reader& reader, const sdf::Model& model, const Pose& X_WParent, const std::string& parent_frame,
                const std::string& prefix, bool within_static) {
  const Pose X_WM = compose(X_WParent, resolved_pose(reader, model.SemanticPose(), model.Element(), parent_frame));
  const std::string name = prefix + model.Name();

  // A model that moves must be one body with one shape.
  const bool fixed = within_static || model.Static();
  const bool one_body =
      model.LinkCount() == 1 && model.LinkByIndex(0)->CollisionCount() == 1 && model.ModelCount() == 0;
  if (!fixed && !one_body)
    return reader.places.skip(model.Element(),
                              fmt::format("model \"{}\" is not <static> and more than one body with one <collision>: "
                                          "it is left out",
                                          name));

  // Links with their collisions, then inner models. A static model has no mass.
  for (std::uint64_t l = 0; l < model.LinkCount(); ++l) {
    const sdf::Link& link = *model.LinkByIndex(l);
    const Pose X_WL = compose(X_WM, resolved_pose(reader, link.SemanticPose(), link.Element(), "__model__"));
    double mass_kg = 0;
    if (!fixed) {
      mass_kg = link.Inertial().MassMatrix().Mass();
      if (!(mass_kg > 0 && mass_kg < 1e6))
        reader.places.fail(link.Element(), "<mass> must be more than 0 and below 1e6 kg");
    }
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
  list_unknown(reader.places, world.Element());
  reader.world.name = world.Name();
  const auto gravity = world.Gravity();
  if (std::abs(gravity.X()) > 1e-9 || std::abs(gravity.Y()) > 1e-9 || !(gravity.Z() <= 0 && gravity.Z() > -1000))
    reader.places.fail(world.Element(), "<gravity> must point along -z; tilt the ground instead");
  reader.world.gravity_W_mps2 = {0, 0, gravity.Z()};

  for (std::uint64_t m = 0; m < world.ModelCount(); ++m)
    read_model(reader, *world.ModelByIndex(m), {}, "world", "", false);
  for (std::uint64_t f = 0; f < world.FrameCount(); ++f) {
    const sdf::Frame& frame = *world.FrameByIndex(f);
    if (!frame.Name().starts_with("start")) continue;
    reader.world.start_poses.push_back(
        {frame.Name(), resolved_pose(reader, frame.SemanticPose(), frame.Element(), "world")});
  }
  if (reader.world.start_poses.empty()) reader.world.start_poses.push_back({"PlayerStart_0", {}});
  return std::move(reader.world);
}

}  // namespace

WorldDescription parse_world(std::string_view sdf_text, const std::string& name_for_errors,
                             const std::filesystem::path& folder, std::vector<std::string>& unsupported) {
  sdf::Console::Instance()->SetQuiet(true);  // its messages are returned as errors below
  sdf::ParserConfig config;
  config.SetWarningsPolicy(sdf::EnforcementPolicy::ERR);
  config.SetUnrecognizedElementsPolicy(sdf::EnforcementPolicy::ERR);
  config.SetDeprecatedElementsPolicy(sdf::EnforcementPolicy::LOG);
  // libsdformat opens no other file: WorldFiles reads those that a world refers to.
  config.SetFindCallback([](const std::string&) { return std::string(); });

  // Unknown elements and includes are listed; all other errors are thrown.
  Reader reader{{name_for_errors, unsupported}, WorldFiles(folder)};
  sdf::Root root;
  for (const sdf::Error& error : root.LoadSdfString(std::string(sdf_text), config)) {
    if (error.Code() == sdf::ErrorCode::ELEMENT_INCORRECT_TYPE) continue;  // an unknown element: listed below
    const std::string place =
        error.LineNumber() ? fmt::format("{}:{}", name_for_errors, *error.LineNumber()) : name_for_errors;
    if (error.Code() == sdf::ErrorCode::URI_LOOKUP) {
      unsupported.push_back(fmt::format("{}: <include> is not read; write the model itself into the world", place));
      continue;
    }
    std::string what = error.Message();
    if (error.Code() == sdf::ErrorCode::STRING_READ) what = "is not a well-formed SDF document";  // it quotes all of it
    throw description::DescriptionError(fmt::format("{}: {}", place, what));
  }
  if (root.WorldCount() != 1)
    throw description::DescriptionError(
        fmt::format("{}: must hold exactly one <world>, but holds {}", name_for_errors, root.WorldCount()));
  return read_world(reader, *root.WorldByIndex(0));
}

WorldDescription load_world(const std::string& name_or_path, std::vector<std::string>& unsupported) {
  const description::DescriptionFile file = description::read_description_file("world", name_or_path, ".sdf");
  const std::filesystem::path folder = std::filesystem::path(file.path).parent_path();
  return parse_world(file.text, file.path, folder.empty() ? "." : folder, unsupported);
}

}  // namespace kenaf::physics
