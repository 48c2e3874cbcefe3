// The operator's console on the control PC: keyboard and gamepad in, wishes out, the robot's status on a screen. It
// knows only the control process and no robot: the same console drives simulation and robot. docs/operator.md.
#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <array>
#include <chrono>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <memory>
#include <optional>
#include <random>
#include <stdexcept>
#include <string>

#include "command_line/checks.hpp"
#include "command_line/parse.hpp"
#include "desk.hpp"
#include "gamepad.hpp"
#include "link.hpp"
#include "link_health.hpp"
#include "screen.hpp"
#include "script.hpp"
#include "terminal.hpp"
#include "udp.hpp"

namespace {

using namespace kenaf::teleop;
using kenaf::command_line::number_in;

constexpr double kWishPeriod_s = 0.05;
constexpr double kScreenPeriod_s = 0.1;
constexpr double kPlainPeriod_s = 1;
constexpr int kTurn_ms = 10;
constexpr double kTakenShown_s = 1;

struct Options {
  std::string control = "127.0.0.1:45460", script, gamepad, camera;
  bool plain = false;
  double speed_mmps = 200;
  KeyTiming keys;
};

volatile sig_atomic_t stop_requested = 0;

void on_signal(int) {
  stop_requested = 1;
}

double now_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

std::uint64_t random_session() {
  std::random_device device;
  const std::uint64_t session = std::uint64_t{device()} << 32 | device();
  return session == 0 ? 1 : session;
}

class Console {
 public:
  explicit Console(const Options& options)
      : options_(options),
        socket_(UdpSocket::connected_to(resolve(options.control))),
        gamepad_(options.gamepad),
        desk_(options.keys, options.speed_mmps) {
    if (!options.script.empty()) player_.emplace(script_of(options.script));
    if (!options.plain && !player_) terminal_ = std::make_unique<Terminal>();
  }
  // Whatever the reason for the end: the robot stops at once, not only after the silence.
  ~Console() {
    for (int i = 0; i < 3; ++i) send(Bye{session_});
  }

  // Returns the exit status.
  int run() {
    // Each turn waits for a datagram or a key, 10 ms at most (kTurn_ms), then handles all inputs.
    while (stop_requested == 0 && !desk_.wants_to_quit()) {
      wait();
      take_statuses();

      // Input: the gamepad always, the keys of the terminal or the script in their place.
      for (const Action action : gamepad_.read(now_s())) act(action);
      if (terminal_) {
        while (const auto key = terminal_->key()) {
          if (const auto action = action_of_key(*key)) act(*action);
        }
      }
      if (player_) {
        const Player::Turn turn = player_->turn(now_s(), newest(), health_.silence_s(now_s()).value_or(0), desk_);
        for (const Action action : turn.pressed) act(action);
        for (const std::string& line : turn.said) say(line);
        if (!turn.failed.empty()) {
          fmt::print(stderr, "operator_console: {}: {}\n", options_.script, turn.failed);
          return 1;
        }
        if (turn.finished) return 0;
      }
      desk_.set_sticks(gamepad_.sticks());  // last: Space lets go of them

      // Output, each at its own rate: the wish, which is also the sign of life, and the screen.
      if (now_s() >= next_wish_s_) send_wish();
      if (now_s() >= next_show_s_) show();
    }
    return 0;
  }

 private:
  static Script script_of(const std::string& path) {
    std::ifstream file(path);
    if (!file) throw std::runtime_error("cannot read the script " + path);
    const std::string text((std::istreambuf_iterator<char>(file)), {});
    try {
      return read_script(text);
    } catch (const std::runtime_error& error) {
      throw std::runtime_error(path + ": " + error.what());
    }
  }

  const Status* newest() const { return status_ ? &*status_ : nullptr; }
  void act(Action action) {
    desk_.act(action, now_s(), newest());
    if (action == Action::stand) gamepad_.let_go();
  }

  void wait() const {
    std::array<pollfd, 2> watched{{{socket_.descriptor(), POLLIN, 0}, {STDIN_FILENO, POLLIN, 0}}};
    ::poll(watched.data(), terminal_ ? 2 : 1, kTurn_ms);
  }

