#include "physics/files/sdf_assembly.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>
#include <utility>

#include "formats/description/description_error.hpp"
#include "physics/files/sdf_merge.hpp"
#include "physics/files/sdf_values.hpp"

namespace kenaf::physics {
namespace {

namespace fs = std::filesystem;
using description::DescriptionError;

// Puts what an <include> says in place of what the model says. The model, not what is in it, stands there for errors.
void override_with(const SdfElement& include, SdfElement& model) {
  model.file = include.file;
  model.line = include.line;
  for (const char* name : {"name", "placement_frame"})
    if (const std::string said = text_in(include, name); !said.empty()) set_attribute(model, name, said);
  for (const char* name : {"static", "pose"}) {
    const SdfElement* said = child_of(include, name);
    if (!said) continue;
    std::erase_if(model.children, [name](const SdfElement& child) { return child.name == name; });
    model.children.push_back(*said);
  }
}

}  // namespace

void SdfAssembly::count(const SdfElement& element) {
  const auto one_more = [&element](std::size_t& count, std::size_t most, const char* what) {
    if (++count > most) fail_at(element, fmt::format("the world has more than {} {}", most, what));
  };
  if (element.name == "model") one_more(models_, kMostModels, "models");
  if (element.name == "link") one_more(links_, kMostLinks, "links");
  if (element.name == "collision") one_more(shapes_, kMostShapes, "shapes");
  if (element.name == "frame" || element.name == "joint") one_more(frames_, kMostFrames, "frames and joints");
}

const std::optional<SdfElement>& SdfAssembly::model_of(const fs::path& file) {
  const auto known = models_by_file_.find(file);
  if (known != models_by_file_.end()) return known->second;
  return models_by_file_[file] = sdf_model(files_.read(file), file.string(), notes_);
}

// `depth` counts the models around the children of `parent`, itself among them.
void SdfAssembly::put_includes(SdfElement& parent, int depth) {
  count(parent);
  std::vector<SdfElement> children;
  children.reserve(parent.children.size());
  for (SdfElement& child : parent.children) {
    const bool is_model = child.name == "model" || child.name == "include";
    if (is_model && depth + 1 > kMostNestedModels)
      fail_at(child, fmt::format("models are nested more than {} deep", kMostNestedModels));
    if (child.name == "include") {
      std::optional<SdfElement> model = included(child, depth + 1);
      if (!model) continue;
      if (is_merged(child, *model, parent))
        add_merged(std::move(*model), children);
      else
        children.push_back(std::move(*model));
      continue;
    }
    if (is_model || child.name == "link" || child.name == "collision" || child.name == "frame" || child.name == "joint")
      put_includes(child, depth + (is_model ? 1 : 0));
    children.push_back(std::move(child));
  }
  parent.children = std::move(children);
  check_sibling_names(parent);
}

// Whether an <include> asks for that, and it can be done.
bool SdfAssembly::is_merged(const SdfElement& include, const SdfElement& model, const SdfElement& parent) {
  if (!truth_attribute_of(include, "merge", false)) return false;
  const bool is_possible = parent.name == "model" && attribute_of(model, "placement_frame").empty();
  if (!is_possible)
    notes_.add(place_of(include),
               "merge is simulated only in a <model>, and of one without a placement frame: this "
               "one keeps its own frames and names");
  return is_possible;
}

std::optional<fs::path> SdfAssembly::file_of(const SdfElement& include) {
  const std::string uri = text_in(include, "uri");
  if (!WorldFiles::is_local(uri) || !files_.has_folders()) return std::nullopt;
  try {
    return files_.find_model(uri, *include.file);
  } catch (const DescriptionError& error) {
    fail_at(include, error.what());
  }
}

std::optional<SdfElement> SdfAssembly::included(const SdfElement& include, int depth) {
  // A file, none of those that are open.
  const std::optional<fs::path> file = file_of(include);
  if (!file) {
    notes_.add(place_of(include),
               fmt::format("<include> of \"{}\" is left out: it is in no folder of this world ({}); KENAF_WORLD_PATH "
                           "names more",
                           text_in(include, "uri"), files_.folders_in_words()));
    return std::nullopt;
  }
  if (const auto first = std::ranges::find(chain_, *file); first != chain_.end()) {
    std::string chain;
    for (auto each = first; each != chain_.end(); ++each) chain += each->string() + " includes ";
    fail_at(include, fmt::format("a file includes itself: {}{}", chain, file->string()));
  }

  // Its model, with what the <include> says.
  std::optional<SdfElement> model;
  try {
    model = model_of(*file);
  } catch (const DescriptionError& error) {
    fail_at(include, fmt::format("<include>: {}", error.what()));
  }
  if (!model) {
    notes_.add(place_of(include),
               fmt::format("<include> of \"{}\" is left out: it holds no <model>", text_in(include, "uri")));
    return std::nullopt;
  }
  chain_.push_back(*file);
  put_includes(*model, depth);
  chain_.pop_back();
  override_with(include, *model);
  check_name(*model);
  return model;
}

SdfElement SdfAssembly::assemble(SdfElement world) {
  std::error_code not_a_file;
  chain_.assign(1, fs::weakly_canonical(*world.file, not_a_file));
  put_includes(world, 0);
  return world;
}

}  // namespace kenaf::physics
