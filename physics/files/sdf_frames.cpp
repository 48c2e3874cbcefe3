#include "physics/files/sdf_frames.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "physics/files/sdf_values.hpp"

namespace kenaf::physics {

namespace {

// Whose frame an element's pose is in, or empty: its scope's, or its link's.
std::string_view relative_to(const SdfElement& element) {
  const SdfElement* pose = child_of(element, "pose");
  const std::string_view said = pose ? attribute_of(*pose, "relative_to") : "";
  return said.empty() ? attribute_of(element, "attached_to") : said;
}

}  // namespace

SdfFrames::SdfFrames(const SdfElement& world) {
  add_children(world);
  resolve_children(world);
}

// Collisions are placed in their link, and name frames of the link's model.
void SdfFrames::add_children(const SdfElement& scope) {
  auto& named = named_[&scope];
  for (const SdfElement& child : scope.children) {
    if (child.name != "model" && child.name != "link" && child.name != "frame" && child.name != "joint") continue;
    nodes_.emplace(&child, Node{&scope});
    const auto [place, is_new] = named.emplace(attribute_of(child, "name"), &child);
    if (!is_new && place->second->name == "joint") place->second = &child;  // before SDF 1.7 two could have one name
    if (child.name == "model") add_children(child);
    if (child.name != "link") continue;
    for (const SdfElement& collision : child.children)
      if (collision.name == "collision") nodes_.emplace(&collision, Node{&child});
  }
}

// In the order of the file, so that its first error is reported. A joint that no pose refers to has no effect, and may
// say anything.
void SdfFrames::resolve_children(const SdfElement& parent) {
  for (const SdfElement& child : parent.children) {
    if (child.name == "joint" || !nodes_.contains(&child)) continue;
    resolved(child);
    resolve_children(child);
  }
}

const SdfFrames::Node& SdfFrames::resolved(const SdfElement& element) {
  Node& node = nodes_.at(&element);
  if (node.state == State::resolved) return node;
  if (node.state == State::being_resolved)
    fail_at(element, "a pose is relative to itself, or to others that are relative to it");

  // The chain is limited on the way to its end, and from an end that is known already.
  const auto limit = [&element](int others) {
    if (others > kLongestChain)
      fail_at(element, fmt::format("a pose is relative to a chain of more than {} others", kLongestChain));
  };
  node.state = State::being_resolved;
  limit(being_resolved_++);
  node.X_SN = resolve(element, *node.scope, node.chain);
  limit(node.chain);
  --being_resolved_;
  if (!node.X_SN.p.allFinite() || node.X_SN.p.norm() > kMaxCoordinate_m)
    fail_at(element, fmt::format("a pose is further than {} m away", kMaxCoordinate_m));
  node.state = State::resolved;
  return node;
}

Pose SdfFrames::resolve(const SdfElement& element, const SdfElement& scope, int& chain) {
  if (element.name == "model") return resolve_model(element, scope, chain);
  const Pose X_RN = pose_in(element);
  const std::string_view said = relative_to(element);
  if (said.empty()) return X_RN;
  if (element.name != "collision") return compose(frame_in(scope, said, element, chain), X_RN);

  // A collision's frame R is one of its model M, and its place that in its link L.
  const SdfElement& model = *nodes_.at(&scope).scope;
  const Pose X_MR = frame_in(model, said, element, chain);
  return compose(compose(inverse(resolved(scope).X_SN), X_MR), X_RN);
}

// A placement frame P of the model's own is put at the pose, with the model around it: X_SN = X_SP X_NP^-1.
Pose SdfFrames::resolve_model(const SdfElement& model, const SdfElement& scope, int& chain) {
  const Pose X_RP = pose_in(model);
  const std::string_view said = relative_to(model), placed = attribute_of(model, "placement_frame");
  const Pose X_SP = said.empty() ? X_RP : compose(frame_in(scope, said, model, chain), X_RP);
  return placed.empty() ? X_SP : compose(X_SP, inverse(frame_in(model, placed, model, chain)));
}

// "a", or "a::b" for what the model a calls b. A name that holds "::" itself, as it could before SDF 1.8, comes first.
Pose SdfFrames::frame_in(const SdfElement& scope, std::string_view name, const SdfElement& said_at, int& chain) {
  if (name == (scope.name == "world" ? "world" : "__model__")) return {};
  const auto& named = named_.at(&scope);
  const auto is_named = [&](std::string_view each) { return named.contains(each); };
  std::string_view first = name;
  while (!is_named(first)) {
    const std::size_t end = first.rfind("::");
    if (end == std::string_view::npos)
      fail_at(said_at,
              fmt::format("a pose is relative to \"{}\": no model, link, joint or frame of {} \"{}\" has that name",
                          name, scope.name, attribute_of(scope, "name")));
    first = first.substr(0, end);
  }

  const SdfElement& found = *named.at(first);
  const Node& node = resolved(found);
  chain = std::max(chain, node.chain + 1);
  const Pose X_SFound = node.X_SN;
  if (first.size() == name.size()) return X_SFound;
  const std::string_view rest = name.substr(first.size() + 2);
  if (found.name != "model")
    fail_at(said_at, fmt::format("a pose is relative to \"{}\", but \"{}\" is a <{}>", name, first, found.name));
  return compose(X_SFound, frame_in(found, rest, said_at, chain));
}

}  // namespace kenaf::physics
