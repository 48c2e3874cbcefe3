#include "tools/studies/validation/maxxii.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>
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
  double left_mps, right_mps;            // of the tracks, by their motors
  double slip_left_mps, slip_right_mps;  // measured
  double simulated_left_mps = 0, simulated_right_mps = 0;
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

void simulate(std::vector<State>& states) {
  const physics::RobotDescription robot = physics::load_robot("maxxii");
  for (State& state : states) {
    const SteadyMotion motion = steady_motion(robot, state.left_mps, state.right_mps);
    const double half_turn_mps = motion.turn_radps * robot.track_gauge_m() / 2;
    state.simulated_left_mps = state.left_mps - (motion.forward_mps - half_turn_mps);
    state.simulated_right_mps = state.right_mps - (motion.forward_mps + half_turn_mps);
  }
}

// The part of a slip that the simulation leaves is fitted by least squares: left_share v, right_share v, and growth |v|
// v of both sides.
Eigen::Vector3d fit(const std::vector<State>& states, std::size_t half) {
  Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
  Eigen::Vector3d b = Eigen::Vector3d::Zero();
  const auto add = [&](const Eigen::Vector3d& row, double left_over) {
    A += row * row.transpose();
    b += row * left_over;
  };
  for (std::size_t i = half; i < states.size(); i += 2) {
    const State& s = states[i];
    add({s.left_mps, 0, std::abs(s.left_mps) * s.left_mps}, s.slip_left_mps - s.simulated_left_mps);
    add({0, s.right_mps, std::abs(s.right_mps) * s.right_mps}, s.slip_right_mps - s.simulated_right_mps);
  }
  return A.ldlt().solve(b);
}

std::string kind_of(const State& state) {
  if (state.left_mps == -state.right_mps) return "on the spot";
  if (state.left_mps * state.right_mps < 0) return "tracks against each other";
  const bool right = std::abs(state.right_mps) > std::abs(state.left_mps);
  return fmt::format("curve, {} track faster", right ? "right" : "left");
}

double turning(const State& state, double slip_left_mps, double slip_right_mps) {
  return ((state.right_mps - slip_right_mps) - (state.left_mps - slip_left_mps)) / (state.right_mps - state.left_mps);
}

}  // namespace

SteadyStates compare_steady_states(const std::filesystem::path& table) {
  std::vector<State> states = read_states(table);
  simulate(states);

  // Each half is judged by the fit to the other one.
  SteadyStates result;
  result.count = states.size();
  std::map<std::string, TurningKind> kinds;
  double squares = 0, corrected_squares = 0;
  for (const std::size_t half : {0U, 1U}) {
    const Eigen::Vector3d fitted = fit(states, 1 - half);
    result.left_share += fitted[0] / 2;
    result.right_share += fitted[1] / 2;
    result.growth_spm += fitted[2] / 2;
    for (std::size_t i = half; i < states.size(); i += 2) {
      const State& s = states[i];
      const double left_mps =
          s.simulated_left_mps + fitted[0] * s.left_mps + fitted[2] * std::abs(s.left_mps) * s.left_mps;
      const double right_mps =
          s.simulated_right_mps + fitted[1] * s.right_mps + fitted[2] * std::abs(s.right_mps) * s.right_mps;
      squares +=
          std::pow(s.slip_left_mps - s.simulated_left_mps, 2) + std::pow(s.slip_right_mps - s.simulated_right_mps, 2);
      corrected_squares += std::pow(s.slip_left_mps - left_mps, 2) + std::pow(s.slip_right_mps - right_mps, 2);
      if (s.left_mps == s.right_mps) continue;
      TurningKind& kind = kinds[kind_of(s)];
      const double measured = turning(s, s.slip_left_mps, s.slip_right_mps);
      ++kind.count;
      kind.measured += measured;
      kind.measured_sd += measured * measured;
      kind.simulated += turning(s, s.simulated_left_mps, s.simulated_right_mps);
      kind.corrected += turning(s, left_mps, right_mps);
    }
  }
  const auto slips = static_cast<double>(2 * states.size());
  result.rms_mps = std::sqrt(squares / slips);
  result.corrected_rms_mps = std::sqrt(corrected_squares / slips);

  // Sums become means and a standard deviation.
  for (auto& [name, kind] : kinds) {
    const auto n = static_cast<double>(kind.count);
    kind.name = name;
    kind.measured /= n;
    kind.measured_sd = std::sqrt(std::max(0.0, kind.measured_sd / n - kind.measured * kind.measured));
    kind.simulated /= n;
    kind.corrected /= n;
    result.kinds.push_back(kind);
  }
  return result;
}

}  // namespace kenaf::validation
