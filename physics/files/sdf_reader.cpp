#include "physics/files/sdf_reader.hpp"

#include <fmt/format.h>

#include <map>
#include <set>

#include "physics/robot_description.hpp"

namespace kenaf::physics {
namespace {

// The children that this simulator supports, by element; an element that is not a key here is supported whole.
const std::map<std::string, std::set<std::string>>& known_children() {
  static const std::map<std::string, std::set<std::string>> known{
      {"world", {"gravity", "frame", "model"}},
      {"model", {"static", "pose", "link", "frame", "model"}},
      {"link", {"pose", "collision", "inertial"}},
      {"inertial", {"mass"}},
      {"collision", {"pose", "geometry", "surface"}},
      {"geometry", {"plane", "box", "cylinder", "sphere", "capsule", "ellipsoid", "polyline", "mesh", "heightmap"}},
      {"plane", {"normal"}},
      {"mesh", {"uri", "scale", "submesh"}},
      {"heightmap", {"uri", "size", "pos"}},
      {"surface", {"friction"}},
      {"friction", {"ode"}},
      {"ode", {"mu"}},
  };
  return known;
}

}  // namespace

std::string SdfPlaces::place(const sdf::ElementPtr& element) const {
  const auto line = element ? element->LineNumber() : std::nullopt;
  return line && *line > 0 ? fmt::format("{}:{}", file, *line) : file;
}

void SdfPlaces::fail(const sdf::ElementPtr& element, const std::string& what) const {
  throw description::DescriptionError(fmt::format("{}: {}", place(element), what));
}

void SdfPlaces::skip(const sdf::ElementPtr& element, const std::string& what) const {
  unsupported.push_back(fmt::format("{}: {}", place(element), what));
}

void list_unknown(const SdfPlaces& places, const sdf::ElementPtr& element) {
  const auto known = known_children().find(element->GetName());
  if (known == known_children().end()) return;
  for (sdf::ElementPtr child = element->GetFirstElement(); child; child = child->GetNextElement()) {
    if (!child->GetExplicitlySetInFile()) continue;
    if (known->second.contains(child->GetName()))
      list_unknown(places, child);
    else
      places.skip(child, fmt::format("<{}> in <{}> is not simulated", child->GetName(), element->GetName()));
  }
}

}  // namespace kenaf::physics
