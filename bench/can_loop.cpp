// The control loop of libkenaf_real on a bus: regularity of its cycles, answer time of the nodes, and the number of
// late and lost cycles.
//
//   scripts/with-vcan.sh build/release/bin/can_loop [--interface vcan0] [--cycles 1000] [--period 0.01] [--robot kenaf]
//
// Starts kenaf-candrives with ideal motors on the interface (--no-drives: they are there), opens the robot, commands
// both tracks in each cycle, and prints by wall clock: the time between two cycles as the program sees them, and from
// SYNC to the last node's answer. No limit: the figures depend on the machine.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "command_line/checks.hpp"
#include "command_line/parse.hpp"
#include "kenaf/hrt.h"
#include "tests/support/process.hpp"

namespace {

using Clock = std::chrono::steady_clock;

double at_share(std::vector<double> values, double share) {
  std::ranges::sort(values);
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

void print(const char* what, const std::vector<double>& values_ms) {
  fmt::print("{:<44} {:9.3f} {:9.3f} {:9.3f} ms\n", what, at_share(values_ms, 0.5), at_share(values_ms, 0.99),
             at_share(values_ms, 1));
}

int fail(const char* what, int code) {
  fmt::print(stderr, "can_loop: {}: {}: {}\n", what, hrt_error_name(code), hrt_last_error());
  return 1;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Jitter of libkenaf_real's cycles on a CAN bus", "can_loop"};
  std::string interface = "vcan0";
  int cycles = 1000;
  double period_s = 0.01;
  std::string robot = "kenaf";
  bool no_drives = false;
  app.add_option("--interface", interface)->capture_default_str();
  app.add_option("--cycles", cycles)->capture_default_str()->check(kenaf::command_line::whole_number(10, 1'000'000));
  app.add_option("--period", period_s)->capture_default_str()->check(kenaf::command_line::number_in(0.001, 1));
  app.add_option("--robot", robot)->capture_default_str();
  app.add_flag("--no-drives", no_drives);
  if (const auto status = kenaf::command_line::parse(app, argc, argv)) return *status;

  // The drives on the bus, and the robot that runs on them.
  const kenaf::support::TemporaryFolder folder;
  std::optional<kenaf::support::Process> drives;
  if (!no_drives)
    drives.emplace(std::vector<std::string>{std::string(KENAF_BIN_DIR) + "/kenaf-candrives", "--interface", interface,
                                            "--robot", robot, "--ideal"},
                   folder.path() / "drives.log");
  hrt_config config = hrt_config_default();
  config.period_s = period_s;
  interface.copy(config.can_interface, sizeof config.can_interface - 1);
  robot.copy(config.robot, sizeof config.robot - 1);
  config.robot[std::min(robot.size(), sizeof config.robot - 1)] = '\0';
  if (const int code = hrt_kenaf_init_with(&config); code != HRT_OK) return fail("init", code);

  std::array<char, 2000> setup{};
  if (const int code = hrt_get_setup(setup.data(), setup.size()); code != HRT_OK) return fail("get_setup", code);
  const std::string_view lines = setup.data();
  fmt::print("{}\n", lines.substr(lines.rfind('\n') + 1));  // the last one is of real time

  // Cycles with a command each. The deviation from the period is of two returns of hrt_wait_cycle(); counters of late
  // and lost cycles are taken from the first one on.
  std::vector<double> irregular_ms, answer_ms;
  hrt_state state = hrt_state_init();
  if (const int code = hrt_wait_cycle(&state); code != HRT_OK) return fail("wait_cycle", code);
  const hrt_state first = state;
  Clock::time_point before{};
  for (int i = 0; i < cycles; ++i) {
    if (int code = hrt_set_tracks(100, 100); code != HRT_OK) return fail("set_tracks", code);
    if (int code = hrt_wait_cycle(&state); code != HRT_OK) return fail("wait_cycle", code);
    const Clock::time_point now = Clock::now();
    if (i > 0) irregular_ms.push_back(1e3 * std::abs(std::chrono::duration<double>(now - before).count() - period_s));
    before = now;
    answer_ms.push_back(state.round_trip_ms);
  }

  // Median, 99 % and maximum of both times.
  hrt_close();
  fmt::print("{} cycles of {:g} ms on {}{:>17} {:>9} {:>9}\n", cycles, 1e3 * period_s, interface, "median", "99 %",
             "max");
  print("a cycle is longer or shorter than it should by", irregular_ms);
  print("from SYNC to the last node's answer", answer_ms);
  fmt::print("late answers: {}, lost cycles: {}\n", state.late_cycles - first.late_cycles,
             state.lost_cycles - first.lost_cycles);
}
