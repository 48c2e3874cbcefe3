#include "physics/files/sdf_document.hpp"

#include <fmt/format.h>
#include <tinyxml2.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <map>
#include <memory>
#include <set>
#include <unordered_map>
#include <unordered_set>

#include "formats/description/description_error.hpp"
#include "physics/files/sdf_values.hpp"

namespace kenaf::physics {
namespace {

using tinyxml2::XMLElement;

// 500 corners, the first one again, and the height.
constexpr int kMostPoints = 502;

using Names = std::set<std::string_view>;

struct Known {
  Names children, attributes;
};

// What this simulator reads, by element. Models, includes and joints are handled apart.
const std::map<std::string_view, Known>& known_elements() {
  static const std::map<std::string_view, Known> known{
      {"world", {{"gravity", "frame", "model", "include"}, {"name"}}},
      {"model",
       {{"static", "pose", "link", "frame", "model", "include"}, {"name", "canonical_link", "placement_frame"}}},
      {"include", {{"uri", "name", "pose", "static", "placement_frame"}, {"merge"}}},
      {"link", {{"pose", "collision", "inertial"}, {"name"}}},
      {"inertial", {{"mass", "density"}, {"auto"}}},
      {"collision", {{"pose", "geometry", "surface", "density"}, {"name"}}},
      {"frame", {{"pose"}, {"name", "attached_to"}}},
      {"pose", {{}, {"relative_to", "rotation_format", "degrees"}}},
      {"geometry",
       {{"plane", "box", "cylinder", "sphere", "capsule", "ellipsoid", "polyline", "mesh", "heightmap"}, {}}},
      {"plane", {{"normal"}, {}}},
      {"box", {{"size"}, {}}},
      {"cylinder", {{"radius", "length"}, {}}},
      {"sphere", {{"radius"}, {}}},
      {"capsule", {{"radius", "length"}, {}}},
      {"ellipsoid", {{"radii"}, {}}},
      {"polyline", {{"point", "height"}, {}}},
      {"mesh", {{"uri", "scale", "submesh"}, {}}},
      {"submesh", {{"name", "center"}, {}}},
      {"heightmap", {{"uri", "size", "pos"}, {}}},
      {"surface", {{"friction"}, {}}},
      {"friction", {{"ode"}, {}}},
      {"ode", {{"mu"}, {}}},
  };
  return known;
}

const Known& known_of(std::string_view element) {
  static const Known nothing;
  const auto found = known_elements().find(element);
  return found == known_elements().end() ? nothing : found->second;
}

struct Version {
  int minor = 0;  // of version 1

  bool before(int other) const { return minor < other; }
};

// What is the same for a whole file.
struct Source {
  const std::string& file;
  SdfNotes& notes;
  std::shared_ptr<const std::string> name = std::make_shared<const std::string>(file);
  Version version{};

