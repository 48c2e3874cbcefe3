#include "physics/files/sdf_outline.hpp"

#include <fmt/format.h>
#include <tinyxml2.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <map>
#include <set>

#include "formats/description/description_error.hpp"

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
      {"include", {{"uri", "name", "pose", "static", "placement_frame"}, {}}},
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
  std::string text;
  int minor = 0;  // of version 1

  bool before(int other) const { return minor < other; }
};

// What is the same for a whole file.
struct Source {
  const std::string& file;
  SdfNotes& notes;
  Version version{};
  Names frames_named{};  // by relative_to and the like, with their scopes and without

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

// Writes a part's document. An element starts in the line that it has in the file.
class PartWriter {
 public:
  explicit PartWriter(const SdfPart& part) : line_(part.line), text_(kPartBegin), end_(kPartEnd) {
    if (part.kind == "world") text_ = kWorldBegin, end_ = kWorldEnd;
  }

  void open(std::string_view name, int line) {
    for (; line_ < line; ++line_) text_ += '\n';
    text_ += fmt::format("<{}", name);
  }
  void attribute(std::string_view name, std::string_view value) {
    text_ += fmt::format(" {}=\"", name);
    escape(value);
    text_ += '"';
  }
  void content(std::string_view value) {
    text_ += '>';
    escape(value);
  }
  void close(std::string_view name) { text_ += fmt::format("</{}>", name); }
  std::string finish() {
    text_ += end_;
    return std::move(text_);
  }

 private:
  static constexpr const char *kWorldBegin = "<sdf version=\"1.9\">", *kWorldEnd = "</sdf>";
  // A model outside of a world may not have a pose relative to others.
  static constexpr const char *kPartBegin = "<sdf version=\"1.9\"><world name=\"w\">", *kPartEnd = "</world></sdf>";

  void escape(std::string_view value) {
    for (const char c : value) {
      switch (c) {
        case '&':
          text_ += "&amp;";
          break;
        case '<':
          text_ += "&lt;";
          break;
        case '>':
          text_ += "&gt;";
          break;
        case '"':
          text_ += "&quot;";
          break;
        case '\n':
          text_ += ' ';
          break;  // lines are those of elements
        default:
          text_ += c;
      }
    }
  }

