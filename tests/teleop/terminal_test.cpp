// The console runs in a terminal of 80 x 24, as a process: the test holds the terminal's other end and the control
// process' socket. A key becomes a wish with the dead-man held, which ends when the key no longer comes, E presses the
// emergency stop, and the screen shows the status. The console follows the terminal's size, leaves the terminal as it
// was when a key or signal ends it, says what to do without one, and takes no bytes of a key that the terminal's
// description lacks for keys of their own. No test asks for anything within a time: each waits for it, at most 20 s.
#include <pty.h>
#include <signal.h>
#include <sys/ioctl.h>
#include <sys/wait.h>
#include <termios.h>
#include <unistd.h>
#include <utmp.h>

#include <array>
#include <catch2/catch.hpp>
#include <chrono>
#include <cstdlib>
#include <functional>
#include <string>
#include <thread>

#include "teleop/link.hpp"
#include "teleop/postures.hpp"
#include "teleop/udp.hpp"
#include "tests/support/process.hpp"

using kenaf::protocol::DecodeError;
using namespace kenaf::teleop;
using namespace std::chrono_literals;

namespace {

const std::string kProgram = KENAF_BIN_DIR "/operator_console";

class ConsoleInTerminal {
 public:
  explicit ConsoleInTerminal(const char* terminal = "xterm")
      : socket_(UdpSocket::bound_to(resolve_listener("127.0.0.1:0"))) {
    const std::string control = "127.0.0.1:" + std::to_string(socket_.port());
    winsize size{24, 80, 0, 0};
    int slave = -1;
    REQUIRE(::openpty(&master_, &slave, nullptr, nullptr, &size) == 0);
    ::tcgetattr(master_, &before_);  // of the terminal, whose two ends share them; the console is quick to change them
    pid_ = ::fork();
    if (pid_ == 0) {
      ::close(master_);
      ::login_tty(slave);
      ::setenv("TERM", terminal, 1);
      ::execl(kProgram.c_str(), kProgram.c_str(), "--control", control.c_str(), "--gamepad", "none", nullptr);
      ::_exit(127);
    }
    ::close(slave);
    REQUIRE(pid_ > 0);
  }
  ~ConsoleInTerminal() {
    if (!has_ended_) ::kill(pid_, SIGKILL);
    if (!has_ended_) ::waitpid(pid_, nullptr, 0);
    ::close(master_);
  }

  void type(const std::string& keys) const { REQUIRE(::write(master_, keys.data(), keys.size()) > 0); }
  void signal(int number) const { ::kill(pid_, number); }
  void resize(unsigned short columns, unsigned short rows) const {
    const winsize size{rows, columns, 0, 0};
    REQUIRE(::ioctl(master_, TIOCSWINSZ, &size) == 0);  // the kernel tells the console: SIGWINCH
  }

  // Reads wishes and the screen until `condition` holds.
  bool eventually(const std::function<bool()>& condition) {
    const auto end = std::chrono::steady_clock::now() + 20s;
    while (std::chrono::steady_clock::now() < end) {
      take();
      if (condition()) return true;
      std::this_thread::sleep_for(5ms);
    }
    return false;
  }
  void send(Status status) {
    status.session = wish_.session;
    status.sequence = ++sequence_;
    status.newest_wish = wish_.sequence;
    std::array<std::byte, kMaxDatagramBytes> buffer;
    socket_.send(std::span(buffer).first(encode(status, buffer)), console_);
  }
  std::optional<int> exit_status() {
    int raw = 0;
    eventually([&] { return has_ended_ = ::waitpid(pid_, &raw, WNOHANG) == pid_; });
    return has_ended_ && WIFEXITED(raw) ? std::optional(WEXITSTATUS(raw)) : std::nullopt;
  }
  bool terminal_is_as_before() const {
    termios now{};
    ::tcgetattr(master_, &now);
    return now.c_lflag == before_.c_lflag && now.c_iflag == before_.c_iflag && now.c_oflag == before_.c_oflag;
  }

  const Wish& wish() const { return wish_; }
  bool said_bye() const { return said_bye_; }
  bool screen_has(const std::string& words) const { return screen_.find(words) != std::string::npos; }
  void forget_screen() { screen_.clear(); }

 private:
  void take() {
    std::array<std::byte, kMaxDatagramBytes> buffer;
    if (const auto size = socket_.receive(buffer, console_)) {  // one at a time: none is missed by who waits for it
      Datagram datagram = Bye{9};
      REQUIRE(decode(std::span(buffer).first(*size), datagram) == DecodeError::none);
      if (const Wish* wish = std::get_if<Wish>(&datagram)) wish_ = *wish;
      if (std::holds_alternative<Bye>(datagram)) said_bye_ = true;
    }
    std::array<char, 4096> text{};
    int waiting = 0;
    while (::ioctl(master_, FIONREAD, &waiting) == 0 && waiting > 0) {
      const ssize_t got = ::read(master_, text.data(), text.size());
      if (got <= 0) return;
      screen_.append(text.data(), static_cast<std::size_t>(got));
    }
  }

