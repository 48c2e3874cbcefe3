#include "physics/world_description.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <sdf/sdf.hh>
#include <set>

#include "physics/description_file.hpp"

namespace kenaf::physics {
namespace {

constexpr double kMaxCoordinate_m = 1e5;
constexpr double kMaxFriction = 10;

// Which children of an element this simulator understands; an element that is not a key here is understood whole.
const std::map<std::string, std::set<std::string>>& known_children() {
  static const std::map<std::string, std::set<std::string>> known{
      {"world", {"gravity", "frame", "model"}},
      {"model", {"static", "pose", "link", "frame"}},
      {"link", {"pose", "collision", "inertial"}},
      {"inertial", {"mass"}},
      {"collision", {"pose", "geometry", "surface"}},
      {"geometry", {"plane", "box"}},
      {"plane", {"normal"}},
      {"surface", {"friction"}},
      {"friction", {"ode"}},
      {"ode", {"mu"}},
  };
  return known;
}

struct Reader {
  std::string file;
  std::vector<std::string>& unsupported;
  WorldDescription world{};

  std::string place(const sdf::ElementPtr& element) const {
    const auto line = element ? element->LineNumber() : std::nullopt;
    return line && *line > 0 ? fmt::format("{}:{}", file, *line) : file;
  }
  [[noreturn]] void fail(const sdf::ElementPtr& element, const std::string& what) const {
    throw DescriptionError(fmt::format("{}: {}", place(element), what));
  }
  void skip(const sdf::ElementPtr& element, const std::string& what) const {
    unsupported.push_back(fmt::format("{}: {}", place(element), what));
  }
};

void list_unknown(const Reader& reader, const sdf::ElementPtr& element) {
  const auto known = known_children().find(element->GetName());
  if (known == known_children().end()) return;
  for (sdf::ElementPtr child = element->GetFirstElement(); child; child = child->GetNextElement()) {
    if (!child->GetExplicitlySetInFile()) continue;
    if (known->second.contains(child->GetName()))
      list_unknown(reader, child);
    else
      reader.skip(child, fmt::format("<{}> in <{}> is not simulated", child->GetName(), element->GetName()));
  }
}

// `relative_to` empty: the frame of the element's parent.
Pose resolved_pose(const Reader& reader, const sdf::SemanticPose& semantic, const sdf::ElementPtr& element,
                   const std::string& relative_to) {
  ignition::math::Pose3d pose;
  const sdf::Errors errors = semantic.Resolve(pose, relative_to);
  if (!errors.empty()) reader.fail(element, errors.front().Message());
  if (!pose.IsFinite() || pose.Pos().Length() > kMaxCoordinate_m)
    reader.fail(element, fmt::format("a pose is not a number or further than {} m away", kMaxCoordinate_m));
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
  if (!(mu >= 0 && mu <= kMaxFriction)) reader.fail(element, fmt::format("<mu> must be from 0 to {}", kMaxFriction));
  return mu;
}

// `mass_kg` 0: of a static model.
void read_collision(Reader& reader, const sdf::Collision& collision, const Pose& X_WLink, const std::string& name,
                    double mass_kg) {
  const Pose X_WC = compose(X_WLink, resolved_pose(reader, collision.SemanticPose(), collision.Element(), ""));
  const sdf::Geometry& geometry = *collision.Geom();
  const double friction = friction_of(reader, collision);
  if (const sdf::Plane* plane = geometry.PlaneShape()) {
    if (mass_kg > 0)
      return reader.skip(collision.Element(), "a <plane> of a model that is not <static> is not simulated");
    const auto n = plane->Normal();
    const Eigen::Vector3d normal(n.X(), n.Y(), n.Z());
    if (!normal.allFinite() || normal.norm() < 1e-9) reader.fail(collision.Element(), "<normal> must not be zero");
    Pose X_WP = X_WC;
    X_WP.q = X_WC.q * Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), normal);
    reader.world.planes.push_back({X_WP, friction});
  } else if (const sdf::Box* box = geometry.BoxShape()) {
    const Eigen::Vector3d size(box->Size().X(), box->Size().Y(), box->Size().Z());
    if (!(size.minCoeff() > 0) || !(size.maxCoeff() <= kMaxCoordinate_m))
      reader.fail(collision.Element(),
                  fmt::format("<size> of a box must be more than 0 and at most {} m", kMaxCoordinate_m));
    reader.world.boxes.push_back({name, size, X_WC, friction, mass_kg});
  }
}

