// Commands as USARSim text. Signs by hand: a track forward is a wheel spinning forward; USARSim's flipper joints turn
// nose down where positive, so a tip that goes up is a negative angle in front and a positive one in the rear.
#include "relayd/command_transform.hpp"

#include <catch2/catch.hpp>

#include "tests/support/robot_command.hpp"

using namespace kenaf;
using namespace kenaf::relayd;

namespace {

std::string written(const protocol::relay::Command& command, double radius_m, std::optional<std::int64_t> frame) {
  std::string out;
  write_command(out, command, radius_m, frame);
  return out;
}

}  // namespace

TEST_CASE("Speeds become wheel spins: v / r, left and right kept apart") {
  const protocol::relay::Command command{1, 1, 1, support::command_of({0.1, -0.3})};
  CHECK(written(command, 0.05, std::nullopt) == "DRIVE {Left 2.000000000000} {Right -6.000000000000}\r\n");
  CHECK(written(command, 0.05, 17) == "DRIVE {Left 2.000000000000} {Right -6.000000000000} {Frame 17}\r\n");
}

TEST_CASE("Flippers: tip up is negative in front and positive in the rear, DRIVE ends the answer") {
  const protocol::relay::Command command{1, 1, 1, support::command_of({0, 0}, 0b1111, {0.1, 0.2, 0.3, 0.4})};
  CHECK(written(command, 0.05, 3) ==
        "MULTIDRIVE {FLFlipper -0.100000000000} {FRFlipper -0.200000000000} {RLFlipper 0.300000000000} "
        "{RRFlipper 0.400000000000} {Frame 3}\r\n"
        "DRIVE {Left 0.000000000000} {Right 0.000000000000} {Frame 3}\r\n");
}

TEST_CASE("A flipper that is kept is not mentioned") {
  const protocol::relay::Command command{1, 1, 1, support::command_of({0, 0}, 0b0100, {1, 1, 0.5, 1})};
  CHECK(written(command, 0.05, std::nullopt).starts_with("MULTIDRIVE {RLFlipper 0.500000000000}\r\nDRIVE "));
}

TEST_CASE("Stop, session settings and ping are written as the world server reads them") {
  std::string out;
  write_stop(out);
  write_world_session(out, {0.01, true, 0.5});
  write_ping(out, 7);
  CHECK(out ==
        "DRIVE {Left 0.000000000000} {Right 0.000000000000}\r\n"
        "CONTROL {Type Session} {Period 0.010000000000} {Lockstep True} {CommandTimeout 0.500000000000} "
        "{Precision 12}\r\n"
        "PING {Id 7}\r\n");
}

TEST_CASE("What no Kenaf can do is out of range, up to the limits is not") {
  protocol::relay::Command command{1, 1, 1, support::command_of({10, -10}, 15, {100, -100, 100, -100})};
  CHECK(out_of_range(command) == nullptr);
  command.robot.track_speed_mps[1] = -10.001;
  CHECK(std::string(out_of_range(command)).find("track speed") != std::string::npos);
  command.robot.track_speed_mps[1] = 0;
  command.robot.flipper[3].value = 100.1;
  CHECK(std::string(out_of_range(command)).find("flipper") != std::string::npos);

  protocol::relay::Hello hello{1, 0.001, 10, true, false};
  CHECK(out_of_range(hello) == nullptr);
  hello.period_s = 0.0009;
  CHECK(out_of_range(hello) != nullptr);
  hello.period_s = 1;
  hello.command_timeout_s = 0.009;
  CHECK(out_of_range(hello) != nullptr);
}
