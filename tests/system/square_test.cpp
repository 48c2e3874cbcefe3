// The whole chain of processes drives the square example. By the simulator's ground truth the square of 100 mm sides
// goes round the corners (0,0), (100,0), (100,100), (0,100) mm, turning left, and closes within 10 mm and 2 degrees.
// Half, double and full speed of the world server give the same path within 1 mm, and being in lock step, the same
// bits; garbage thrown at both ports during the run changes nothing. Both servers end with status 0 on SIGTERM.
#include <signal.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <utility>

#include "tests/support/loopback.hpp"
#include "tests/support/patience.hpp"
#include "tests/system/chain.hpp"

using namespace kenaf;
using namespace kenaf::system_test;
using namespace std::chrono_literals;

namespace {

support::Process start_square(Chain& chain, Environment environment = {}) {
  environment["KENAF_RECORD"] = (chain.folder() / "square.csv").string();
  return chain.start_program("square_sim", environment);
}

std::vector<Pose2> path_driven(Chain& chain, support::Process& program) {
  const auto status = program.wait();
  INFO(chain.log("square_sim") << chain.log("relay") << chain.log("world"));
  REQUIRE(status == 0);
  return path_of(runs::read_run(chain.folder() / "square.csv"));
}

std::vector<Pose2> drive_square(Chain& chain) {
  support::Process program = start_square(chain);
  return path_driven(chain, program);
}

double distance_to(const std::vector<Pose2>& path, double x_m, double y_m) {
  double nearest = 1e9;
  for (const Pose2& pose : path) nearest = std::min(nearest, std::hypot(pose.x_m - x_m, pose.y_m - y_m));
  return nearest;
}

}  // namespace

TEST_CASE("The square closes, goes round its corners, and both servers end cleanly") {
  Chain chain("0");
  const std::vector<Pose2> path = drive_square(chain);
  const Pose2 start = path.front(), end = path.back();

  CHECK(std::hypot(end.x_m - start.x_m, end.y_m - start.y_m) < 0.010);
  // Four left turns add up to one full turn, which leaves the heading as it was.
  CHECK(std::abs(std::remainder(end.yaw_rad - start.yaw_rad, 2 * std::numbers::pi)) < 2 * std::numbers::pi / 180);

  // A corner is cut by at most what the closing error allows: 10 mm.
  CHECK(distance_to(path, start.x_m + 0.1, start.y_m) < 0.010);
  CHECK(distance_to(path, start.x_m + 0.1, start.y_m + 0.1) < 0.010);
  CHECK(distance_to(path, start.x_m, start.y_m + 0.1) < 0.010);

  chain.relay().signal(SIGTERM);
  chain.world().signal(SIGTERM);
  CHECK(chain.relay().wait() == 0);
  CHECK(chain.world().wait() == 0);
}

// The program is told the robot's gauge, and nothing else of it.
TEST_CASE("Over IPv6 the square is the same, to the last bit, with brackets around the address and without") {
  if (!test::has_ipv6_loopback()) {
    WARN("skipped: this machine has no address ::1");
    return;
  }
  Chain chain("0");
  const std::vector<Pose2> path = drive_square(chain);
  for (const std::string host : {"::1", "[::1]"}) {
    CAPTURE(host);
    Chain chain6("0", "flat", false, "USARBot.Kenaf", host);
    const std::vector<Pose2> path6 = drive_square(chain6);
    REQUIRE(path6.size() == path.size());
    for (std::size_t i = 0; i < path.size(); ++i) {
      REQUIRE(path6[i].x_m == path[i].x_m);
      REQUIRE(path6[i].y_m == path[i].y_m);
      REQUIRE(path6[i].yaw_rad == path[i].yaw_rad);
    }
    CHECK(chain6.log("relay").find("listening on [::1]:" + std::to_string(chain6.relay_port())) != std::string::npos);
    CHECK(chain6.log("world").find("on [::1]:" + std::to_string(chain6.world_port())) != std::string::npos);
  }
}

TEST_CASE("Robots on wheels drive the square too") {
  for (const auto& [robot_class, gauge_mm] : {std::pair{"USARBot.Husky", "555"}, {"USARBot.P3AT", "394"}}) {
    Chain chain("0", "flat", false, robot_class);
    support::Process program = start_square(chain, {{"KENAF_TRACK_GAUGE_MM", gauge_mm}});
    const std::vector<Pose2> path = path_driven(chain, program);
    INFO(robot_class);
    CHECK(std::hypot(path.back().x_m - path.front().x_m, path.back().y_m - path.front().y_m) < 0.010);
    CHECK(distance_to(path, path.front().x_m + 0.1, path.front().y_m + 0.1) < 0.015);
  }
}

TEST_CASE("Half, double and full speed drive the same path", "[long]") {
  Chain half("0.5"), twice("2"), full("0");
  // At the same time: those at half and double speed mostly wait for the clock.
  support::Process slow = start_square(half), fast = start_square(twice);
  const std::vector<Pose2> reference = drive_square(full);
  for (auto [chain, program] : {std::pair{&twice, &fast}, std::pair{&half, &slow}}) {
    const std::vector<Pose2> path = path_driven(*chain, *program);
    REQUIRE(path.size() == reference.size());
    double largest = 0;
    for (std::size_t i = 0; i < path.size(); ++i) {
      largest = std::max(largest, std::hypot(path[i].x_m - reference[i].x_m, path[i].y_m - reference[i].y_m));
    }
    CHECK(largest < 1e-3);
    CHECK(largest == 0);
  }
}

TEST_CASE("Garbage at both ports during the run changes nothing") {
  Chain quiet("0");
  const std::vector<Pose2> reference = drive_square(quiet);

  Chain chain("2");
  support::Process square = start_square(chain);
  // A robot of the garbage that came first would have this robot's start pose.
  REQUIRE(support::eventually([&] { return chain.log("world").find(": robot ") != std::string::npos; }));
  support::Process garbage({"/bin/bash", KENAF_SOURCE_DIR "/scripts/throw-garbage.sh",
                            std::to_string(chain.world_port()), std::to_string(chain.relay_port()), "6"},
                           chain.folder() / "garbage.log");
  const std::vector<Pose2> path = path_driven(chain, square);
  CHECK(garbage.wait() == 0);

  // The garbage places robots of its own in the world, at other places; contacts of one robot do not feel another's,
  // but the order of the solver's constraints may change, hence millimetres here and not bits.
  REQUIRE(path.size() > 100);
  CHECK(std::hypot(path.back().x_m - reference.back().x_m, path.back().y_m - reference.back().y_m) < 1e-3);
  CHECK_FALSE(chain.world().status());
  CHECK_FALSE(chain.relay().status());

  chain.relay().signal(SIGTERM);
  CHECK(chain.relay().wait() == 0);
}