  std::string place(const XMLElement& element) const { return place_of(file, element.GetLineNum()); }
  [[noreturn]] void fail(const XMLElement& element, const std::string& what) const {
    throw description::DescriptionError(fmt::format("{}: {}", place(element), what));
  }
};

std::string_view text_of(const XMLElement* element) {
  const char* text = element ? element->GetText() : nullptr;
  return text ? text : "";
}

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kBlank = " \t\r\n";
  const std::size_t from = text.find_first_not_of(kBlank);
  return from == std::string_view::npos ? "" : text.substr(from, text.find_last_not_of(kBlank) + 1 - from);
}

SdfElement made(const Source& source, const XMLElement& from, std::string_view name) {
  return {source.name, from.GetLineNum(), std::string(name), {}, {}, {}};
}

void add_attributes(Source& source, const XMLElement& from, SdfElement& element) {
  const Names& known = known_of(from.Value()).attributes;
  const bool is_pose = from.Value() == std::string_view("pose");
  for (const tinyxml2::XMLAttribute* a = from.FirstAttribute(); a; a = a->Next()) {
    // Up to SDF 1.6 a pose's frame was relative_to.
    std::string_view name = a->Name();
    if (is_pose && name == "frame" && (source.version.before(7) || *a->Value() == '\0')) {
      if (*a->Value() == '\0') continue;  // empty: the parent's, the default
      name = "relative_to";
    }
    if (known.contains(name))
      element.attributes.emplace_back(name, a->Value());
    else if (name.find(':') == std::string_view::npos && name != "xmlns")
      source.notes.add(source.place(from),
                       fmt::format("the attribute {} of <{}> is not simulated", name, from.Value()));
  }
}

void note_unknown(Source& source, const XMLElement& child, const XMLElement& parent) {
  source.notes.add(source.place(child), fmt::format("<{}> in <{}> is not simulated", child.Value(), parent.Value()));
}

SdfElement read_element(Source& source, const XMLElement& from) {
  const std::string_view name = from.Value();
  SdfElement element = made(source, from, name);
  element.text = trimmed(text_of(&from));
  add_attributes(source, from, element);
  int points = 0;
  for (const XMLElement* child = from.FirstChildElement(); child; child = child->NextSiblingElement()) {
    if (name == "polyline" && ++points > kMostPoints) source.fail(*child, "a polygon must have at most 500 corners");
    if (known_of(name).children.contains(child->Value()))
      element.children.push_back(read_element(source, *child));
    else
      note_unknown(source, *child, from);
  }
  return element;
}

// A joint is not simulated, but its name is that of a frame of its child, in which poses may be given.
void add_joint(Source& source, const XMLElement& from, SdfElement& model) {
  const char* name = from.Attribute("name");
  const std::string_view child = trimmed(text_of(from.FirstChildElement("child")));
  if (!name || child.empty()) return;
  SdfElement joint = made(source, from, "joint");
  joint.attributes = {{"name", name}, {"attached_to", std::string(child)}};
  if (const XMLElement* pose = from.FirstChildElement("pose")) joint.children.push_back(read_element(source, *pose));
  model.children.push_back(std::move(joint));
}

SdfElement read_include(Source& source, const XMLElement& from) {
  SdfElement include = read_element(source, from);
  if (text_in(include, "uri").empty()) source.fail(from, "an <include> needs a <uri>");
  if (const std::string frame = text_in(include, "placement_frame"); !frame.empty() && !child_of(include, "pose"))
    source.fail(from, "a <placement_frame> needs a <pose>");
  return include;
}

bool is_named_kind(std::string_view kind) {
  constexpr std::array<std::string_view, 5> kNamed{"world", "model", "link", "collision", "frame"};
  return std::ranges::find(kNamed, kind) != kNamed.end();
}

// A frame with the name of a link, model or joint beside it gets another one, as libsdformat does it.
void rename_hidden_frames(Source& source, SdfElement& parent) {
  std::unordered_set<std::string> others;
  for (const SdfElement& child : parent.children)
    if (child.name != "frame") others.emplace(attribute_of(child, "name"));
  for (SdfElement& child : parent.children) {
    const std::string name(attribute_of(child, "name"));
    if (child.name != "frame" || !others.contains(name)) continue;
    source.notes.add(place_of(child), fmt::format("the <frame> \"{}\" has another element's name: it is called "
                                                  "\"{}_frame\"",
                                                  name, name));
    set_attribute(child, "name", name + "_frame");
  }
}

// Reads a world, model, link, collision or frame. `depth` counts the models around it.
SdfElement read_named(Source& source, const XMLElement& from, int depth) {
  const std::string_view kind = from.Value();
  if (depth > kMostNestedModels)
    source.fail(from, fmt::format("models are nested more than {} deep", kMostNestedModels));
  SdfElement element = made(source, from, kind);
  add_attributes(source, from, element);
  check_name(element);

  for (const XMLElement* child = from.FirstChildElement(); child; child = child->NextSiblingElement()) {
    const std::string_view child_kind = child->Value();
    if (!known_of(kind).children.contains(child_kind)) {
      note_unknown(source, *child, from);
      if (child_kind == "joint" && kind == "model") add_joint(source, *child, element);
      // Up to SDF 1.5, gravity was one of the engine's settings.
      if (child_kind == "physics" && kind == "world" && source.version.before(6))
        if (const XMLElement* gravity = child->FirstChildElement("gravity"))
          element.children.push_back(read_element(source, *gravity));
    } else if (child_kind == "include") {
      element.children.push_back(read_include(source, *child));
    } else if (is_named_kind(child_kind)) {
      element.children.push_back(read_named(source, *child, depth + (child_kind == "model" ? 1 : 0)));
    } else {
      element.children.push_back(read_element(source, *child));
    }
  }
  rename_hidden_frames(source, element);
  check_sibling_names(element);
  return element;
}

Version version_of(const Source& source, const XMLElement& sdf) {
  const char* text = sdf.Attribute("version");
  if (!text) source.fail(sdf, "<sdf> needs a version, such as <sdf version=\"1.9\">");
  const std::string_view words = text;
  Version version;
  const std::size_t dot = words.find('.');
  const char* end = words.data() + words.size();
  const bool is_number =
      dot != std::string_view::npos && std::from_chars(words.data() + dot + 1, end, version.minor).ec == std::errc();
  if (!is_number || words.substr(0, dot) != "1")
    source.fail(sdf, fmt::format("\"{}\" is not a version of SDF that can be read; they are 1.3 to 1.9", text));
  constexpr int kNewest = 9;
  if (version.minor > kNewest)
    source.notes.add(source.place(sdf), fmt::format("SDF {} is read as SDF 1.{}", text, kNewest));
  return version;
}

// Before a document is made of them.
void check_marks(std::string_view text, const std::string& file) {
  std::size_t marks = 0, attributes = 0;
  for (const char c : text) {
    if (c != '<' && c != '=') continue;
    attributes = c == '<' ? 0 : attributes + 1;
    if (++marks > kMostMarks)
      throw description::DescriptionError(
          fmt::format("{}: has too many elements and attributes: more than {} '<' and '='", file, kMostMarks));
    if (attributes > kMostAttributes)
      throw description::DescriptionError(
          fmt::format("{}: has an element of more than {} attributes", file, kMostAttributes));
  }
}

// Calls read(source, sdf) with the root of the document.
template <typename Read>
auto with_document(std::string_view text, const std::string& file, SdfNotes& notes, const Read& read) {
  check_marks(text, file);
  tinyxml2::XMLDocument document(true, tinyxml2::COLLAPSE_WHITESPACE);
  Source source{file, notes};
  if (document.Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS)
    throw description::DescriptionError(fmt::format("{}: is not a well-formed XML document ({})",
                                                    place_of(file, document.ErrorLineNum()), document.ErrorName()));
  const XMLElement* sdf = document.FirstChildElement("sdf");
  if (!sdf) throw description::DescriptionError(fmt::format("{}: is not SDF: it has no <sdf>", file));
  source.version = version_of(source, *sdf);
  return read(source, *sdf);
}

const XMLElement& only_world(const Source& source, const XMLElement& sdf) {
  int count = 0;
  for (const XMLElement* world = sdf.FirstChildElement("world"); world; world = world->NextSiblingElement("world"))
    ++count;
  if (count != 1)
    throw description::DescriptionError(
        fmt::format("{}: must hold exactly one <world>, but holds {}", source.file, count));
  return *sdf.FirstChildElement("world");
}

}  // namespace

