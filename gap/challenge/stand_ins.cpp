#include "gap/challenge/stand_ins.hpp"

#include <algorithm>
#include <map>

namespace kenaf::gap::challenge {
namespace {

struct StandIn {
  std::string_view effect, other;
};
constexpr StandIn kStandIns[] = {
    // two small first-order lags in series act like one of their sum
    {"drive_lag", "drive.time_constant_s"},
    // the effect also acts on the flippers' belts, but these are off the ground most of the time
    {"friction_along", "track.friction_along"},
    {"friction_across", "track.friction_across"},
    // in a log, a pose reported late cannot be distinguished from a clock that is behind
    {"tracking_delay", "clock_offset"},
    {"clock_offset", "tracking_delay"},
    // both sides' friction is that of either side, added
    {"drive_coulomb", "drive_coulomb_left"},
    {"drive_coulomb", "drive_coulomb_right"},
};

}  // namespace

const std::vector<candidates::Candidate>& challenged_numbers() {
  static const std::vector<candidates::Candidate> numbers =
      candidates::description_candidates(physics::load_robot(kChallengedRobot));
  return numbers;
}

std::vector<std::string> withheld_names(const CasePlan& plan) {
  std::vector<std::string> names;
  if (plan.stratum == Stratum::withheld_number) names.push_back(plan.number.key);
  if (plan.stratum != Stratum::withheld) return names;
  for (const HiddenEffect& hidden : plan.effects) {
    names.push_back(hidden.effect);
    for (const StandIn& stand_in : kStandIns)
      if (stand_in.effect == hidden.effect) names.emplace_back(stand_in.other);
  }
  return names;
}

bool stand_in_for_each_other(std::string_view one, std::string_view other) {
  return std::ranges::any_of(kStandIns, [&](const StandIn& stand_in) {
    return (stand_in.effect == one && stand_in.other == other) || (stand_in.effect == other && stand_in.other == one);
  });
}

std::vector<std::string> numbers_like(std::string_view effect) {
  std::vector<std::string> keys;
  for (const candidates::Candidate& number : challenged_numbers())
    if (number.same_as == effect) keys.push_back(number.name);
  for (const StandIn& stand_in : kStandIns)
    if (stand_in.effect == effect && physics::find_effect(stand_in.other) == nullptr) keys.emplace_back(stand_in.other);
  return keys;
}

std::vector<std::string> numbers_like_nothing_else() {
  std::vector<std::string> keys;
  for (const candidates::Candidate& number : challenged_numbers())
    if (number.same_as.empty() && std::ranges::count(kStandIns, number.name, &StandIn::other) == 0)
      keys.push_back(number.name);
  return keys;
}

std::string same_effect(const std::string& name) {
  static const std::map<std::string, std::string> same = [] {
    std::map<std::string, std::string> result;
    for (const candidates::Candidate& number : challenged_numbers())
      if (!number.same_as.empty()) result[number.name] = number.same_as;
    return result;
  }();
  const auto found = same.find(name);
  return found == same.end() ? name : found->second;
}

}  // namespace kenaf::gap::challenge
