// An operator works over a bad network, with all programs as processes: world server and relay in one, the control
// process, a lossy proxy with 100 ms each way and 5 % loss, the console playing a script. He climbs the step of 200 mm
// and ends on top; if the link is cut in mid-climb, the robot stops and holds its place, though he holds the key, and
// when the link is back it still stands until he lets go and presses again. Garbage, a second console, and a console
// that is killed and started again neither end the control process nor move the robot against its holder, and a relay
// that is killed and started again is reported and has the robot again. Over a network that takes 0.6 s each way
// nothing moves, as the operator's view is older than the 1 s that is allowed.
//
// Clocks: the operator, his link and its silence are on the wall's clock, because a network and a person are; the
// robot's path is measured in the robot's time, by what the control process recorded. A simulation in lock step never
// runs faster than the wall here (speed 1), so a machine that is held up makes the robot's part slower and no limit
// below tighter. Where the console itself is held up for longer than the silence, the robot halts, and the operator
// presses again as he does after a cut link.
#include <fcntl.h>
#include <linux/joystick.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <iterator>
#include <memory>

#include "formats/runs/run_file.hpp"
#include "teleop/link.hpp"
#include "teleop/udp.hpp"
#include "tests/support/lossy_proxy.hpp"
#include "tests/support/patience.hpp"
#include "tests/support/process.hpp"

using namespace kenaf;
using namespace std::chrono_literals;
using support::Process;

namespace {

constexpr support::Network kBadNetwork{.lost = 0.05, .doubled = 0.02, .delayed = 0.2, .delay = 40ms, .latency = 100ms};
const std::string kStepScript = KENAF_SOURCE_DIR "/teleop/step_200.script";

class Desk {
 public:
  Desk() {
    start_relay(0);
    const auto port_file = folder_.path() / "control.port";
    control_ = std::make_unique<Process>(
        std::vector<std::string>{KENAF_BIN_DIR "/operator_control_sim", "--listen", "127.0.0.1:0", "--port-file",
                                 port_file.string()},
        folder_.path() / "control.log",
        std::map<std::string, std::string>{{"KENAF_RELAY", "127.0.0.1:" + std::to_string(relay_port_)},
                                           {"KENAF_CONFIG", ""},
                                           {"KENAF_RECORD", (folder_.path() / "run.csv").string()}});
    control_port_ = support::wait_for_port(port_file, *control_);
  }

  void start_relay(std::uint16_t port) {
    const auto port_file = folder_.path() / "relay.port";
    std::filesystem::remove(port_file);
    relay_.reset();
    relay_ = std::make_unique<Process>(
        std::vector<std::string>{KENAF_BIN_DIR "/kenaf-relayd", "--embedded", "--view", "off", "--cameras", "off",
                                 "--world", "step-200", "--listen", "127.0.0.1:" + std::to_string(port), "--port-file",
                                 port_file.string()},
        folder_.path() / "relay.log");
    relay_port_ = support::wait_for_port(port_file, *relay_);
  }

  Process console(std::uint16_t port, const std::string& script, const std::string& name = "console") const {
    return Process({KENAF_BIN_DIR "/operator_console", "--control", "127.0.0.1:" + std::to_string(port), "--gamepad",
                    "none", "--script", script},
                   folder_.path() / (name + ".log"));
  }
  std::string script(const std::string& text) const {
    const auto path = folder_.path() / "made.script";
    std::ofstream(path) << text;
    return path.string();
  }
  std::string log(const std::string& name) const {
    std::ifstream file(folder_.path() / (name + ".log"));
    return {std::istreambuf_iterator<char>(file), {}};
  }

  // What was recorded; ends the control process.
  runs::Run recording() {
    control_->signal(SIGTERM);
    REQUIRE(control_->wait() == 0);
    return runs::read_run(folder_.path() / "run.csv");
  }
  Process& control() { return *control_; }
  Process& relay() { return *relay_; }
  std::uint16_t control_port() const { return control_port_; }
  std::uint16_t relay_port() const { return relay_port_; }

 private:
  support::TemporaryFolder folder_;
  std::unique_ptr<Process> relay_, control_;
  std::uint16_t relay_port_ = 0, control_port_ = 0;
};

// The newest value of a column at or before a time on the robot's clock.
double value_at(const runs::Run& run, const std::string& column, double t_s) {
  const auto t = run.column("robot_time_s"), values = run.column(column);
  double value = std::nan("");
  for (std::size_t i = 0; i < t.size() && t[i] <= t_s; ++i) {
    if (!std::isnan(values[i])) value = values[i];
  }
  return value;
}

double end_of(const runs::Run& run) {
  return run.column("robot_time_s").back();
}

void check_on_top(const runs::Run& run) {
  // As the manoeuvre step-200-flippers counts it: beyond the edge at 1 m, 200 mm higher than the 90 mm at which the
  // body's middle stands, less what rests on the flippers, level.
  CHECK(value_at(run, "x_m", end_of(run)) > 1.4);
  CHECK(value_at(run, "z_m", end_of(run)) > 0.25);
  CHECK(std::abs(value_at(run, "pitch_rad", end_of(run))) < 0.3);
}

}  // namespace

