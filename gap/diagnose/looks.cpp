#include "gap/diagnose/looks.hpp"

#include <algorithm>
#include <cmath>

namespace kenaf::gap::diagnose {

const Settings& nearest_look(std::vector<Settings>& looks, const Settings& settings,
                             std::span<const candidates::Candidate> candidates) {
  constexpr double kNear = 0.1;  // chosen
  const auto is_near = [&](const Setting& look, const Setting& asked) {
    return look.candidate == asked.candidate &&
           std::abs(look.value - asked.value) <= kNear * std::abs(look.value - candidates[look.candidate].present);
  };
  const auto found =
      std::ranges::find_if(looks, [&](const Settings& look) { return std::ranges::equal(look, settings, is_near); });
  return found != looks.end() ? *found : looks.emplace_back(settings);
}

}  // namespace kenaf::gap::diagnose
