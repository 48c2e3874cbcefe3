#include "physics/files/sdf_assembly.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <system_error>
#include <unordered_map>

#include "formats/description/description_error.hpp"

namespace kenaf::physics {
namespace {

namespace fs = std::filesystem;
using description::DescriptionError;

[[noreturn]] void refuse(const SdfPart& part, const std::string& what) {
  throw DescriptionError(fmt::format("{}: {}", place_of(part.file, part.line), what));
}

void insert(const sdf::ElementPtr& child, const sdf::ElementPtr& parent) {
  child->SetParent(parent);
  parent->InsertElement(child);
}

std::string attribute_of(const sdf::ElementPtr& element, const char* name) {
  const sdf::ParamPtr value = element ? element->GetAttribute(name) : nullptr;
  return value ? value->GetAsString() : "";
}

// In whose frame an element of a world or model is placed, of those in the same one: "a" of "a::b".
std::string placed_in(const sdf::ElementPtr& element) {
  const std::string relative_to = attribute_of(element->FindElement("pose"), "relative_to");
  const std::string in = relative_to.empty() ? attribute_of(element, "attached_to") : relative_to;
  return in.substr(0, in.find("::"));
}

// Throws if poses are relative to one another in too long a chain or in a circle.
void check_chains(const sdf::ElementPtr& world_or_model) {
  std::unordered_map<std::string, std::string> placed;
  for (sdf::ElementPtr each = world_or_model->GetFirstElement(); each; each = each->GetNextElement())
    if (each->GetAttribute("name")) placed.emplace(attribute_of(each, "name"), placed_in(each));
  for (const auto& [name, first] : placed) {
    const std::string* next = &first;
    for (int length = 0; !next->empty(); ++length) {
      const auto found = placed.find(*next);
      if (found == placed.end()) break;
      if (length == SdfAssembly::kLongestChain)
        fail_at(world_or_model, fmt::format("a pose is relative to a chain of more than {} others, or to itself",
                                            SdfAssembly::kLongestChain));
      next = &found->second;
    }
  }
}

// Puts what an <include> says in place of what the model says.
void override_with(const sdf::ElementPtr& said, const sdf::ElementPtr& model) {
  for (const char* attribute : {"name", "placement_frame"})
    if (const sdf::ParamPtr value = said->GetAttribute(attribute); !value->GetAsString().empty())
      *model->GetAttribute(attribute) = *value;
  for (const char* name : {"static", "pose"}) {
    const sdf::ElementPtr given = said->FindElement(name);
    if (!given) continue;
    if (const sdf::ElementPtr own = model->FindElement(name)) model->RemoveChild(own);
    insert(given, model);
  }
}

}  // namespace

void SdfAssembly::count(const SdfPart& part) {
  const auto one_more = [&part](std::size_t& count, std::size_t most, const char* what) {
    if (++count > most) refuse(part, fmt::format("the world has more than {} {}", most, what));
  };
  if (part.kind == "model") one_more(models_, kMostModels, "models");
  if (part.kind == "link") one_more(links_, kMostLinks, "links");
  if (part.kind == "collision") one_more(shapes_, kMostShapes, "shapes");
  if (part.kind == "frame") one_more(frames_, kMostFrames, "frames");
}

const std::optional<SdfPart>& SdfAssembly::outline_of(const fs::path& file) {
  const auto known = outlines_.find(file);
  if (known != outlines_.end()) return known->second;
  return outlines_[file] = outline_model(files_.read(file), file.string(), notes_);
}

sdf::ElementPtr SdfAssembly::element_of(const SdfPart& part, int depth) {
  if (depth > kMostNestedModels) refuse(part, fmt::format("models are nested more than {} deep", kMostNestedModels));
  count(part);
  sdf::ElementPtr element = read_part(part);
  for (const SdfPart& inner : part.parts) {
    const int inner_depth = depth + (inner.kind == "model" ? 1 : 0);
    if (const sdf::ElementPtr made =
            inner.include_uri.empty() ? element_of(inner, inner_depth) : included(inner, inner_depth))
      insert(made, element);
  }

  check_chains(element);

  // SDF allows no moving model without a link; it has no effect.
  if (element->GetName() == "model" && !element->HasElement("link") && !element->HasElement("model")) {
    if (const sdf::ElementPtr said = element->FindElement("static")) element->RemoveChild(said);
    const sdf::ElementPtr is_static(new sdf::Element);
    is_static->SetName("static");
    is_static->AddValue("bool", "true", false);
    insert(is_static, element);
  }
  return element;
}

std::optional<fs::path> SdfAssembly::file_of(const SdfPart& include) {
  if (!WorldFiles::is_local(include.include_uri) || !files_.has_folders()) return std::nullopt;
  try {
    return files_.find_model(include.include_uri, include.file);
  } catch (const DescriptionError& error) {
    refuse(include, error.what());
  }
}

sdf::ElementPtr SdfAssembly::included(const SdfPart& include, int depth) {
  // A file, none of those that are open.
  const std::optional<fs::path> file = file_of(include);
  if (!file) {
    notes_.add(place_of(include.file, include.line),
               fmt::format("<include> of \"{}\" is left out: it is in no folder of this world ({}); KENAF_WORLD_PATH "
                           "names more",
                           include.include_uri, files_.folders_in_words()));
    return nullptr;
  }
  if (const auto first = std::ranges::find(chain_, *file); first != chain_.end()) {
    std::string chain;
    for (auto each = first; each != chain_.end(); ++each) chain += each->string() + " includes ";
    refuse(include, fmt::format("a file includes itself: {}{}", chain, file->string()));
  }

  // Its model, with what the <include> says.
  const std::optional<SdfPart>* outline = nullptr;
  try {
    outline = &outline_of(*file);
  } catch (const DescriptionError& error) {
    refuse(include, fmt::format("<include>: {}", error.what()));
  }
  if (!*outline) {
    notes_.add(place_of(include.file, include.line),
               fmt::format("<include> of \"{}\" is left out: it holds no <model>", include.include_uri));
    return nullptr;
  }
  chain_.push_back(*file);
  sdf::ElementPtr model = element_of(**outline, depth);
  chain_.pop_back();
  override_with(read_part(include), model);
  return model;
}

sdf::ElementPtr SdfAssembly::assemble(const SdfPart& world) {
  std::error_code not_a_file;
  chain_.assign(1, fs::weakly_canonical(world.file, not_a_file));
  return element_of(world, 0);
}

}  // namespace kenaf::physics
