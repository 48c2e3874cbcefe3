#include "keys.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace kenaf::teleop {

namespace {

// The emergency stop needs no shift key, its release does.
constexpr auto kKeys = std::to_array<std::pair<std::string_view, Action>>({
    {"w", Action::forward},
    {"up", Action::forward},
    {"s", Action::backward},
    {"down", Action::backward},
    {"a", Action::turn_left},
    {"left", Action::turn_left},
    {"d", Action::turn_right},
    {"right", Action::turn_right},
    {"home", Action::forward_left},  // arranged as on a keypad
    {"page_up", Action::forward_right},
    {"end", Action::backward_left},
    {"page_down", Action::backward_right},
    {"space", Action::stand},
    {"e", Action::emergency_stop},
    {"E", Action::emergency_stop},
    {"X", Action::release_emergency},
    {"+", Action::faster},
    {"=", Action::faster},
    {"-", Action::slower},
    {"1", Action::posture_1},
    {"2", Action::posture_2},
    {"3", Action::posture_3},
    {"4", Action::posture_4},
    {"5", Action::posture_5},
    {"6", Action::posture_6},
    {"u", Action::front_left_up},
    {"j", Action::front_left_down},
    {"i", Action::front_right_up},
    {"k", Action::front_right_down},
    {"o", Action::rear_left_up},
    {"l", Action::rear_left_down},
    {"p", Action::rear_right_up},
    {";", Action::rear_right_down},
    {"r", Action::front_up},
    {"f", Action::front_down},
    {"t", Action::rear_up},
    {"g", Action::rear_down},
    {"Q", Action::quit},
    {"ctrl_c", Action::quit},
});

}  // namespace

bool drives(Action action) {
  return action <= Action::backward_right;
}

std::optional<Action> action_of_key(std::string_view key) {
  const auto found = std::ranges::find(kKeys, key, &std::pair<std::string_view, Action>::first);
  return found == kKeys.end() ? std::nullopt : std::optional(found->second);
}

void DriveKey::press(Action action, double now_s) {
  const bool is_repeat = held(now_s) == action;
  held_ = action;
  until_s_ = now_s + (is_repeat ? timing_.repeat_s : timing_.first_s);
}

std::optional<Action> DriveKey::held(double now_s) const {
  return held_ && now_s < until_s_ ? held_ : std::nullopt;
}

}  // namespace kenaf::teleop
