// Where the models, links, collisions and frames of a world are
// (http://sdformat.org/tutorials?tut=pose_frame_semantics).
//
// S is the world or model in which an element is defined, its scope; N the element's own frame. Thread safety: one
// thread at a time.
#pragma once

#include <string_view>
#include <unordered_map>

#include "physics/files/sdf_element.hpp"
#include "physics/pose.hpp"

namespace kenaf::physics {

class SdfFrames {
 public:
  static constexpr int kLongestChain = 100;  // of poses, each relative to the next
  static constexpr double kMaxCoordinate_m = 1e5;

  // `world` must stay as it is as long as this lives. Throws DescriptionError ("file:line: what") if a pose is no pose,
  // is relative to a name that its scope does not hold, to itself or to more others than kLongestChain, or leads
  // further than kMaxCoordinate_m.
  explicit SdfFrames(const SdfElement& world);

  // Returns where an element of the world is: a model, link or frame in its scope (X_SN), a collision in its link.
  const Pose& pose_in_scope(const SdfElement& element) const { return nodes_.at(&element).X_SN; }

 private:
  enum class State { waiting, being_resolved, resolved };
  struct Node {
    const SdfElement* scope;  // of a collision: its link
    State state = State::waiting;
    int chain = 0;  // how many others it is relative to, each to the next
    Pose X_SN{};
  };

  void add_children(const SdfElement& scope);
  void resolve_children(const SdfElement& parent);
  const Node& resolved(const SdfElement& element);
  Pose resolve(const SdfElement& element, const SdfElement& scope, int& chain);
  Pose resolve_model(const SdfElement& model, const SdfElement& scope, int& chain);
  Pose frame_in(const SdfElement& scope, std::string_view name, const SdfElement& said_at, int& chain);

  std::unordered_map<const SdfElement*, Node> nodes_;
  std::unordered_map<const SdfElement*, std::unordered_map<std::string_view, const SdfElement*>> named_;  // by scope
  int being_resolved_ = 0;
};

}  // namespace kenaf::physics