TEST_CASE("An operator climbs a step of 200 mm over 100 ms of latency and 5 % of loss") {
  Desk desk;
  support::LossyProxy proxy(desk.control_port(), 1, kBadNetwork);
  Process console = desk.console(proxy.port(), kStepScript);
  const auto status = console.wait();
  INFO(desk.log("console") << desk.log("control"));
  REQUIRE(status == 0);
  check_on_top(desk.recording());
}

TEST_CASE("The link cut in mid-climb: the robot holds its place until the operator has let go and pressed again") {
  Desk desk;
  // Watches the statuses on their way to the console, as one who stands by: when the nose is 20 degrees up, it cuts.
  std::atomic<bool> is_steep{false}, was_halted_by_silence{false};
  std::atomic<double> newest_robot_time_s{0};
  const auto watch = [&](bool to_control, std::span<const std::byte> bytes) {
    teleop::Datagram datagram = teleop::Bye{1};
    if (to_control || teleop::decode(bytes, datagram) != protocol::DecodeError::none) return;
    const auto* status = std::get_if<teleop::Status>(&datagram);
    if (status == nullptr) return;
    newest_robot_time_s = status->robot_time_s;
    if (status->posture_deg[1] < -20) is_steep = true;
    if (status->mode == teleop::Mode::halted && status->halt == teleop::Halt::silence) was_halted_by_silence = true;
  };
  support::LossyProxy proxy(desk.control_port(), 2, kBadNetwork, {.passing = watch});
  Process console = desk.console(proxy.port(), kStepScript);
  const auto end = std::chrono::steady_clock::now() + 60s;
  const auto wait_until = [&](const auto& condition) {
    while (!condition() && std::chrono::steady_clock::now() < end) std::this_thread::sleep_for(2ms);
    REQUIRE(condition());
  };
  wait_until([&] { return is_steep.load(); });
  proxy.cut(true);
  const double cut_s = newest_robot_time_s;
  wait_until([&] { return newest_robot_time_s > cut_s + 2.5; });  // the control process goes on telling
  CHECK(was_halted_by_silence);
  const double back_s = newest_robot_time_s;
  proxy.cut(false);
  const auto status = console.wait();
  INFO(desk.log("console") << desk.log("control"));
  REQUIRE(status == 0);

  const runs::Run run = desk.recording();
  INFO("cut at " << cut_s << " s, back at " << back_s << " s");
  // A wish that was under way may be 0.14 s old when it arrives... none arrives after the cut. So 0.5 s of silence and
  // a turn of the loop after the last one, which came at most a few 50 ms before; 1.2 s is twice that.
  const double stopped_s = cut_s + 1.2;
  CHECK(value_at(run, "x_m", cut_s) < 1.0);  // in mid-climb
  CHECK(value_at(run, "pitch_rad", stopped_s) < -0.25);
  // Driven on at 0.2 m/s for 0.6 s, it came 120 mm farther; and no more than that and its slip.
  CHECK(value_at(run, "x_m", stopped_s) - value_at(run, "x_m", cut_s) < 0.2);
  // It holds until the link is back, and beyond: the operator needs a second to notice.
  for (double t_s = stopped_s; t_s < back_s + 0.5; t_s += 0.1) {
    INFO("at " << t_s << " s");
    CHECK(std::abs(value_at(run, "x_m", t_s) - value_at(run, "x_m", stopped_s)) < 0.005);
    CHECK(std::abs(value_at(run, "z_m", t_s) - value_at(run, "z_m", stopped_s)) < 0.005);
    CHECK(std::abs(value_at(run, "pitch_rad", t_s) - value_at(run, "pitch_rad", stopped_s)) < 0.02);
    CHECK(value_at(run, "cmd_track_left_mps", t_s) == 0);
  }
  check_on_top(run);
}

TEST_CASE("The control process survives garbage, a second console, and a killed one with its successor") {
  Desk desk;
  Process first = desk.console(desk.control_port(), desk.script("wait until mode is ready within 20\n"
                                                                "say has the robot\nhold w for 60\n"));
  const auto logged = [&](const std::string& name, const std::string& words) {
    const auto end = std::chrono::steady_clock::now() + 20s;
    while (std::chrono::steady_clock::now() < end) {
      if (desk.log(name).find(words) != std::string::npos) return true;
      std::this_thread::sleep_for(5ms);
    }
    return false;
  };
  REQUIRE(logged("console", "has the robot"));

  const teleop::Peer to = teleop::resolve_listener("127.0.0.1:" + std::to_string(desk.control_port()));
  teleop::UdpSocket thrower = teleop::UdpSocket::connected_to({to});
  std::vector<std::byte> garbage(3000, std::byte{0x4b});
  for (std::size_t size = 0; size < garbage.size(); size += 7) thrower.send(std::span(garbage).first(size));
  REQUIRE(logged("control", "ignored"));

  const std::string idle = desk.script("wait until mode is ready within 20\nsay is ready\n");
  Process second = desk.console(desk.control_port(), idle, "second");
  REQUIRE(logged("second", "has the robot, heard"));
  CHECK(desk.log("second").find("is ready") == std::string::npos);

  first.signal(SIGKILL);  // no Bye: the robot halts by the silence, then the second one gets it
  CHECK(second.wait() == 0);
  CHECK(logged("control", "halted: silence"));
  Process third = desk.console(desk.control_port(), idle, "third");  // the second one said Bye
  CHECK(third.wait() == 0);
  CHECK_FALSE(desk.control().status());

  const runs::Run run = desk.recording();
  CHECK(value_at(run, "x_m", end_of(run)) > run.column("x_m").front() + 0.02);  // the first one drove
  CHECK(value_at(run, "cmd_track_left_mps", end_of(run)) == 0);
}

