#include "physics/files/sdf_merge.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>

namespace kenaf::physics {
namespace {

constexpr std::string_view kOwnFrame = "__model__";

bool has_frame(const SdfElement& element) {
  return element.name == "link" || element.name == "frame" || element.name == "joint" || element.name == "model";
}

// The pose of an element in the merged model, which may have none: relative to the frame that stands for the model's.
void put_in_frame(SdfElement& element, const std::string& frame) {
  if (attribute_of(element, "attached_to") == kOwnFrame) set_attribute(element, "attached_to", frame);
  auto pose = std::ranges::find(element.children, "pose", &SdfElement::name);
  const std::string_view said = pose != element.children.end() ? attribute_of(*pose, "relative_to") : "";
  const bool is_in_own = said == kOwnFrame || (said.empty() && attribute_of(element, "attached_to").empty());
  if (!is_in_own) return;
  if (pose == element.children.end())
    pose = element.children.insert(pose, SdfElement{element.file, element.line, "pose", "", {}, {}});
  set_attribute(*pose, "relative_to", frame);
}

}  // namespace

void add_merged(SdfElement model, std::vector<SdfElement>& children) {
  SdfElement own{model.file, model.line, "frame", "", {}, {}};
  const std::string frame = fmt::format("_merged__{}{}", attribute_of(model, "name"), kOwnFrame);
  set_attribute(own, "name", frame);
  if (const SdfElement* pose = child_of(model, "pose")) own.children.push_back(*pose);
  children.push_back(std::move(own));

  for (SdfElement& child : model.children) {
    if (!has_frame(child)) continue;
    put_in_frame(child, frame);
    if (child.name == "link")
      for (SdfElement& collision : child.children)
        for (SdfElement& pose : collision.children)
          if (pose.name == "pose" && attribute_of(pose, "relative_to") == kOwnFrame)
            set_attribute(pose, "relative_to", frame);
    children.push_back(std::move(child));
  }
}

}  // namespace kenaf::physics
