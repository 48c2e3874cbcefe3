// The control process on the robot's PC: receives the operator's wishes from the network and drives the robot through
// hrt.h. Linked twice: operator_control_sim drives the simulation, operator_control_real the robot. docs/operator.md
// describes its start and behaviour.
#include <fmt/format.h>
#include <kenaf/hrt.h>
#include <poll.h>
#include <signal.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

#include "command_line/checks.hpp"
#include "command_line/parse.hpp"
#include "driving.hpp"
#include "formats/protocol/log_limiter.hpp"
#include "formats/runs/port_file.hpp"
#include "link.hpp"
#include "robot.hpp"
#include "seat.hpp"
#include "udp.hpp"

namespace {

using namespace kenaf::teleop;
using kenaf::command_line::number_in;
using kenaf::command_line::readable_by;

constexpr int kTurn_ms = 10;  // loop period: one cycle of the robot
constexpr double kStatusPeriod_s = 0.05;
constexpr int kDatagramsInATurn = 100;  // a flood must not hold up the robot

struct Options {
  std::string listen = "127.0.0.1:45460", port_file;
  DrivingLimits limits;
  double takeover_s = 2;
};

volatile sig_atomic_t stop_requested = 0;

void on_signal(int) {
  stop_requested = 1;
}

double now_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

class Control {
 public:
  Control(const Options& options, const hrt_config& config)
      : options_(options), socket_(UdpSocket::bound_to(resolve_listener(options.listen))), robot_(config) {}

  std::uint16_t port() const { return socket_.port(); }

  void run() {
    while (stop_requested == 0) {
      pollfd watched{socket_.descriptor(), POLLIN, 0};
      ::poll(&watched, 1, kTurn_ms);
      const bool emergency_pressed = take_datagrams();
      turn(emergency_pressed);
      if (seat_.session != 0 && now_s() - status_sent_s_ >= kStatusPeriod_s) send_status();
    }
  }

 private:
  // Returns true if an emergency stop is among them.
  bool take_datagrams() {
    bool emergency_pressed = false;
    std::array<std::byte, kMaxDatagramBytes + 1> buffer;  // one more than the largest datagram, to detect longer ones
    Peer from;
    for (int i = 0; i < kDatagramsInATurn; ++i) {
      const std::optional<std::size_t> size = socket_.receive(buffer, from);
      if (!size) break;
      Datagram datagram = Bye{};
      const kenaf::protocol::DecodeError error = decode(std::span(buffer).first(*size), datagram);
      if (error != kenaf::protocol::DecodeError::none) {
        log_seldom(fmt::format("{} from {}: ignored", describe(error), to_text(from)));
      } else if (const Wish* wish = std::get_if<Wish>(&datagram)) {
        emergency_pressed |= take_wish(*wish, from);
      } else if (const Bye* bye = std::get_if<Bye>(&datagram)) {
        if (bye->session == seat_.session) log("the console has left");
        leave(seat_, bye->session);
      }
    }
    return emergency_pressed;
  }

  bool take_wish(const Wish& wish, const Peer& from) {
    const std::uint64_t session_before = seat_.session;
    const Admission admission = admit(seat_, wish, now_s(), options_.takeover_s);
    if (admission == Admission::taken) {
      const std::string words = fmt::format("the console at {} has the robot, heard {:.1f} s ago", to_text(console_),
                                            now_s() - seat_.heard_s);
      log_seldom(fmt::format("console at {}: {}", to_text(from), words));
      if (now_s() - taken_sent_s_ >= kStatusPeriod_s) {  // do not answer a flood by a flood
        taken_sent_s_ = now_s();
        send(Taken{wish.session, text_of(words)}, from);
      }
    } else if (admission == Admission::newest) {
      console_ = from;  // its address may have changed
      if (seat_.session != session_before) log(fmt::format("the console at {} has the robot", to_text(from)));
    }
    return wish.emergency_stop && admission != Admission::old;
  }

  void turn(bool emergency_pressed) {
    const double before_s = state_.time_s;
    const std::string message_before = robot_.message();
    const bool is_open = robot_.look(state_);
    const double dt_s = std::clamp(state_.time_s - before_s, 0.0, 0.1);
    const auto [mode_before, halt_before] = std::pair(driving_.mode, driving_.halt);
    const Order order =
        decide(driving_, {seat_, emergency_pressed, is_open, now_s(), dt_s, view_age_s()}, options_.limits);
    if (is_open) robot_.carry_out(order);
    if (robot_.message() != message_before) log(robot_.message());
    if (driving_.mode == Mode::halted && (mode_before != Mode::halted || halt_before != driving_.halt)) {
      log(fmt::format("halted: {}", name_of(driving_.halt)));
    }
    if (driving_.mode == Mode::emergency_stop && mode_before != Mode::emergency_stop) log("emergency stop");
  }

  // Returns the age of the operator's view when he made his newest wish.
  double view_age_s() const {
    const std::uint32_t seen = seat_.wish ? seat_.wish->newest_status : 0;
    const bool is_known = seen != 0 && seen <= status_sequence_ && status_sequence_ - seen < status_sent_at_s_.size();
    return is_known ? now_s() - status_sent_at_s_[seen % status_sent_at_s_.size()]
                    : std::numeric_limits<double>::infinity();
  }

