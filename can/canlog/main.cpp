// kenaf-canlog: describes a recorded CAN bus, checks it against the standards' rules, and computes statistics.
//
//   kenaf-canlog square.log | less
//   candump -L can0 | kenaf-canlog --figures
//   kenaf-canlog --check --robot kenaf square.log
//   kenaf-canlog eds drive.eds --robot kenaf --node 1
//
// Exit status: 0; 1 if --check found a violation, or an EDS does not fit; 2 for bad input, or if the output cannot be
// written.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <array>
#include <cstdio>
#include <exception>
#include <fstream>
#include <iostream>
#include <set>
#include <stdexcept>
#include <string>
#include <string_view>

#include "can/canlog/describe.hpp"
#include "can/canlog/eds_command.hpp"
#include "can/canlog/figures.hpp"
#include "can/canlog/log.hpp"
#include "can/canlog/print_limit.hpp"
#include "can/canlog/rules.hpp"
#include "command_line/checks.hpp"
#include "command_line/parse.hpp"
#include "formats/settings/nearest_word.hpp"

namespace {

using namespace kenaf;

constexpr int kBroken = 1, kBadInput = 2;

struct Options {
  std::string robot = "kenaf", log = "-", interface;
  double bit_rate = 500'000, sync_window_ms = 0, answer_ms = 0;
  bool check = false, figures = false, all = false;
};

canlog::Log load_log(const Options& options) {
  std::ifstream file;
  if (options.log != "-") {
    file.open(options.log);
    if (!file)
      throw std::runtime_error(options.log + ": cannot be opened" +
                               settings::did_you_mean(options.log, std::array{std::string("eds")}));
  }
  try {
    return canlog::read_log(options.log == "-" ? std::cin : file, options.interface);
  } catch (const std::runtime_error& refused) {
    throw std::runtime_error(options.log + ": " + refused.what());
  }
}

double seconds(canopen::Time time) {
  return std::chrono::duration<double>(time).count();
}

canopen::Time from_ms(double ms) {
  return std::chrono::round<canopen::Time>(std::chrono::duration<double, std::milli>(ms));
}

// Times are relative to the first frame; a log may have none.
void print_words(const canlog::Log& log, const canlog::Network& network) {
  canlog::Describer describer(network);
  for (const canlog::LogFrame& logged : log.frames) {
    if (log.has_times) fmt::print("{:12.6f}  ", seconds(logged.at - log.frames.front().at));
    fmt::print("{}\n", describer.describe(logged));
  }
}

bool print_violations(const Options& options, const canlog::Log& log, const canlog::Network& network) {
  canlog::CheckOptions check;
  if (options.sync_window_ms > 0) check.sync_window = from_ms(options.sync_window_ms);
  if (options.answer_ms > 0) check.sdo_answer = from_ms(options.answer_ms);
  const std::vector<canlog::Violation> found = check_rules(log, network, check);
  std::set<std::string_view> broken;
  canlog::PrintLimit limit(options.all);
  for (const canlog::Violation& one : found) {
    broken.insert(one.rule.name);
    if (!limit.allows(one.rule.name)) continue;
    fmt::print("{}:{}: {:.6f} s: {}: {}\n", options.log, one.line, seconds(one.at - log.frames.front().at),
               one.rule.name, one.words);
  }
  for (const auto& [rule, count] : limit.left_out())
    fmt::print("{}: {}: {} more violations (--all prints each)\n", options.log, rule, count);
  for (const canlog::Rule* rule : canlog::all_rules()) {
    if (broken.contains(rule->name)) fmt::print("rule {} ({}): {}\n", rule->name, rule->source, rule->words);
  }
  fmt::print("{} frames, {} rules, violations: {}\n", log.frames.size(), canlog::all_rules().size(), found.size());
  return found.empty();
}

// The output may have been lost, for example on a full disk.
void finish_output() {
  if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0)
    throw std::runtime_error("standard output cannot be written; is its disk full?");
}