  int line_;
  std::string text_, end_;
};

// Before SDF 1.8, "a::b" was a name like any other, left by tools that joined models; since then it is b in a.
std::string name_in_1_9(const Source& source, std::string_view name) {
  std::string result(name);
  if (!source.version.before(8)) return result;
  for (std::size_t at = 0; (at = result.find("::", at)) != std::string::npos;) result.replace(at, 2, "/");
  return result;
}

void write_attributes(Source& source, const XMLElement& element, PartWriter& out) {
  const Names& known = known_of(element.Value()).attributes;
  const bool is_pose = element.Value() == std::string_view("pose");
  for (const tinyxml2::XMLAttribute* a = element.FirstAttribute(); a; a = a->Next()) {
    // Up to SDF 1.6 a pose's frame was relative_to.
    std::string_view name = a->Name();
    if (is_pose && name == "frame" && (source.version.before(7) || *a->Value() == '\0')) {
      if (*a->Value() == '\0') continue;  // empty: the parent's, the default
      name = "relative_to";
    }
    if (known.contains(name))
      out.attribute(name, name_in_1_9(source, a->Value()));
    else if (name.find(':') == std::string_view::npos && name != "xmlns")
      source.notes.add(source.place(element),
                       fmt::format("the attribute {} of <{}> is not simulated", name, element.Value()));
  }
}

void note_unknown(Source& source, const XMLElement& child, const XMLElement& parent) {
  source.notes.add(source.place(child), fmt::format("<{}> in <{}> is not simulated", child.Value(), parent.Value()));
}

void write_element(Source& source, const XMLElement& element, PartWriter& out) {
  const std::string_view name = element.Value();
  out.open(name, element.GetLineNum());
  write_attributes(source, element, out);
  out.content(text_of(&element));
  int points = 0;
  for (const XMLElement* child = element.FirstChildElement(); child; child = child->NextSiblingElement()) {
    if (name == "polyline" && ++points > kMostPoints) source.fail(*child, "a polygon must have at most 500 corners");
    if (known_of(name).children.contains(child->Value()))
      write_element(source, *child, out);
    else
      note_unknown(source, *child, element);
  }
  out.close(name);
}

SdfPart part_of(const Source& source, const XMLElement& element, std::string_view kind) {
  return {source.file, source.version.text, element.GetLineNum(), std::string(kind), {}, {}, {}};
}

// A joint is not simulated, but its name is that of a frame of its child, in which poses may be given.
void add_joint_as_frame(Source& source, const XMLElement& joint, std::vector<SdfPart>& parts) {
  const char* name = joint.Attribute("name");
  const std::string_view child = trimmed(text_of(joint.FirstChildElement("child")));
  if (!name || child.empty() || child == "world" || !source.frames_named.contains(name)) return;
  SdfPart part = part_of(source, joint, "frame");
  PartWriter out(part);
  out.open("frame", part.line);
  out.attribute("name", name_in_1_9(source, name));
  out.attribute("attached_to", name_in_1_9(source, child));
  out.content("");
  if (const XMLElement* pose = joint.FirstChildElement("pose")) write_element(source, *pose, out);
  out.close("frame");
  part.document = out.finish();
  parts.push_back(std::move(part));
}

SdfPart outline_include(Source& source, const XMLElement& include) {
  // A <model> of the overrides alone.
  SdfPart part = part_of(source, include, "model");
  part.include_uri = trimmed(text_of(include.FirstChildElement("uri")));
  if (part.include_uri.empty()) source.fail(include, "an <include> needs a <uri>");
  for (const XMLElement* child = include.FirstChildElement(); child; child = child->NextSiblingElement())
    if (!known_of("include").children.contains(child->Value())) note_unknown(source, *child, include);

  PartWriter out(part);
  out.open("model", part.line);
  if (const std::string_view name = trimmed(text_of(include.FirstChildElement("name"))); !name.empty())
    out.attribute("name", name_in_1_9(source, name));
  if (const std::string_view frame = trimmed(text_of(include.FirstChildElement("placement_frame"))); !frame.empty()) {
    if (!include.FirstChildElement("pose")) source.fail(include, "a <placement_frame> needs a <pose>");
    out.attribute("placement_frame", name_in_1_9(source, frame));
  }
  out.content("");
  for (const char* name : {"static", "pose"})
    if (const XMLElement* child = include.FirstChildElement(name)) write_element(source, *child, out);
  out.close("model");
  part.document = out.finish();

  // Merged models differ by the names of their frames.
  if (include.BoolAttribute("merge"))
    source.notes.add(source.place(include), "merge is not simulated: the model keeps its own frames and names");
  return part;
}

bool is_part(std::string_view name) {
  constexpr std::array<std::string_view, 4> kParts{"model", "link", "collision", "frame"};
  return std::ranges::find(kParts, name) != kParts.end();
}

// `depth` counts the models around it.
SdfPart outline_part(Source& source, const XMLElement& element, int depth) {
  const std::string_view name = element.Value();
  if (depth > kMostNestedModels)
    source.fail(element, fmt::format("models are nested more than {} deep", kMostNestedModels));
  if (const char* own = element.Attribute("name"); !own || *own == '\0')
    source.fail(element, fmt::format("a <{}> needs a name", name));

  // Its own elements; others become parts.
  SdfPart part = part_of(source, element, name);
  PartWriter out(part);
  out.open(name, part.line);
  write_attributes(source, element, out);
  out.content("");
  for (const XMLElement* child = element.FirstChildElement(); child; child = child->NextSiblingElement()) {
    const std::string_view child_name = child->Value();
    if (!known_of(name).children.contains(child_name)) {
      note_unknown(source, *child, element);
      if (child_name == "joint" && name == "model") add_joint_as_frame(source, *child, part.parts);
      // Up to SDF 1.5, gravity was one of the engine's settings.
      if (child_name == "physics" && name == "world" && source.version.before(6))
        if (const XMLElement* gravity = child->FirstChildElement("gravity")) write_element(source, *gravity, out);
    } else if (child_name == "include") {
      part.parts.push_back(outline_include(source, *child));
    } else if (is_part(child_name)) {
      part.parts.push_back(outline_part(source, *child, depth + (child_name == "model" ? 1 : 0)));
    } else {
      write_element(source, *child, out);
    }
  }
  out.close(name);
  part.document = out.finish();
  return part;
}

// With scopes, and without them.
void add_frame_name(std::string_view name, Source& source) {
  source.frames_named.insert(name);
  if (const std::size_t scope = name.rfind("::"); scope != std::string_view::npos)
    source.frames_named.insert(name.substr(scope + 2));
}

// The names in all elements that are kept, so that joints which nobody names need no frame.
void collect_frames_named(const XMLElement& element, Source& source) {
  for (const char* attribute : {"relative_to", "frame", "attached_to", "placement_frame", "canonical_link"})
    if (const char* name = element.Attribute(attribute)) add_frame_name(name, source);
  if (element.Value() == std::string_view("placement_frame")) add_frame_name(trimmed(text_of(&element)), source);
  for (const XMLElement* child = element.FirstChildElement(); child; child = child->NextSiblingElement())
    if (known_elements().contains(child->Value()) || child->Value() == std::string_view("placement_frame") ||
        child->Value() == std::string_view("joint"))
      collect_frames_named(*child, source);
}

Version version_of(const Source& source, const XMLElement& sdf) {
  const char* text = sdf.Attribute("version");
  if (!text) source.fail(sdf, "<sdf> needs a version, such as <sdf version=\"1.9\">");
  Version version{text, 0};
  const std::size_t dot = version.text.find('.');
  const char* end = version.text.data() + version.text.size();
  const bool is_number =
      dot != std::string::npos && std::from_chars(version.text.data() + dot + 1, end, version.minor).ec == std::errc();
  if (!is_number || version.text.substr(0, dot) != "1")
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
  collect_frames_named(*sdf, source);
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

SdfPart outline_world(std::string_view text, const std::string& file, SdfNotes& notes) {
  return with_document(text, file, notes, [](Source& source, const XMLElement& sdf) {
    const XMLElement& world = only_world(source, sdf);
    for (const XMLElement* child = sdf.FirstChildElement(); child; child = child->NextSiblingElement())
      if (child != &world) note_unknown(source, *child, sdf);
    return outline_part(source, world, 0);
  });
}

std::optional<SdfPart> outline_model(std::string_view text, const std::string& file, SdfNotes& notes) {
  return with_document(text, file, notes, [](Source& source, const XMLElement& sdf) -> std::optional<SdfPart> {
    const XMLElement* model = sdf.FirstChildElement("model");
    if (!model) return std::nullopt;
    for (const XMLElement* child = sdf.FirstChildElement(); child; child = child->NextSiblingElement())
      if (child != model) note_unknown(source, *child, sdf);
    return outline_part(source, *model, 1);
  });
}

}  // namespace kenaf::physics
