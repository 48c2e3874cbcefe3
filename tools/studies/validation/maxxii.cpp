#include "tools/studies/validation/maxxii.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <sstream>

#include "formats/runs/csv_cells.hpp"
#include "formats/runs/run_file.hpp"
#include "formats/runs/whole_file.hpp"
#include "tools/studies/validation/steady_motion.hpp"

namespace kenaf::validation {
namespace {

constexpr double kGear = 34.45, kSprocket_m = 0.0856;  // of the motors' gears; of the tracks

struct State {
  double left_mps, right_mps;                              // of the tracks, by their motors
  double slip_left_mps, slip_right_mps;                    // measured
  std::array<double, 2> simulated_mps{}, corrected_mps{};  // slips: by the description; with the asymmetry
};

std::vector<State> read_states(const std::filesystem::path& table) {
  std::istringstream text(runs::read_whole_file(table));
  std::string line;
  std::vector<runs::CsvCell> cells;
  const auto fail = [&](const std::string& what) {
    throw runs::RunFileError(fmt::format("{}: {}", table.string(), what));
  };

  // The four columns by their names.
  std::getline(text, line);
  runs::split_cells(line, ',', cells);
  std::array<std::size_t, 4> columns{};
  constexpr std::array<std::string_view, 4> kNames{"motor_left_radps", "motor_right_radps", "slip_left_mps",
                                                   "slip_right_mps"};
  for (std::size_t i = 0; i < kNames.size(); ++i) {
    const auto found = std::ranges::find(cells, kNames[i], &runs::CsvCell::text);
    if (found == cells.end()) fail(fmt::format("has no column {}", kNames[i]));
    columns[i] = static_cast<std::size_t>(found - cells.begin());
  }

  std::vector<State> states;
  runs::DecimalNumbers numbers;
  for (std::size_t number = 2; std::getline(text, line); ++number) {
    runs::split_cells(line, ',', cells);
    std::array<double, 4> values{};
    for (std::size_t i = 0; i < columns.size(); ++i) {
      const auto value = columns[i] < cells.size() ? numbers.read(cells[columns[i]].text) : std::nullopt;
      if (!value) fail(fmt::format("line {}: {} is no number", number, kNames[i]));
      values[i] = *value;
    }
    constexpr double kMetresPerRadian = kSprocket_m / kGear;
    states.push_back({kMetresPerRadian * values[0], kMetresPerRadian * values[1], values[2], values[3]});
  }
  return states;
}

// Slips of the simulated robot in the same state, left and right.
std::array<double, 2> simulated_slips_mps(const physics::RobotDescription& robot, const State& state) {
  const SteadyMotion motion = steady_motion(robot, state.left_mps, state.right_mps);
  const double half_turn_mps = motion.turn_radps * robot.track_gauge_m() / 2;
  return {state.left_mps - (motion.forward_mps - half_turn_mps),
          state.right_mps - (motion.forward_mps + half_turn_mps)};
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

// What the simulation leaves of the slips' difference, right less left.
double left_over_mps(const State& s, const std::array<double, 2>& simulated_mps) {
  return (s.slip_right_mps - simulated_mps[1]) - (s.slip_left_mps - simulated_mps[0]);
}

// The drive asymmetry that leaves the least sum of absolute differences over every second state: with an asymmetry a
// the left track runs a / 2 faster and the right one as much slower than their motors say, which adds a times the mean
// speed to the difference. Absolute values, because motors that did not follow their commands make some states outliers
// of ten times the rest. The least sum of |y - a x| is at the median of y / x, weighted by |x|.
double drive_asymmetry_of(const std::vector<State>& states, std::size_t half) {
  std::vector<std::pair<double, double>> ratios;  // y / x and |x|
  double all = 0;
  for (std::size_t i = half; i < states.size(); i += 2) {
    const double mean_mps = (states[i].left_mps + states[i].right_mps) / 2;
    if (mean_mps == 0) continue;
    ratios.emplace_back(left_over_mps(states[i], states[i].simulated_mps) / mean_mps, std::abs(mean_mps));
    all += std::abs(mean_mps);
  }
  std::ranges::sort(ratios);
  double below = 0;
  for (const auto& [ratio, weight] : ratios)
    if ((below += weight) >= all / 2) return ratio;
  return 0;
}

std::string kind_of(const State& state) {
  if (state.left_mps == -state.right_mps) return "on the spot";
  if (state.left_mps * state.right_mps < 0) return "tracks against each other";
  const bool right = std::abs(state.right_mps) > std::abs(state.left_mps);
  return fmt::format("curve, {} track faster", right ? "right" : "left");
}

std::string class_of(const State& state) {
  const double difference_mps = std::abs(state.right_mps - state.left_mps);
  for (const double limit_mps : {0.1, 0.2, 0.4})
    if (difference_mps <= limit_mps) return fmt::format("tracks differ by up to {:.1f} m/s", limit_mps);
  return "tracks differ by more";
}

double turning(const State& state, const std::array<double, 2>& slips_mps) {
  return ((state.right_mps - slips_mps[1]) - (state.left_mps - slips_mps[0])) / (state.right_mps - state.left_mps);
}

TurningKind turning_kind(const std::string& name, const std::vector<const State*>& states) {
  const auto median_turning = [&](const auto& slips_of) {
    std::vector<double> values;
    for (const State* state : states) values.push_back(turning(*state, slips_of(*state)));
    return median(std::move(values));
  };
  const auto measured_slips = [](const State& s) { return std::array{s.slip_left_mps, s.slip_right_mps}; };
  const double measured = median_turning(measured_slips);
  std::vector<double> distances;
  for (const State* state : states) distances.push_back(std::abs(turning(*state, measured_slips(*state)) - measured));
  return {name,
          states.size(),
          measured,
          median(std::move(distances)),
          median_turning([](const State& s) { return s.simulated_mps; }),
          median_turning([](const State& s) { return s.corrected_mps; })};
}

}  // namespace

SteadyStates compare_steady_states(const std::filesystem::path& table) {
  std::vector<State> states = read_states(table);
  const physics::RobotDescription robot = physics::load_robot("maxxii");
  for (State& state : states) state.simulated_mps = simulated_slips_mps(robot, state);

  // Each half is judged by the fit to the other one.
  SteadyStates result;
  result.count = states.size();
  std::vector<double> before_mps, after_mps;
  for (const std::size_t half : {0U, 1U}) {
    physics::RobotDescription corrected = robot;
    corrected.effects.drive_asymmetry = drive_asymmetry_of(states, 1 - half);
    result.drive_asymmetry += corrected.effects.drive_asymmetry / 2;
    for (std::size_t i = half; i < states.size(); i += 2) {
      State& state = states[i];
      state.corrected_mps = simulated_slips_mps(corrected, state);
      before_mps.push_back(std::abs(left_over_mps(state, state.simulated_mps)));
      after_mps.push_back(std::abs(left_over_mps(state, state.corrected_mps)));
    }
  }
  result.median_mps = median(before_mps);
  result.corrected_median_mps = median(after_mps);

  // By the kind of turn, and by how fast it is.
  std::map<std::string, std::vector<const State*>> kinds, classes;
  for (const State& state : states) {
    if (state.left_mps == state.right_mps) continue;
    kinds[kind_of(state)].push_back(&state);
    classes[class_of(state)].push_back(&state);
  }
  for (const auto* groups : {&kinds, &classes})
    for (const auto& [name, members] : *groups) result.kinds.push_back(turning_kind(name, members));
  return result;
}

}  // namespace kenaf::validation