// What a reader must know of the log itself, on standard error.
void print_remarks(const Options& options, const canlog::Log& log) {
  static constexpr std::string_view kUnreadable = "lines that cannot be read", kSteps = "steps of the clock";
  canlog::PrintLimit limit(options.all);
  for (const canlog::BadLine& bad : log.bad_lines) {
    if (limit.allows(kUnreadable)) fmt::print(stderr, "{}:{}: {}\n", options.log, bad.line, bad.words);
  }
  if (!log.has_times) fmt::print(stderr, "{}: the log has no times\n", options.log);
  if (log.summed_times) {
    fmt::print(stderr, "{}: the times are intervals (`candump -td`): they are summed up\n", options.log);
  }
  for (const canlog::ClockStep& step : log.clock_steps) {
    if (!limit.allows(kSteps)) continue;
    fmt::print(stderr, "{}:{}: the recorder's clock steps back by {:.6f} s: the log's time stands still over it\n",
               options.log, step.line, seconds(step.back));
  }
  if (log.other_interfaces > 0) {
    fmt::print(stderr, "{}: {} lines are not from {} and were left out (--interface chooses another)\n", options.log,
               log.other_interfaces, log.interface);
  }
  for (const auto& [kind, count] : limit.left_out())
    fmt::print(stderr, "{}: {} more {} (--all prints each)\n", options.log, count, kind);
}

int run(const Options& options) {
  const canlog::Network network(canbus::load_robot_bus(options.robot));
  const canlog::Log log = load_log(options);
  print_remarks(options, log);
  if (log.frames.empty()) throw std::runtime_error(options.log + ": contains no frame; is it a log of a CAN bus?");
  if (!options.check && !options.figures) print_words(log, network);
  if (options.figures) fmt::print("{}", to_text(figures_of(log, network), options.bit_rate));
  const bool broken = options.check && !print_violations(options, log, network);
  finish_output();
  return broken ? kBroken : 0;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app("Decodes a CAN bus log, checks it against the rules of CANopen and reports statistics.", "kenaf-canlog");
  app.add_option("LOG", options.log, "a log of candump, PCAN-View, CANoe or python-can; - is standard input")
      ->capture_default_str();
  app.add_option("--robot", options.robot, "the robot description with the devices on the bus, a name or a TOML file")
      ->capture_default_str();
  app.add_option("--interface", options.interface,
                 "read only the lines of this interface (default: that of the first line)");
  app.add_flag("--check", options.check, "lists every violation; exit status 1 if there is one");
  app.add_option("--sync-window", options.sync_window_ms,
                 "--check: ms after SYNC in which nodes must answer (default: object 0x1007 as it was written)")
      ->check(command_line::number_in(1e-3, 1e6));
  app.add_option("--answer", options.answer_ms,
                 "--check: ms in which SDO requests must be answered (default: the description's answer_s)")
      ->check(command_line::number_in(1e-3, 1e6));
  app.add_flag("--all", options.all, "prints every error, not 20 of a kind at most");
  app.add_flag("--figures", options.figures, "load, SYNC's jitter, times of answers and commands");
  app.add_option("--bitrate", options.bit_rate, "--figures: of the bus, in bit/s")
      ->check(command_line::number_in(10'000, 1'000'000))
      ->capture_default_str();
  canlog::EdsOptions eds_options;
  CLI::App* eds = app.add_subcommand(
      "eds", "prints a drive's electronic data sheet (EDS or DCF, CiA 306) and compares it with what the library does");
  eds->add_option("FILE", eds_options.file, "an EDS or DCF file")->required();
  eds->add_option(
      "--robot", eds_options.robot,
      "compare with the drives of this robot, a name or a TOML file; exit status 1 if something does not fit");
  eds->add_option("--node", eds_options.node, "of these, only the drive with this node number; also for $NODEID")
      ->check(command_line::whole_number(1, 127));
  eds->add_option("--period", eds_options.period_s, "the library's period_s, in seconds")
      ->check(command_line::number_in(0.001, 0.02))
      ->capture_default_str();
  if (const auto status = command_line::parse(app, argc, argv)) return *status;
  try {
    if (*eds) {
      const bool fits = canlog::print_eds(eds_options);
      finish_output();
      return fits ? 0 : kBroken;
    }
    return run(options);
  } catch (const std::exception& error) {
    // not fmt::print, which throws if standard error is on the full disk too
    std::fprintf(stderr, "kenaf-canlog: %s\n", error.what());
    return kBadInput;
  }
}