  void send_status() {
    // Addressee, and the wishes received: from these the console computes loss and delay of the link.
    status_sent_s_ = now_s();
    Status status{};
    status.session = seat_.session;
    status.sequence = ++status_sequence_;
    status_sent_at_s_[status.sequence % status_sent_at_s_.size()] = status_sent_s_;
    status.newest_wish = seat_.wish ? seat_.wish->sequence : 0;
    status.wish_age_s = now_s() - seat_.heard_s;
    status.wishes_received = seat_.received;

    // The decisions of this turn.
    status.mode = driving_.mode;
    status.halt = driving_.halt;
    status.flipper_order = driving_.flipper_order;

    // The robot's measurements, commands in force, and health of its own link.
    const auto flag = [&](std::uint32_t bit, bool set) { status.flags |= set ? bit : 0; };
    flag(kSimulated, std::string_view(hrt_library()) == "sim");
    flag(kPaused, (state_.activity & HRT_PAUSED) != 0);
    flag(kStoppedBySilence, (state_.activity & HRT_STOPPED_BY_SILENCE) != 0);
    flag(kRecording, (state_.activity & HRT_RECORDING) != 0);
    flag(kDegraded, (state_.activity & HRT_DEGRADED) != 0);
    status.fields = state_.valid;
    status.robot_time_s = state_.time_s;
    status.posture_deg = {state_.roll_deg, state_.pitch_deg, state_.yaw_deg};
    std::ranges::copy(state_.track_mmps, status.track_mmps.begin());
    std::ranges::copy(state_.commanded_track_mmps, status.commanded_track_mmps.begin());
    std::ranges::copy(state_.track_a, status.track_a.begin());
    std::ranges::copy(state_.flipper_deg, status.flipper_deg.begin());
    status.flippers_commanded = static_cast<std::uint8_t>(state_.flippers_commanded);
    std::ranges::copy(state_.commanded_flipper_deg, status.commanded_flipper_deg.begin());
    std::ranges::copy(state_.flipper_a, status.flipper_a.begin());
    status.battery_v = state_.battery_v;
    status.odometry = {state_.odometry_x_mm, state_.odometry_y_mm, state_.odometry_yaw_deg};
    status.pose_mm = {state_.pose_x_mm, state_.pose_y_mm, state_.pose_z_mm};
    status.robot_round_trip_ms = state_.round_trip_ms;
    status.late_cycles = static_cast<std::uint32_t>(state_.late_cycles);

    // Texts: this process' newest message, and the robot's warning.
    status.message = text_of(robot_.message());
    std::array<char, kMaxTextBytes> warning{};
    if (driving_.mode != Mode::no_robot) (void)hrt_get_warning(warning.data(), warning.size());
    status.warning = text_of(warning.data());
    send(status, console_);
  }

  void send(const Datagram& datagram, const Peer& to) const {
    std::array<std::byte, kMaxDatagramBytes> buffer;
    socket_.send(std::span(buffer).first(encode(datagram, buffer)), to);
  }

  static void log(const std::string& line) { fmt::print(stderr, "operator_control: {}\n", line); }
  void log_seldom(const std::string& line) {
    if (log_limiter_.allow()) log(line);
  }

  const Options options_;
  UdpSocket socket_;
  Robot robot_;
  hrt_state state_ = hrt_state_init();
  Seat seat_;
  Driving driving_;
  Peer console_;
  std::uint32_t status_sequence_ = 0;  // shared by all consoles: one that returns drops older ones than it has seen
  std::array<double, 256> status_sent_at_s_{};  // indexed by the sequence's last byte: 12 s of statuses
  double status_sent_s_ = 0, taken_sent_s_ = 0;
  kenaf::protocol::LogLimiter log_limiter_;  // of all lines that the network causes
};

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app(
      "Drives the robot by the commands of the operator's console. kenaf.toml and the KENAF_... variables choose the "
      "robot.",
      "operator_control");
  app.add_option("--listen", options.listen, "address to listen on, ADDR:PORT; port 0: any free one")
      ->check(readable_by(require_host_port))
      ->capture_default_str();
  app.add_option("--port-file", options.port_file, "write the port into this file");
  app.add_option("--silence", options.limits.silence_s, "seconds of silence of the console after which the robot halts")
      ->check(number_in(0.1, 10.0))
      ->capture_default_str();
  app.add_option("--view", options.limits.view_s, "seconds; a command based on an older view of the robot halts it")
      ->check(number_in(0.2, 60.0))
      ->capture_default_str();
  app.add_option("--takeover", options.takeover_s, "seconds of silence after which another console may have the robot")
      ->check(number_in(0.1, 3600.0))
      ->capture_default_str();
  app.add_option("--max-speed", options.limits.max_track_mmps, "of the tracks, mm/s")
      ->check(number_in(1.0, kMaxTrack_mmps))
      ->capture_default_str();
  app.add_option("--speed-up", options.limits.speed_up_mmps2, "ramp of the tracks, mm/s^2")
      ->check(number_in(10.0, 1e5))
      ->capture_default_str();
  app.add_option("--slow-down", options.limits.slow_down_mmps2, "ramp of the tracks, mm/s^2")
      ->check(number_in(10.0, 1e5))
      ->capture_default_str();
  if (const auto status = kenaf::command_line::parse(app, argc, argv)) return *status;
  hrt_config config = hrt_config_default();
  if (hrt_config_load(&config) != HRT_OK) return kenaf::command_line::wrong_use(app, hrt_last_error());

  // A signal only ends the loop: the robot is then stopped and closed as usual.
  struct sigaction action {};
  action.sa_handler = on_signal;
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);

  try {
    Control control(options, config);
    fmt::print(stderr, "operator_control: {} library, listening on port {}\n", hrt_library(), control.port());
    if (!options.port_file.empty()) kenaf::runs::write_port_file(options.port_file, control.port());
    control.run();
    return 0;
  } catch (const std::exception& error) {
    fmt::print(stderr, "operator_control: {}\n", error.what());
    return 1;
  }
}