  void take_statuses() {
    std::array<std::byte, kMaxDatagramBytes + 1> buffer;  // one more than the largest datagram, to detect longer ones
    Peer from;
    for (int i = 0; i < 100; ++i) {
      const std::optional<std::size_t> size = socket_.receive(buffer, from);
      if (!size) return;
      Datagram datagram = Bye{};
      if (decode(std::span(buffer).first(*size), datagram) != kenaf::protocol::DecodeError::none) continue;
      if (const Status* status = std::get_if<Status>(&datagram); status != nullptr && status->session == session_) {
        taken_.reset();
        if (!health_.heard(*status, now_s())) continue;
        status_ = *status;
        desk_.hear(*status);
      } else if (const Taken* taken = std::get_if<Taken>(&datagram); taken != nullptr && taken->session == session_) {
        taken_ = std::string(view(taken->by));
        taken_until_s_ = now_s() + kTakenShown_s;
      }
    }
  }

  void send_wish() {
    next_wish_s_ = std::max(next_wish_s_ + kWishPeriod_s, now_s());
    Wish wish = desk_.wish(now_s());
    wish.session = session_;
    wish.sequence = ++sequence_;
    wish.newest_status = health_.newest_status();
    health_.sent(wish.sequence, now_s());
    send(wish);
  }

  void send(const Datagram& datagram) {
    std::array<std::byte, kMaxDatagramBytes> buffer;
    socket_.send(std::span(buffer).first(encode(datagram, buffer)));
  }

  void show() {
    if (taken_ && now_s() > taken_until_s_) taken_.reset();
    const Wish wish = desk_.wish(now_s());
    const View seen{options_.control, options_.camera, gamepad_.name(), newest(), taken_, health_, desk_, wish,
                    now_s()};
    if (terminal_) {
      terminal_->show(draw_screen(seen, terminal_->rows(), terminal_->columns()));
      next_show_s_ = now_s() + kScreenPeriod_s;
    } else {
      say(plain_line(seen));
      next_show_s_ = now_s() + kPlainPeriod_s;
    }
  }

  static void say(const std::string& line) {
    fmt::print("{}\n", line);
    std::fflush(stdout);
  }

  const Options options_;
  const std::uint64_t session_ = random_session();
  UdpSocket socket_;
  Gamepad gamepad_;
  Desk desk_;
  LinkHealth health_;
  std::optional<Player> player_;
  std::unique_ptr<Terminal> terminal_;
  std::optional<Status> status_;
  std::optional<std::string> taken_;
  double taken_until_s_ = 0;
  std::uint32_t sequence_ = 0;
  double next_wish_s_ = 0, next_show_s_ = 0;
};

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app("The operator's console: drives the robot through its control process, operator_control.",
               "operator_console");
  app.add_option("--control", options.control, "address of the control process, HOST:PORT")
      ->check(kenaf::command_line::readable_by(require_host_port))
      ->capture_default_str();
  app.add_option("--gamepad", options.gamepad,
                 "device of the gamepad, such as /dev/input/js1, or 'none'; default: the first one found");
  app.add_option("--camera", options.camera, "address of the camera's picture, shown on the screen");
  app.add_option("--speed", options.speed_mmps, "initial speed, mm/s")
      ->check(number_in(10.0, kMaxTrack_mmps))
      ->capture_default_str();
  app.add_option("--script", options.script, "plays the operator's input from this file, without a terminal");
  app.add_flag("--plain", options.plain, "print one line per second instead of the screen; the keyboard is not read");
  app.add_option("--key-first", options.keys.first_s, "seconds for which a key drives after it was pressed")
      ->check(number_in(0.1, 2.0))
      ->capture_default_str();
  app.add_option("--key-repeat", options.keys.repeat_s, "seconds for which a key drives after each of its repeats")
      ->check(number_in(0.05, 1.0))
      ->capture_default_str();
  if (const auto status = kenaf::command_line::parse(app, argc, argv)) return *status;

  // Each of these signals only ends the loop, so that the terminal is restored and the robot is commanded to stop.
  struct sigaction action {};
  action.sa_handler = on_signal;
  for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGQUIT}) sigaction(number, &action, nullptr);

  try {
    return Console(options).run();
  } catch (const std::exception& error) {
    fmt::print(stderr, "operator_console: {}\n", error.what());
    return 2;
  }
}