void read_model(Reader& reader, const sdf::Model& model) {
  const Pose X_WM = resolved_pose(reader, model.SemanticPose(), model.Element(), "world");
  const bool one_body = model.LinkCount() == 1 && model.LinkByIndex(0)->CollisionCount() == 1;
  if (!model.Static() && !one_body)
    return reader.skip(model.Element(), fmt::format("model \"{}\" is not <static> and more than one body with one "
                                                    "<collision>: it is left out",
                                                    model.Name()));
  for (std::uint64_t l = 0; l < model.LinkCount(); ++l) {
    const sdf::Link& link = *model.LinkByIndex(l);
    const Pose X_WL = compose(X_WM, resolved_pose(reader, link.SemanticPose(), link.Element(), "__model__"));
    double mass_kg = 0;
    if (!model.Static()) {
      mass_kg = link.Inertial().MassMatrix().Mass();
      if (!(mass_kg > 0 && mass_kg < 1e6)) reader.fail(link.Element(), "<mass> must be more than 0 and below 1e6 kg");
    }
    for (std::uint64_t c = 0; c < link.CollisionCount(); ++c) {
      const sdf::Collision& collision = *link.CollisionByIndex(c);
      std::string name = model.Name();
      if (!one_body) name += "/" + link.Name() + "/" + collision.Name();
      read_collision(reader, collision, X_WL, name, mass_kg);
    }
  }
}

WorldDescription read_world(Reader& reader, const sdf::World& world) {
  list_unknown(reader, world.Element());
  reader.world.name = world.Name();
  const auto gravity = world.Gravity();
  if (std::abs(gravity.X()) > 1e-9 || std::abs(gravity.Y()) > 1e-9 || !(gravity.Z() <= 0 && gravity.Z() > -1000))
    reader.fail(world.Element(), "<gravity> must point along -z; tilt the ground instead");
  reader.world.gravity_W_mps2 = {0, 0, gravity.Z()};

  for (std::uint64_t m = 0; m < world.ModelCount(); ++m) read_model(reader, *world.ModelByIndex(m));
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
                             std::vector<std::string>& unsupported) {
  sdf::Console::Instance()->SetQuiet(true);  // its messages come back as errors below
  sdf::ParserConfig config;
  config.SetWarningsPolicy(sdf::EnforcementPolicy::ERR);
  config.SetUnrecognizedElementsPolicy(sdf::EnforcementPolicy::ERR);
  config.SetDeprecatedElementsPolicy(sdf::EnforcementPolicy::LOG);
  // a world is one file: nothing is looked up elsewhere
  config.SetFindCallback([](const std::string&) { return std::string(); });

  sdf::Root root;
  for (const sdf::Error& error : root.LoadSdfString(std::string(sdf_text), config)) {
    if (error.Code() == sdf::ErrorCode::ELEMENT_INCORRECT_TYPE) continue;  // an unknown element: listed below
    std::string what = error.Message();
    if (error.Code() == sdf::ErrorCode::STRING_READ) what = "is not a well-formed SDF document";  // it quotes all of it
    throw DescriptionError(fmt::format("{}:{} {}", name_for_errors,
                                       error.LineNumber() ? fmt::format("{}:", *error.LineNumber()) : "", what));
  }
  if (root.WorldCount() != 1)
    throw DescriptionError(
        fmt::format("{}: must hold exactly one <world>, but holds {}", name_for_errors, root.WorldCount()));
  Reader reader{name_for_errors, unsupported};
  return read_world(reader, *root.WorldByIndex(0));
}

WorldDescription load_world(const std::string& name_or_path, std::vector<std::string>& unsupported) {
  const DescriptionFile file = read_description_file("world", name_or_path, ".sdf");
  return parse_world(file.text, file.path, unsupported);
}

}  // namespace kenaf::physics
