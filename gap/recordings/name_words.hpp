// The words in the name of a topic, field or column, by which it is guessed what it is.
//
// Thread safety: pure functions.
#pragma once

#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace kenaf::gap::recordings {

using Words = std::vector<std::string>;

// "/joint_states/velocity[frontLeft]" has joint, states, velocity, front, left.
Words words_in(std::string_view name);

bool has_any(const Words& words, std::initializer_list<std::string_view> any);

enum class Side { left, right };
std::optional<Side> side_in(const Words& words);

// "fl", "fr", "rl" or "rr"; empty if the words do not say.
std::string corner_in(const Words& words);

// A unit that is named, as units.hpp spells it; empty: none.
std::string unit_in(std::string_view name);

// Whether a mapping, which is TOML, can hold the name.
bool is_utf8(std::string_view name);

}  // namespace kenaf::gap::recordings
