#include "gap/challenge/background.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <stdexcept>

#include "gap/candidates/candidate.hpp"
#include "gap/candidates/robot_numbers.hpp"
#include "gap/random_numbers.hpp"

namespace kenaf::gap::challenge {
namespace {

// Nearly every draw is a valid robot; so many invalid ones in a row would be a fault of this program.
constexpr int kDraws = 20;

// track.contact_length_m moves what track.length_m does; one of them is enough.
bool is_derived(const candidates::Candidate& number) {
  return number.same_as.starts_with("track.");
}

physics::RobotDescription moved(physics::RobotDescription robot, const Background& background) {
  for (const BackgroundNumber& number : background.numbers) {
    const std::optional<candidates::RobotNumber> found = candidates::find_robot_number(robot, number.key);
    if (!found) throw std::runtime_error(fmt::format("the robot's description has no {}", number.key));
    found->set(robot, number.value);
  }
  return robot;
}

}  // namespace

Background draw_background(const physics::RobotDescription& robot, std::uint64_t seed,
                           std::span<const std::string> without) {
  const std::vector<candidates::Candidate> candidates = candidates::description_candidates(robot);
  Random random(seed);
  for (int draw = 0; draw < kDraws; ++draw) {
    Background background;
    for (const candidates::Candidate& number : candidates) {
      if (is_derived(number)) continue;
      const double part = uniform(random, -kBackgroundOff, kBackgroundOff);
      // Drawn for all numbers, so that those in `without` do not change the others.
      if (std::ranges::count(without, number.name) > 0) continue;
      const double value = number.present + part * number.whole;
      background.numbers.push_back({number.name, std::clamp(value, number.min, number.max)});
    }
    if (candidates::why_impossible(moved(robot, background)).empty()) return background;
  }
  throw std::logic_error("no background was found within the limits of this robot's description");
}

physics::RobotDescription with_background(physics::RobotDescription robot, const Background& background) {
  robot = moved(std::move(robot), background);
  if (const std::string why = candidates::why_impossible(robot); !why.empty())
    throw std::runtime_error(fmt::format("the background makes an invalid robot: {}", why));
  return robot;
}

}  // namespace kenaf::gap::challenge
