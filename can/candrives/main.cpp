// kenaf-candrives: drives, inclinometer and gyro of a robot as CANopen slaves on a CAN interface.
#include <signal.h>

#include <CLI/CLI.hpp>
#include <atomic>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "can/canbus/socket_bus.hpp"
#include "can/candrives/motors.hpp"
#include "can/candrives/service.hpp"
#include "command_line/checks.hpp"
#include "command_line/parse.hpp"
#include "formats/description/description_file.hpp"

namespace {

using namespace kenaf;

std::atomic<bool> stop_asked{false};

void on_signal(int) {
  stop_asked = true;
}

void stop_on_signals() {
  struct sigaction action {};
  action.sa_handler = on_signal;
  sigaction(SIGTERM, &action, nullptr);
  sigaction(SIGINT, &action, nullptr);
  // in the background of a terminal there is no input, which must not stop the program
  signal(SIGTTIN, SIG_IGN);
}

struct Options {
  std::string interface;
  candrives::MotorOptions motors;
  std::vector<std::string> faults;
};

constexpr const char* kFaultHelp =
    R"(A fault, now or later, any number of times; standard input takes the same, a line each:
  WHO WHAT [at SECONDS | SECONDS after motion] [for SECONDS]
WHO:  node NUMBER, track left, flipper front left, ..., inclinometer, gyro, all, bus
WHAT: silent, power loss, fault CODE, following error, deaf, no heartbeat watch, no event timer, sdo abort,
      sdo late, sdo wrong toggle, sdo garbage, short pdos, garbage, healed; quirks of some drives: slow boot,
      node guarding only, count first, fixed mapping, first rpdo fixed, slow commands, mode locked,
      halt blocks mode, old target, slow fault reset, velocity unsigned, velocity 16 bits, position 16 bits,
      position 24 bits, no current, no voltage, home offset negative, missing commands fault
As: --fault "node 3 silent at 5" --fault "track left fault 0x2310 0.5 after motion")";

std::optional<Options> read_options(int argc, char** argv, int& exit_status) {
  Options options;
  CLI::App app(
      "The drives, inclinometer and gyro of a robot as CANopen slaves (CiA 402, CiA 410) on a CAN interface.\n"
      "Their motors turn the tracks and flippers of a simulated robot. See docs/can-tools.md.",
      "kenaf-candrives");
  app.add_option("--interface", options.interface, "CAN interface (default: the one in the robot's description)");
  app.add_option("--robot", options.motors.robot, "Robot: a shipped name or a TOML file with a [can] table")
      ->capture_default_str()
      ->check(command_line::readable_by(
          [](const std::string& text) { description::require_description("robot", text, ".toml"); }));
  candrives::add_motor_options(app, options.motors);
  app.add_option("--fault", options.faults, kFaultHelp)->take_all();
  if (const auto status = command_line::parse(app, argc, argv)) {
    exit_status = *status;
    return std::nullopt;
  }
  return options;
}

void run(const Options& options) {
  // Read everything that may be wrong before touching the bus.
  const canbus::RobotBus bus = canbus::load_robot_bus(options.motors.robot);
  const std::string interface = options.interface.empty() ? bus.interface : options.interface;
  std::vector<candrives::PlannedFault> faults;
  for (const std::string& words : options.faults) faults.push_back(candrives::parse_fault(words, bus));

  const candrives::Motors motors = candrives::make_motors(options.motors, bus);

  // Serve the bus until a signal. The service reopens the socket as the interface comes and goes.
  candrives::Service service(bus, *motors.plant, interface + ": " + motors.in_words);
  for (const auto& fault : faults) service.plan(fault);
  service.run([&] { return std::make_unique<canbus::SocketBus>(interface); }, stop_asked);
}

}  // namespace

int main(int argc, char** argv) {
  int exit_status = 0;
  const auto options = read_options(argc, argv, exit_status);
  if (!options) return exit_status;
  stop_on_signals();
  try {
    run(*options);
    return 0;
  } catch (const std::exception& error) {
    std::cerr << "kenaf-candrives: " << error.what() << '\n';
    return 1;
  }
}