  UdpSocket socket_;
  Peer console_;
  pid_t pid_ = -1;
  int master_ = -1;
  termios before_{};
  bool has_ended_ = false, said_bye_ = false;
  Wish wish_{};
  std::uint32_t sequence_ = 0;
  std::string screen_;
};

Status some_status(Mode mode) {
  Status status{};
  status.mode = mode;
  status.halt = Halt::start;
  status.message = text_of("the robot is open");
  return status;
}

}  // namespace

TEST_CASE("Keys in a terminal become wishes, statuses a screen") {
  ConsoleInTerminal console;
  REQUIRE(console.eventually([&] { return console.wish().sequence > 2; }));
  CHECK_FALSE(console.wish().deadman);
  REQUIRE(console.eventually([&] { return console.screen_has("nothing heard yet"); }));
  console.send(some_status(Mode::ready));
  REQUIRE(console.eventually([&] { return console.screen_has("READY") && console.screen_has("the robot is open"); }));

  // Held until it is seen: of one press nothing is left for a wish where the console is held up for 0.6 s.
  const auto holding = [&](const char* key, const std::function<bool()>& is_seen) {
    return console.eventually([&] {
      if (is_seen()) return true;
      console.type(key);
      return false;
    });
  };
  REQUIRE(holding("w", [&] { return console.wish().deadman; }));
  CHECK(console.wish().track_mmps == std::array{200.0, 200.0});
  REQUIRE(console.eventually([&] { return !console.wish().deadman; }));  // it comes no more
  CHECK(console.wish().track_mmps == std::array{0.0, 0.0});
  // the left arrow as xterm sends it
  REQUIRE(holding("\x1bOD", [&] { return console.wish().track_mmps[kRight] > 0; }));
  CHECK(console.wish().track_mmps[kLeft] < 0);
  console.type("3");
  REQUIRE(console.eventually([&] { return console.wish().flipper_order == 1; }));

  console.forget_screen();
  console.resize(60, 20);
  REQUIRE(console.eventually([&] { return console.screen_has("arrows: drive  space: stand"); }));
  console.type("e");
  REQUIRE(console.eventually([&] { return console.wish().emergency_stop; }));
  console.forget_screen();
  console.resize(80, 24);
  REQUIRE(console.eventually([&] { return console.screen_has("EMERGENCY PRESSED"); }));

  console.type("Q");
  CHECK(console.exit_status() == 0);
  CHECK(console.eventually([&] { return console.said_bye(); }));
}

TEST_CASE("Keys that the terminal's description lacks do nothing, and a key after Esc is not lost") {
  ConsoleInTerminal console("screen");  // which knows no key with control or shift
  REQUIRE(console.eventually([&] { return console.screen_has("operator's console"); }));
  // control-left, shift-F5, F5 of Linux' console, control-End: in each is the key of a posture or of the emergency stop
  for (const char* sequence : {"\x1b[1;5D", "\x1b[15;2~", "\x1b[[E", "\x1bO5F"}) console.type(sequence);
  console.type("3");
  REQUIRE(console.eventually([&] { return console.wish().flipper_order > 0; }));
  CHECK(console.wish().flipper_order == 1);
  CHECK(console.wish().flipper_deg == kPostures[2].flipper_deg);
  CHECK_FALSE(console.wish().emergency_stop);
  console.type("\x1b");
  console.type("4");
  REQUIRE(console.eventually([&] { return console.wish().flipper_order == 2; }));
  console.type("\x1b\x1b[1;5De");
  REQUIRE(console.eventually([&] { return console.wish().emergency_stop; }));
  CHECK(console.wish().flipper_order == 2);
}

TEST_CASE("A signal or a key ends it, and leaves the terminal as it was") {
  for (const int number : {0, SIGTERM, SIGHUP, SIGINT}) {
    ConsoleInTerminal console;
    REQUIRE(console.eventually([&] { return console.screen_has("operator's console"); }));
    CHECK_FALSE(console.terminal_is_as_before());
    if (number == 0) console.type("\x03");  // control-C
    if (number != 0) console.signal(number);
    CHECK(console.exit_status() == 0);
    CHECK(console.eventually([&] { return console.said_bye(); }));
    CHECK(console.terminal_is_as_before());
    CHECK(console.eventually([&] { return console.screen_has("\x1b[?1049l"); }));  // back to what was shown before
  }
}

TEST_CASE("Without a terminal it says what to do") {
  const kenaf::support::TemporaryFolder folder;
  kenaf::support::Process console({kProgram, "--gamepad", "none"}, folder.path() / "log");
  CHECK(console.wait() == 2);
}