TEST_CASE("The relay dies and comes back") {
  Desk desk;
  Process console = desk.console(desk.control_port(), desk.script("wait until mode is ready within 20\n"
                                                                  "say one\n"
                                                                  "wait until mode is no_robot within 20\n"
                                                                  "say lost\n"
                                                                  "wait until mode is ready within 20\n"
                                                                  "say again\n"
                                                                  "hold w until track_mmps > 50 within 5\n"));
  const auto said = [&](const std::string& words) {
    const auto end = std::chrono::steady_clock::now() + 30s;
    while (desk.log("console").find(words) == std::string::npos && std::chrono::steady_clock::now() < end) {
      std::this_thread::sleep_for(5ms);
    }
    return desk.log("console").find(words) != std::string::npos;
  };
  REQUIRE(said("one"));
  desk.relay().signal(SIGKILL);
  desk.relay().wait();
  REQUIRE(said("lost"));
  desk.start_relay(desk.relay_port());
  const auto status = console.wait();
  INFO(desk.log("console") << desk.log("control"));
  CHECK(status == 0);
  CHECK(desk.log("control").find("HRT_E_LINK") != std::string::npos);
  CHECK(desk.log("control").find("robot_lost") != std::string::npos);
}

TEST_CASE("A network that is too slow moves nothing") {
  Desk desk;
  support::LossyProxy proxy(desk.control_port(), 3, {.lost = 0, .doubled = 0, .delayed = 0, .latency = 600ms});
  Process console = desk.console(proxy.port(), desk.script("wait until mode is halted within 20\nhold w for 2\n"));
  const auto status = console.wait();
  INFO(desk.log("console") << desk.log("control"));
  REQUIRE(status == 0);
  CHECK(desk.log("control").find("halted: late") != std::string::npos);
  const runs::Run run = desk.recording();
  const auto commanded = run.column("cmd_track_left_mps");
  CHECK(std::all_of(commanded.begin(), commanded.end(), [](double speed) { return speed == 0; }));
}

TEST_CASE("Space stands the robot though a gamepad's dead-man is held, until it is released and pressed again") {
  // The test is the control process and, by a pipe with a name, the gamepad.
  const support::TemporaryFolder folder;
  const std::string pad_path = folder.path() / "js0", script_path = folder.path() / "space.script";
  REQUIRE(::mkfifo(pad_path.c_str(), 0600) == 0);
  const int pad = ::open(pad_path.c_str(), O_RDWR | O_CLOEXEC);
  const auto press = [&](bool down) {
    const js_event event{0, static_cast<__s16>(down), JS_EVENT_BUTTON, 4};
    REQUIRE(::write(pad, &event, sizeof event) == sizeof event);
  };
  const js_event ahead{0, -32767, JS_EVENT_AXIS, 1};
  REQUIRE(::write(pad, &ahead, sizeof ahead) == sizeof ahead);
  press(true);
  std::ofstream(script_path) << "wait 1\npress space\nwait 600\n";

  auto control = teleop::UdpSocket::bound_to(teleop::resolve_listener("127.0.0.1:0"));
  const Process console({KENAF_BIN_DIR "/operator_console", "--control", "127.0.0.1:" + std::to_string(control.port()),
                         "--gamepad", pad_path, "--script", script_path},
                        folder.path() / "console.log");
  const auto next_wish = [&] {
    std::array<std::byte, 2048> bytes;
    teleop::Peer from;
    teleop::Datagram datagram = teleop::Bye{1};
    const bool came = support::eventually([&] {
      const auto size = control.receive(bytes, from);
      return size && teleop::decode(std::span(bytes).first(*size), datagram) == protocol::DecodeError::none &&
             std::holds_alternative<teleop::Wish>(datagram);
    });
    REQUIRE(came);
    return std::get<teleop::Wish>(datagram);
  };

  CHECK(next_wish().deadman);
  teleop::Wish wish = next_wish();
  CHECK(wish.track_mmps[0] > 0);
  while (wish.deadman) wish = next_wish();  // for the second until Space
  for (int i = 0; i < 20; ++i) {
    wish = next_wish();
    CHECK_FALSE(wish.deadman);
    CHECK(wish.track_mmps[0] == 0);
  }
  press(false);
  press(true);
  while (!wish.deadman) wish = next_wish();
  CHECK(wish.track_mmps[0] > 0);
  ::close(pad);
}
