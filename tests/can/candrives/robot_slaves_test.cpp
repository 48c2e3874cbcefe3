// All nodes together: time.
#include <catch2/catch.hpp>

#include "tests/can/candrives/easy_robot.hpp"

using namespace kenaf;
using namespace kenaf::candrives;

namespace {

// Frames of a short drive, each with its time in ms: heartbeats up to 300 ms, then the master is dead.
struct Timed {
  int at_ms;
  const char* line;
};
const Timed kDrive[] = {
    {10, "601#2316100164007F00"},  // watches node 127, 100 ms
    {10, "601#2B07600003000000"},  // quick stop if it is lost
    {10, "601#2385600050C30000"},  // 50000 counts/s^2
    {10, "601#2383600010270000"},  // 10000 counts/s^2
    {10, "601#2F60600003000000"},  // profile velocity
    {11, "601#2B40600006000000"},
    {12, "601#2B40600007000000"},
    {13, "601#2B4060000F000000"},
    {20, "601#23FF600088130000"},  // 5000 counts/s
    {100, "77F#05"},
    {180, "77F#05"},
    {260, "77F#05"},
    {300, "77F#05"},
};

struct Result {
  double track_m;
  Lines frames;
};

// Calls on_time each `every_ms`, and where that is 0 only when deadline() asks for it.
Result drive(int every_ms) {
  EasyRobot robot;
  Result result;
  const auto note = [&](const Frames& frames) {
    for (const auto& frame : frames) result.frames.push_back(text(frame));
  };
  const auto run_to = [&](canopen::Time end) {
    while (true) {
      const canopen::Time step = std::chrono::milliseconds(every_ms);
      const canopen::Time next = every_ms > 0 ? robot.now + step : robot.slaves.deadline();
      if (next > end) break;
      Frames out;
      robot.slaves.on_time(robot.now = next, out);
      note(out);
    }
    robot.now = end;
  };
  for (const Timed& timed : kDrive) {
    run_to(std::chrono::milliseconds(timed.at_ms));
    Frames out;
    robot.slaves.on_frame(frame(timed.line), robot.now, out);
    note(out);
  }
  run_to(std::chrono::milliseconds(900));
  Frames out;
  robot.slaves.on_time(robot.now, out);
  note(out);
  result.track_m = robot.plant.state().track_m[0];
  return result;
}

}  // namespace

TEST_CASE("What happens does not depend on when the nodes are called", "[time]") {
  const Result each_step = drive(1), seldom = drive(37), asked = drive(0);
  CHECK(each_step.frames.size() == 10);  // nine SDO answers, and the emergency message of the lost master
  CHECK(each_step.track_m > 0.05);
  for (const Result& other : {seldom, asked}) {
    CHECK(other.frames == each_step.frames);
    CHECK(other.track_m == each_step.track_m);
  }
}
