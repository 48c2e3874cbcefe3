// Any text is a file of own effects or is refused with a DescriptionError; what is accepted moves nothing at neutral,
// and makes a robot that can be written and read at both ends of its range.
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

#include "gap/candidates/own_effects.hpp"
#include "gap/candidates/robot_numbers.hpp"
#include "gap/candidates/write_candidates.hpp"

using namespace kenaf;

namespace {

const std::string kRobot = R"(
usarsim_class = "USARBot.Short"
[body]
mass_kg = 15.0
size_m = [0.44, 0.10, 0.16]
center_of_mass_m = [0.0, 0.0, -0.05]
inertia_kgm2 = [0.13, 0.44, 0.52]
friction = 0.5
[track]
length_m = 0.58
end_radius_m = 0.065
width_m = 0.09
left_center_m = [0.0, 0.10, -0.025]
friction_along = 1.3
friction_across = 0.9
pieces = 6
[drive]
sprocket_radius_m = 0.065
max_speed_mps = 0.5
max_force_n = 300.0
time_constant_s = 0.05
moving_mass_kg = 1.5
encoder_counts_per_radian = 318.0
amperes_per_newton = 0.04
idle_amperes = 0.3
[flipper]
mass_kg = 1.25
length_m = 0.145
pivot_radius_m = 0.055
tip_radius_m = 0.04
width_m = 0.045
front_left_pivot_m = [0.225, 0.17, -0.025]
friction_along = 1.3
friction_across = 0.9
min_angle_rad = -3.0
max_angle_rad = 3.0
start_angle_rad = 1.0
belt_driven = true
[servo]
max_speed_radps = 1.5
max_torque_nm = 20.0
amperes_per_nm = 0.25
[battery]
open_circuit_v = 25.9
internal_resistance_ohm = 0.1
capacity_s = 3600.0
[[sensor]]
type = "INS"
name = "INS"
)";

void check(const gap::candidates::Candidate& candidate, const physics::RobotDescription& robot) {
  if (!(candidate.min <= candidate.neutral && candidate.neutral <= candidate.max && candidate.min < candidate.max))
    __builtin_trap();
  const std::pair<gap::candidates::Candidate, double> at_neutral{candidate, candidate.neutral};
  if (gap::candidates::robot_toml_with(kRobot, {&at_neutral, 1}) != kRobot) __builtin_trap();
  for (const double end : {candidate.min, candidate.max}) {
    physics::RobotDescription varied = robot;
    candidate.set(varied, end);
    if (!gap::candidates::why_impossible(varied).empty()) __builtin_trap();
    const std::pair<gap::candidates::Candidate, double> at_end{candidate, end};
    const physics::RobotDescription read =
        physics::parse_robot(gap::candidates::robot_toml_with(kRobot, {&at_end, 1}), "fuzz.toml");
    for (const gap::candidates::RobotNumber& number : gap::candidates::robot_numbers(robot))
      if (number.get(read) != number.get(varied)) __builtin_trap();
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const physics::RobotDescription robot = physics::parse_robot(kRobot, "fuzz.toml");
  std::vector<gap::candidates::Candidate> candidates;
  try {
    candidates = gap::candidates::parse_own_effects({reinterpret_cast<const char*>(data), size}, "fuzz.toml", robot);
  } catch (const description::DescriptionError&) {
    return 0;
  }
  for (const gap::candidates::Candidate& candidate : candidates) check(candidate, robot);
  return 0;
}