SdfElement sdf_world(std::string_view text, const std::string& file, SdfNotes& notes) {
  return with_document(text, file, notes, [](Source& source, const XMLElement& sdf) {
    const XMLElement& world = only_world(source, sdf);
    for (const XMLElement* child = sdf.FirstChildElement(); child; child = child->NextSiblingElement())
      if (child != &world) note_unknown(source, *child, sdf);
    return read_named(source, world, 0);
  });
}

std::optional<SdfElement> sdf_model(std::string_view text, const std::string& file, SdfNotes& notes) {
  return with_document(text, file, notes, [](Source& source, const XMLElement& sdf) -> std::optional<SdfElement> {
    const XMLElement* model = sdf.FirstChildElement("model");
    if (!model) return std::nullopt;
    for (const XMLElement* child = sdf.FirstChildElement(); child; child = child->NextSiblingElement())
      if (child != model) note_unknown(source, *child, sdf);
    return read_named(source, *model, 1);
  });
}

void check_name(const SdfElement& element) {
  const std::string_view name = attribute_of(element, "name");
  if (name.empty()) fail_at(element, fmt::format("a <{}> needs a name", element.name));
  // http://sdformat.org/tutorials?tut=frame_semantics, "Reserved names".
  const bool is_reserved = (name.size() > 3 && name.starts_with("__") && name.ends_with("__")) ||
                           (name == "world" && (element.name == "model" || element.name == "frame"));
  if (is_reserved) fail_at(element, fmt::format("\"{}\" is a reserved name", name));
}

void check_sibling_names(const SdfElement& parent) {
  std::unordered_map<std::string_view, const SdfElement*> named;
  for (const SdfElement& child : parent.children) {
    if (!is_named_kind(child.name)) continue;
    const std::string_view name = attribute_of(child, "name");
    const auto [first, is_new] = named.emplace(name, &child);
    if (!is_new)
      fail_at(child, fmt::format("<{}> has the name \"{}\" of the <{}> at {}", child.name, name, first->second->name,
                                 place_of(*first->second)));
  }
}

}  // namespace kenaf::physics
