// These tests use hrt.h from outside, on a robot whose physics is known. They check units and signs at the border,
// every error code where the header promises it, and that no call hangs or crashes. In lock step the commands of a
// program must not depend on how long it thinks, silence stops the tracks, and recordings are complete.
#include <sched.h>
#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <catch2/catch.hpp>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <limits>
#include <random>
#include <string>
#include <thread>
#include <utility>

#include "formats/runs/run_file.hpp"
#include "hrt/robot.hpp"
#include "kenaf/hrt.h"
#include "tests/hrt/fake_transport.hpp"
#include "tests/support/patience.hpp"
#include "tests/support/process.hpp"

using namespace kenaf::hrt::test;
using namespace std::chrono_literals;

namespace {

constexpr double kDegree = 3.14159265358979323846 / 180;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Opens the fake robot for one test and closes it at the end.
struct Open {
  explicit Open(const hrt_config& config = hrt_config_default()) {
    INFO(hrt_last_error());
    REQUIRE(hrt_kenaf_init_with(&config) == HRT_OK);
  }
  ~Open() { (void)hrt_close(); }
};

// Waits, in wall-clock time, until the robot is in a motion.
void await_motion() {
  hrt_state state = hrt_state_init();
  do {
    std::this_thread::sleep_for(1ms);
    REQUIRE(hrt_get_state(&state) == HRT_OK);
  } while ((state.activity & HRT_MOTION_ACTIVE) == 0);
}

// Waits, without calling the library, until the tracks are commanded to stop; returns the last frame whose answer
// commanded motion.
std::size_t last_moving_frame(FakeRobot& robot) {
  std::size_t frame = 0;
  for (bool stopped = false; !stopped; std::this_thread::sleep_for(1ms)) {
    const std::lock_guard lock(robot.mutex);
    const std::size_t count = robot.commands.size();
    stopped = robot.commands.back().track_speed_mps[0] == 0;
    for (std::size_t i = 0; stopped && i < count; ++i) {
      if (robot.commands[i].track_speed_mps[0] != 0) frame = i + 1;
    }
  }
  return frame;
}

// A robot on which a motion of 100 m lasts long enough to be interrupted.
hrt_config unhurried() {
  hrt_config config = hrt_config_default();
  config.max_speed_mmps = 1;
  return config;
}

}  // namespace

TEST_CASE("Forward is x, left is y, a left turn raises yaw, millimetres and degrees") {
  const auto robot = use_fake_robot();
  const Open open;
  REQUIRE(hrt_go_forward(200) == HRT_OK);
  REQUIRE(hrt_turning(90) == HRT_OK);
  REQUIRE(hrt_go_forward(100) == HRT_OK);
  hrt_state state = hrt_state_init();
  REQUIRE(hrt_get_state(&state) == HRT_OK);
  CHECK(state.pose_x_mm == Approx(200).margin(2));
  CHECK(state.pose_y_mm == Approx(100).margin(2));
  CHECK(state.pose_z_mm == Approx(90));
  CHECK(state.pose_yaw_deg == Approx(90).margin(0.4));
  CHECK(state.yaw_deg == Approx(90).margin(0.4));
  CHECK(state.odometry_x_mm == Approx(state.pose_x_mm).margin(1));
  CHECK(state.odometry_y_mm == Approx(state.pose_y_mm).margin(1));
  CHECK(state.odometry_yaw_deg == Approx(90).margin(0.5));
  CHECK(state.acceleration_mmps2[2] == Approx(9806.65));
  CHECK(state.battery_v == Approx(25.9));
  CHECK(state.round_trip_ms == Approx(2));
  CHECK(state.valid == (HRT_HAS_POSTURE | HRT_HAS_ENCODERS | HRT_HAS_FLIPPERS | HRT_HAS_CURRENTS | HRT_HAS_BATTERY |
                        HRT_HAS_INERTIAL | HRT_HAS_POSE));
  CHECK((state.activity & HRT_IN_LOCKSTEP) != 0);
  CHECK((state.activity & HRT_MOTION_ACTIVE) == 0);
  CHECK(hrt_time() == state.time_s);
  CHECK(hrt_show_status() == HRT_OK);
}

TEST_CASE("Track speeds and flipper angles reach the transport in metres and radians, in order") {
  const auto robot = use_fake_robot();
  const Open open;
  REQUIRE(hrt_set_tracks(100, -50) == HRT_OK);
  REQUIRE(hrt_set_flipper(HRT_REAR_LEFT, 30) == HRT_OK);
  REQUIRE(hrt_wait_cycle(nullptr) == HRT_OK);
  {
    const std::lock_guard lock(robot->mutex);
    const kenaf::robot::Command& command = robot->commands.front();  // all of it in the very first cycle
    CHECK(command.track_speed_mps == std::array<double, 2>{0.1, -0.05});
    for (std::size_t i = 0; i < kenaf::robot::kFlipperCount; ++i)
      CHECK((command.flipper[i].mode == kenaf::robot::JointMode::angle) == (i == kenaf::robot::kRearLeft));
    CHECK(command.flipper[kenaf::robot::kRearLeft].value == Approx(30 * kDegree));
  }
  REQUIRE(hrt_set_flippers(10, 20, 30, 40) == HRT_OK);
  REQUIRE(hrt_wait_flippers(0.5, 10) == HRT_OK);
  hrt_state state = hrt_state_init();
  REQUIRE(hrt_get_state(&state) == HRT_OK);
  CHECK(state.flippers_commanded == 0xf);
  for (int i = 0; i < 4; ++i) {
    CHECK(state.flipper_deg[i] == Approx(10.0 * (i + 1)).margin(0.5));
    CHECK(state.commanded_flipper_deg[i] == Approx(10.0 * (i + 1)));
  }
}

TEST_CASE("Of a robot with front flippers, the rear ones are commanded in vain, are not waited for, and are 0") {
  const auto robot = use_fake_robot();
  for (const auto rear : {kenaf::robot::kRearLeft, kenaf::robot::kRearRight})
    robot->plant.flipper_rad[rear] = robot->plant.state.flipper_rad[rear] = kenaf::robot::kNoFlipper;
  const Open open;
  REQUIRE(hrt_set_flipper(HRT_ALL_FLIPPERS, 30) == HRT_OK);
  REQUIRE(hrt_wait_flippers(0.5, 10) == HRT_OK);
  hrt_state state = hrt_state_init();
  REQUIRE(hrt_get_state(&state) == HRT_OK);
  CHECK((state.valid & HRT_HAS_FLIPPERS) != 0);
  CHECK(state.flipper_deg[HRT_FRONT_RIGHT] == Approx(30).margin(0.5));
  CHECK(state.flippers_commanded == (1u << HRT_FRONT_LEFT | 1u << HRT_FRONT_RIGHT));
  CHECK(state.flipper_deg[HRT_REAR_LEFT] == 0);
  CHECK(state.flipper_deg[HRT_REAR_RIGHT] == 0);
  CHECK(hrt_stop() == HRT_OK);
  CHECK(hrt_show_status() == HRT_OK);
}

TEST_CASE("Sleeping counts robot time and takes whole cycles") {
  const auto robot = use_fake_robot();
  const Open open;
  const double start_s = hrt_time();
  REQUIRE(hrt_sleep(0.5) == HRT_OK);
  CHECK(hrt_time() - start_s == Approx(0.5));
  REQUIRE(hrt_sleep(0.011) == HRT_OK);
  CHECK(hrt_time() - start_s == Approx(0.52));
  REQUIRE(hrt_sleep(0) == HRT_OK);
  CHECK(hrt_time() - start_s == Approx(0.52));
  hrt_state state = hrt_state_init();
  REQUIRE(hrt_wait_cycle(&state) == HRT_OK);
  CHECK(state.time_s - start_s == Approx(0.53));
}

TEST_CASE("Without a robot every call says so") {
  hrt_state state = hrt_state_init();
  CHECK(hrt_go_forward(1) == HRT_E_NOT_INITIALISED);
  CHECK(hrt_turning(1) == HRT_E_NOT_INITIALISED);
  CHECK(hrt_set_tracks(0, 0) == HRT_E_NOT_INITIALISED);
  CHECK(hrt_set_flipper(HRT_ALL_FLIPPERS, 0) == HRT_E_NOT_INITIALISED);
  CHECK(hrt_set_flippers(0, 0, 0, 0) == HRT_E_NOT_INITIALISED);
  CHECK(hrt_wait_flippers(1, 1) == HRT_E_NOT_INITIALISED);
  CHECK(hrt_stop() == HRT_E_NOT_INITIALISED);
  CHECK(hrt_sleep(1) == HRT_E_NOT_INITIALISED);
  CHECK(hrt_get_state(&state) == HRT_E_NOT_INITIALISED);
  CHECK(hrt_wait_cycle(&state) == HRT_E_NOT_INITIALISED);
  CHECK(hrt_show_status() == HRT_E_NOT_INITIALISED);
  CHECK(hrt_record_start("x.csv") == HRT_E_NOT_INITIALISED);
  CHECK(hrt_record_stop() == HRT_E_NOT_INITIALISED);
  char warning[] = "what the caller had here";
  CHECK(hrt_get_warning(warning, sizeof warning) == HRT_E_NOT_INITIALISED);
  CHECK(hrt_get_setup(warning, sizeof warning) == HRT_E_NOT_INITIALISED);
  CHECK(std::string(warning).empty());
  CHECK(hrt_time() == -1);
  CHECK_THAT(hrt_last_error(), Catch::Contains("hrt_kenaf_init()"));
  CHECK(hrt_close() == HRT_OK);
}

TEST_CASE("Bad arguments are named and change nothing") {
  const auto robot = use_fake_robot();
  const Open open;
  for (const double bad : {kNaN, kInfinity, -kInfinity, 1e7, -1e7}) {
    CHECK(hrt_go_forward(bad) == HRT_E_ARGUMENT);
    CHECK(hrt_turning(bad) == HRT_E_ARGUMENT);
    CHECK(hrt_set_tracks(bad, 0) == HRT_E_ARGUMENT);
    CHECK(hrt_set_tracks(0, bad) == HRT_E_ARGUMENT);
    CHECK(hrt_set_flipper(HRT_FRONT_LEFT, bad) == HRT_E_ARGUMENT);
    CHECK(hrt_set_flippers(0, 0, 0, bad) == HRT_E_ARGUMENT);
    CHECK(hrt_sleep(bad) == HRT_E_ARGUMENT);
    CHECK(hrt_wait_flippers(bad, 1) == HRT_E_ARGUMENT);
    CHECK(hrt_wait_flippers(1, bad) == HRT_E_ARGUMENT);
  }
  CHECK_THAT(hrt_last_error(), Catch::StartsWith("hrt_wait_flippers: timeout_s must be from 0 to 3600"));
  CHECK(hrt_sleep(-1) == HRT_E_ARGUMENT);
  CHECK(hrt_set_flipper(HRT_ALL_FLIPPERS + 1, 0) == HRT_E_ARGUMENT);
  CHECK(hrt_set_flipper(-1, 0) == HRT_E_ARGUMENT);
  CHECK(hrt_get_state(nullptr) == HRT_E_ARGUMENT);
  hrt_state state = hrt_state_init();
  state.size = 0;
  CHECK(hrt_get_state(&state) == HRT_E_ARGUMENT);
  CHECK(hrt_wait_cycle(&state) == HRT_E_ARGUMENT);
  state.size = sizeof state + 8;  // of a header newer than this library
  CHECK(hrt_get_state(&state) == HRT_E_ARGUMENT);
  CHECK(hrt_record_start(nullptr) == HRT_E_ARGUMENT);
  CHECK(hrt_record_start("") == HRT_E_ARGUMENT);
  CHECK(hrt_record_start("/nonexistent/folder/x.csv") == HRT_E_RECORD);
  REQUIRE(hrt_wait_cycle(nullptr) == HRT_OK);
  const std::lock_guard lock(robot->mutex);
  CHECK(robot->commands.front().track_speed_mps == std::array<double, 2>{0, 0});
  CHECK(robot->commands.front().flipper == kenaf::robot::Command{}.flipper);
}

TEST_CASE("Every error has a name, and only those") {
  CHECK(std::string(hrt_error_name(HRT_OK)) == "HRT_OK");
  CHECK(std::string(hrt_error_name(HRT_E_STUCK)) == "HRT_E_STUCK");
  for (int error = HRT_E_INTERNAL; error <= HRT_E_NOT_INITIALISED; ++error) {
    CHECK_THAT(hrt_error_name(error), Catch::StartsWith("HRT_E_"));
  }
  CHECK(std::string(hrt_error_name(1)) == "unknown error");
  CHECK(std::string(hrt_error_name(HRT_E_INTERNAL - 1)) == "unknown error");
  CHECK(std::string(hrt_version()) == "0.1.0");
}

TEST_CASE("Cycles that cannot begin are an error of init, and the robot is closed") {
  const auto robot = use_fake_robot();
  robot->cycles_error = "the system refuses SCHED_FIFO";
  CHECK(hrt_kenaf_init() == HRT_E_CONFIG);
  CHECK(std::string(hrt_last_error()) == robot->cycles_error);
  CHECK(robot->closed);
  robot->cycles_error.clear();
  CHECK(hrt_kenaf_init() == HRT_OK);
  CHECK(hrt_close() == HRT_OK);
}

TEST_CASE("A thread that cannot be prepared for its cycles is an error of init, and ends") {
  const auto robot = use_fake_robot();
  robot->prepare_error = "the system refuses SCHED_FIFO";
  CHECK(hrt_kenaf_init() == HRT_E_CONFIG);
  CHECK(std::string(hrt_last_error()) == robot->prepare_error);
  CHECK(robot->closed);
  use_fake_robot();
  CHECK(hrt_kenaf_init() == HRT_OK);
  CHECK(hrt_close() == HRT_OK);
}

TEST_CASE("What init has set up is told in as many bytes as there are") {
  const auto robot = use_fake_robot();
  robot->setup = "track left watches its commands\ntrack right watches its commands";
  const Open open;
  std::array<char, 1000> text{};
  REQUIRE(hrt_get_setup(text.data(), text.size()) == HRT_OK);
  CHECK(text.data() == robot->setup);
  text.fill('x');
  REQUIRE(hrt_get_setup(text.data(), 11) == HRT_OK);
  CHECK(std::string(text.data(), 12) == std::string("track left\0x", 12));
  CHECK(hrt_get_setup(nullptr, 1) == HRT_E_ARGUMENT);
  CHECK(hrt_get_setup(text.data(), 0) == HRT_E_ARGUMENT);
}

TEST_CASE("A second init is busy, a closed robot can be opened again") {
  use_fake_robot();
  {
    const Open open;
    CHECK(hrt_kenaf_init() == HRT_E_BUSY);
    CHECK_THAT(hrt_last_error(), Catch::Contains("already open"));
  }
  use_fake_robot();
  const Open again;
  CHECK(hrt_go_forward(10) == HRT_OK);
}

TEST_CASE("Blocked tracks are stuck, and stand afterwards") {
  PlantSettings settings;
  settings.tracks_blocked = true;
  const auto robot = use_fake_robot(settings);
  const Open open;
  CHECK(hrt_go_forward(100) == HRT_E_STUCK);
  CHECK_THAT(hrt_last_error(), Catch::Contains("no progress"));
  hrt_state state = hrt_state_init();
  REQUIRE(hrt_wait_cycle(&state) == HRT_OK);
  CHECK(state.commanded_track_mmps[0] == 0);
  CHECK(state.commanded_track_mmps[1] == 0);
  CHECK(hrt_turning(30) == HRT_E_STUCK);
}

TEST_CASE("A broken link ends every call, and a new init opens anew") {
  const auto robot = use_fake_robot();
  robot->lost_at_frame = 40;
  {
    const Open open;
    CHECK(hrt_go_forward(1000) == HRT_E_LINK);
    CHECK(std::string(hrt_last_error()) == "the fake link broke");
    CHECK(hrt_set_tracks(1, 1) == HRT_E_LINK);
    CHECK(hrt_sleep(1) == HRT_E_LINK);
    CHECK(hrt_sleep(0) == HRT_E_LINK);
    CHECK(hrt_stop() == HRT_E_LINK);
    char warning[] = "what the caller had here";
    CHECK(hrt_get_warning(warning, sizeof warning) == HRT_E_LINK);
    CHECK(std::string(warning).empty());
    hrt_state state = hrt_state_init();
    CHECK(hrt_get_state(&state) == HRT_E_LINK);
    CHECK(state.cycle == 39);  // the last that arrived
    CHECK(hrt_show_status() == HRT_E_LINK);
    use_fake_robot();
    REQUIRE(hrt_kenaf_init() == HRT_OK);
    CHECK(hrt_go_forward(10) == HRT_OK);
  }
  CHECK(robot->closed);
}

TEST_CASE("A wait for states that ends without hrt_close() ends every call") {
  const auto robot = use_fake_robot();
  const Open open(unhurried());
  int result = HRT_OK;
  std::thread driver([&] { result = hrt_go_forward(1e6); });
  await_motion();
  {
    const std::lock_guard lock(robot->mutex);
    robot->interrupted = true;
    robot->changed.notify_all();
  }
  driver.join();
  CHECK(result == HRT_E_INTERNAL);
  CHECK(hrt_sleep(1) == HRT_E_INTERNAL);
}

TEST_CASE("Another thread stops a motion, and a second motion is busy") {
  const auto robot = use_fake_robot();
  const Open open(unhurried());
  int result = HRT_OK;
  std::string words;
  std::thread driver([&] {
    result = hrt_go_forward(1e6);
    words = hrt_last_error();
  });
  await_motion();
  CHECK(hrt_go_forward(1) == HRT_E_BUSY);
  CHECK(hrt_turning(1) == HRT_E_BUSY);
  CHECK(hrt_sleep(0.05) == HRT_OK);  // sleeping during a motion is allowed
  CHECK(hrt_stop() == HRT_OK);
  driver.join();
  CHECK(result == HRT_E_STOPPED);
  CHECK(words == "hrt_stop() ended this call");
  CHECK_THAT(hrt_last_error(), Catch::Contains("motion is running"));  // each thread has its own
  hrt_state state = hrt_state_init();
  REQUIRE(hrt_wait_cycle(&state) == HRT_OK);
  CHECK(state.commanded_track_mmps[0] == 0);
}

TEST_CASE("Direct track speeds take over from a motion") {
  const auto robot = use_fake_robot();
  const Open open(unhurried());
  int result = HRT_OK;
  std::thread driver([&] { result = hrt_go_forward(1e6); });
  await_motion();
  CHECK(hrt_set_tracks(10, 20) == HRT_OK);
  driver.join();
  CHECK(result == HRT_E_STOPPED);
}

TEST_CASE("Closing ends the calls of other threads") {
  const auto robot = use_fake_robot();
  const hrt_config config = unhurried();
  REQUIRE(hrt_kenaf_init_with(&config) == HRT_OK);
  int moved = HRT_OK, slept = HRT_OK;
  std::thread driver([&] { moved = hrt_go_forward(1e6); });
  std::thread sleeper([&] { slept = hrt_sleep(86400); });
  await_motion();
  CHECK(hrt_close() == HRT_OK);
  driver.join();
  sleeper.join();
  CHECK(moved == HRT_E_CLOSED);
  CHECK((slept == HRT_E_CLOSED || slept == HRT_E_NOT_INITIALISED));
  CHECK(robot->closed);
}

TEST_CASE("A robot that is being closed asks its transport nothing more") {
  const auto fake = use_fake_robot();
  kenaf::hrt::Robot robot(kenaf::hrt::make_transport(), hrt_config_default());
  kenaf::hrt::Snapshot snapshot = robot.snapshot();
  CHECK(snapshot.round_trip_s == 0.002);
  CHECK_FALSE(snapshot.lost);
  robot.close();
  snapshot = robot.snapshot();
  REQUIRE(snapshot.lost);
  CHECK(snapshot.lost->code == HRT_E_CLOSED);
  CHECK(snapshot.lost->text == "hrt_close() was called");
  CHECK(snapshot.round_trip_s == 0);
  CHECK(snapshot.measured.frame > 0);
}

TEST_CASE("Flippers that do not arrive are named, and hrt_stop leaves them where they are") {
  const auto robot = use_fake_robot();
  const Open open;
  CHECK(hrt_wait_flippers(1, 0) == HRT_OK);  // none was ever commanded
  REQUIRE(hrt_set_flippers(0, 170, 0, 170) == HRT_OK);
  CHECK(hrt_wait_flippers(1, 0.1) == HRT_E_TIMEOUT);
  CHECK_THAT(hrt_last_error(), Catch::EndsWith("not reached within 0.1 s: front right, rear right"));
  REQUIRE(hrt_stop() == HRT_OK);
  hrt_state state = hrt_state_init();
  REQUIRE(hrt_wait_cycle(&state) == HRT_OK);
  // 1.5 rad/s for the 0.1 s that the flippers moved, and for the cycle whose answer hrt_stop() came too late for.
  CHECK(state.commanded_flipper_deg[1] == Approx(0.1 * 1.5 / kDegree).margin(1));
  CHECK(state.commanded_flipper_deg[0] == 0);
}

TEST_CASE("A call that is held up with the mutex holds up no cycle, and no command outlasts command_timeout_s") {
  const kenaf::support::TemporaryFolder folder;
  const std::string file = (folder.path() / "run.csv").string();
  const auto fake = use_fake_robot();
  fake->lockstep = false;
  fake->paused_after = 10;
  kenaf::hrt::Robot robot(kenaf::hrt::make_transport(), hrt_config_default());  // command_timeout_s: 10 cycles
  // Lets the robot go on to this frame, and waits until that is answered: commands[i] answers frame i + 1.
  const auto run_to = [&](std::uint32_t frame) {
    {
      const std::lock_guard lock(fake->mutex);
      fake->paused_after = frame;
    }
    fake->changed.notify_all();
    REQUIRE(kenaf::support::eventually([&] {
      const std::lock_guard lock(fake->mutex);
      return fake->commands.size() == frame;
    }));
  };
  run_to(10);
  robot.record_start(file);
  robot.set_tracks(0.1, 0.1);
  run_to(15);
  {
    const auto held = robot.hold_mutex();
    run_to(55);
  }
  run_to(60);
  robot.record_stop();
  robot.close();

  // commanded in frame 10, in the answers from 11 on; 16 to 20 repeat it, and then its 10 cycles are over
  for (std::size_t frame = 11; frame <= 20; ++frame) CHECK(fake->commands[frame - 1].track_speed_mps[0] == 0.1);
  for (std::size_t frame = 21; frame <= 60; ++frame) CHECK(fake->commands[frame - 1].track_speed_mps[0] == 0);
  // every state was taken in afterwards, with the command that was in force
  const kenaf::runs::Run run = kenaf::runs::read_run(file);
  const auto frame = run.column("frame"), commanded = run.column("cmd_track_left_mps");
  REQUIRE(run.row_count() == 51);
  for (std::size_t row = 0; row < run.row_count(); ++row) {
    CHECK(frame[row] == static_cast<double>(10 + row));
    CHECK(commanded[row] == fake->commands[8 + row].track_speed_mps[0]);
  }
}

TEST_CASE("Lost cycles are counted") {
  const auto robot = use_fake_robot();
  robot->skipped_frame = 5;
  const Open open;
  REQUIRE(hrt_sleep(0.1) == HRT_OK);
  hrt_state state = hrt_state_init();
  REQUIRE(hrt_get_state(&state) == HRT_OK);
  CHECK(state.lost_cycles == 1);
}

TEST_CASE("In lock step the same program gives the same commands however long it thinks") {
  const auto drive = [](int longest_thought_us) {
    PlantSettings settings;
    settings.turn_efficiency = 0.6;
    settings.yaw_noise_rad = 0.1 * kDegree;
    const auto robot = use_fake_robot(settings);
    std::mt19937 generator(7);
    const auto think = [&] {
      const auto thought = std::chrono::microseconds(generator() % static_cast<unsigned>(longest_thought_us + 1));
      std::this_thread::sleep_for(thought);
    };
    hrt_config config = hrt_config_default();
    config.hold_s = 0.2;  // a busy machine must not fail the test
    REQUIRE(hrt_kenaf_init_with(&config) == HRT_OK);
    std::uint64_t last_cycle = 0;
    for (int side = 0; side < 2; ++side) {
      think();
      REQUIRE(hrt_go_forward(50) == HRT_OK);
      think();
      REQUIRE(hrt_set_flipper(HRT_ALL_FLIPPERS, 20 + side) == HRT_OK);
      think();
      REQUIRE(hrt_turning(45) == HRT_OK);
      think();
      REQUIRE(hrt_set_tracks(30, 20) == HRT_OK);
      think();
      REQUIRE(hrt_sleep(0.2) == HRT_OK);
      hrt_state state = hrt_state_init();
      for (int i = 0; i < 20; ++i) {
        REQUIRE(hrt_wait_cycle(&state) == HRT_OK);
        if (i % 4 == 0) think();
        REQUIRE(hrt_set_tracks(state.track_mm[0] / 10, state.track_mm[1] / 10) == HRT_OK);
      }
      last_cycle = state.cycle;
    }
    REQUIRE(hrt_close() == HRT_OK);
    const std::lock_guard lock(robot->mutex);
    REQUIRE(robot->commands.size() + 1 >= last_cycle);
    robot->commands.resize(last_cycle - 1);
    return robot->commands;
  };
  const std::vector<kenaf::robot::Command> quick = drive(0), slow = drive(5000);
  REQUIRE(quick.size() == slow.size());
  for (std::size_t i = 0; i < quick.size(); ++i) {
    CAPTURE(i);
    REQUIRE(quick[i].track_speed_mps == slow[i].track_speed_mps);  // to the last bit
    REQUIRE(quick[i].flipper == slow[i].flipper);
  }
}

TEST_CASE("Two threads that take turns give the same run as well") {
  // The commands of the first 50 cycles, in which both threads are at work; none where this machine was too busy for
  // the two of them to begin in the same cycle.
  const auto drive = [](std::chrono::milliseconds thought) {
    const auto robot = use_fake_robot();
    hrt_config config = hrt_config_default();
    config.hold_s = 0.2;
    REQUIRE(hrt_kenaf_init_with(&config) == HRT_OK);
    const double start_s = hrt_time();
    std::atomic<bool> begins = false, fine = true;
    std::thread flipper_thread([&] {
      begins = true;
      for (int i = 0; i < 5; ++i) {
        fine = fine && hrt_sleep(0.1) == HRT_OK;
        std::this_thread::sleep_for(thought);
        fine = fine && hrt_set_flipper(HRT_FRONT_LEFT, 5 * i) == HRT_OK;
      }
    });
    while (!begins) std::this_thread::sleep_for(1ms);
    std::this_thread::sleep_for(40ms);
    const bool together = hrt_time() == start_s;
    for (int i = 0; i < 4; ++i) fine = fine && hrt_go_forward(10) == HRT_OK;
    flipper_thread.join();
    REQUIRE(hrt_close() == HRT_OK);
    REQUIRE(fine);
    const std::lock_guard lock(robot->mutex);
    robot->commands.resize(together ? 50 : 0);
    return robot->commands;
  };
  const auto drive_together = [&](std::chrono::milliseconds thought) {
    for (;;) {
      if (const auto commands = drive(thought); !commands.empty()) return commands;
    }
  };
  const auto quick = drive_together(0ms), slow = drive_together(5ms);
  for (std::size_t i = 0; i < quick.size(); ++i) {
    CAPTURE(i);
    REQUIRE(quick[i].track_speed_mps == slow[i].track_speed_mps);
    REQUIRE(quick[i].flipper == slow[i].flipper);
  }
}

TEST_CASE("A program that waits on the wall clock goes on after the hold") {
  const auto robot = use_fake_robot();
  const Open open;
  const double before_s = hrt_time();
  while (hrt_time() == before_s) std::this_thread::sleep_for(1ms);  // ends: robot time runs on by itself
  CHECK(hrt_go_forward(10) == HRT_OK);
}

TEST_CASE("A program that waits for a processor is waited for") {
  // On one processor with it, a neighbour takes 1024 parts of 1039 (sched(7): nice 0 and 19) for three times hold_s.
  // Where this machine is so busy that it takes nearly as long as the longest hold, it tells nothing.
  cpu_set_t all, one;
  REQUIRE(sched_getaffinity(0, sizeof all, &all) == 0);
  CPU_ZERO(&one);
  for (int cpu = 0; CPU_COUNT(&one) == 0; ++cpu) {
    if (CPU_ISSET(cpu, &all)) CPU_SET(cpu, &one);
  }
  for (bool is_valid = false; !is_valid;) {
    use_fake_robot();
    const Open open;
    std::atomic<bool> is_there = false, begins = false, done = false;
    std::thread neighbour([&] {
      sched_setaffinity(0, sizeof one, &one);
      is_there = true;
      while (!begins) {
      }
      const auto start = std::chrono::steady_clock::now();
      while (std::chrono::steady_clock::now() < start + 150ms) {
      }
      done = true;
    });
    double start_s = 0, end_s = 1;
    std::thread program([&] {  // a thread of its own, as it stays as nice as it is
      while (!is_there) std::this_thread::sleep_for(1ms);
      is_valid = hrt_wait_cycle(nullptr) != HRT_OK;
      if (is_valid) return;
      const auto start = std::chrono::steady_clock::now();
      start_s = hrt_time();
      setpriority(PRIO_PROCESS, 0, 19);
      begins = true;
      sched_setaffinity(0, sizeof one, &one);
      while (!done) {
      }
      end_s = hrt_time();
      is_valid = std::chrono::steady_clock::now() < start + 800ms;
    });
    program.join();
    begins = true;
    neighbour.join();
    if (is_valid) CHECK(end_s == start_s);
  }
}

TEST_CASE("Track speeds hold while the program calls, and stop command_timeout_s after its last call") {
  const auto robot = use_fake_robot();
  hrt_config config = hrt_config_default();
  config.command_timeout_s = 0.3;
  const Open open(config);
  REQUIRE(hrt_set_tracks(100, 100) == HRT_OK);
  REQUIRE(hrt_sleep(2) == HRT_OK);      // calling all the while
  const double last_call_s = 0.01 + 2;  // the first cycle is at 0.01 s
  const double moving_until_s = 0.01 * static_cast<double>(last_moving_frame(*robot));
  CHECK(moving_until_s - last_call_s == Approx(0.3).margin(0.011));
  hrt_state state = hrt_state_init();
  REQUIRE(hrt_wait_cycle(&state) == HRT_OK);
  REQUIRE(hrt_wait_cycle(&state) == HRT_OK);
  CHECK(state.commanded_track_mmps[0] == 0);  // stopped for good, until commanded anew
}

TEST_CASE("Tracks that were stopped by silence are said to be, until they are commanded anew") {
  const auto robot = use_fake_robot();
  robot->lockstep = false;
  robot->runs_alone = true;
  const Open open;
  const auto is_stopped_by_silence = [] {
    hrt_state state = hrt_state_init();
    REQUIRE(hrt_get_state(&state) == HRT_OK);
    return (state.activity & HRT_STOPPED_BY_SILENCE) != 0;
  };
  const auto be_silent = [&] {
    const std::size_t begin = [&] {
      const std::lock_guard lock(robot->mutex);
      return robot->commands.size();
    }();
    // the timeout is ten cycles
    for (bool passed = false; !passed;) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      const std::lock_guard lock(robot->mutex);
      passed = robot->commands.size() > begin + 20;
    }
  };
  be_silent();
  CHECK_FALSE(is_stopped_by_silence());  // they stood
  const std::pair<const char*, std::function<int()>> anew[] = {{"tracks", [] { return hrt_set_tracks(0, 0); }},
                                                               {"stop", [] { return hrt_stop(); }},
                                                               {"motion", [] { return hrt_go_forward(1); }}};
  for (const auto& [what, command] : anew) {
    REQUIRE(hrt_set_tracks(100, 100) == HRT_OK);
    be_silent();
    CAPTURE(what);
    CHECK(is_stopped_by_silence());
    CHECK(is_stopped_by_silence());  // asking changes nothing
    REQUIRE(command() == HRT_OK);
    CHECK_FALSE(is_stopped_by_silence());
  }
}

TEST_CASE("A sleep of no time counts as a call") {
  // Where this thread was kept from calling for half of the timeout, which is a hundred cycles, it tells nothing.
  for (bool is_valid = false; !is_valid;) {
    const auto robot = use_fake_robot();
    robot->lockstep = false;
    hrt_config config = hrt_config_default();
    config.command_timeout_s = 1;
    const Open open(config);
    const auto cycles = [&] {
      const std::lock_guard lock(robot->mutex);
      return robot->commands.size();
    };
    std::size_t now = cycles(), longest = 0;
    const std::size_t end = now + 300;
    REQUIRE(hrt_set_tracks(100, 100) == HRT_OK);
    while (now < end) {
      REQUIRE(hrt_sleep(0) == HRT_OK);
      const std::size_t before = std::exchange(now, cycles());
      longest = std::max(longest, now - before);
    }
    is_valid = longest < 50;
    const std::lock_guard lock(robot->mutex);
    if (is_valid) CHECK(robot->commands[now - 1].track_speed_mps[0] != 0);
  }
}

TEST_CASE("Track speeds stop as early where the world is reset meanwhile") {
  const auto robot = use_fake_robot();
  robot->reset_at_frame = 205;
  hrt_config config = hrt_config_default();
  config.command_timeout_s = 0.3;
  const Open open(config);
  REQUIRE(hrt_set_tracks(100, 100) == HRT_OK);
  REQUIRE(hrt_sleep(2) == HRT_OK);
  // cycle 201 is the last call's; 30 cycles are 0.3 s; the one in which the clock is put back does not count
  const std::size_t frame = last_moving_frame(*robot);
  CHECK(frame >= 231);
  CHECK(frame <= 233);
}

TEST_CASE("A motion during which the world is reset ends and says so, and the next one drives as far as it should") {
  const auto robot = use_fake_robot();
  robot->reset_at_frame = 200;
  const Open open;
  // At 200 mm/s from 0.5 s on, where 50 mm are driven, up to 2 s: 350 mm, less 10 mm of the drives' lag of 0.05 s.
  CHECK(hrt_go_forward(1000) == HRT_E_STOPPED);
  CHECK(std::string(hrt_last_error()).find("reset the world") != std::string::npos);
  hrt_state state = hrt_state_init();
  REQUIRE(hrt_get_state(&state) == HRT_OK);
  const double driven_mm = state.odometry_x_mm;
  CHECK(driven_mm == Approx(340).margin(8));
  CHECK(state.cycle == 200);
  CHECK(state.track_mm[0] == 0);
  CHECK(hrt_go_forward(100) == HRT_OK);
  CHECK(hrt_turning(90) == HRT_OK);
  REQUIRE(hrt_get_state(&state) == HRT_OK);
  CHECK(state.odometry_x_mm - driven_mm == Approx(100).margin(1));
  CHECK(state.odometry_yaw_deg == Approx(90).margin(1));
  CHECK(robot->plant.x_m == Approx(0.1).margin(1e-3));
}

TEST_CASE("Where the world is reset, sleeping and a recording go on") {
  const kenaf::support::TemporaryFolder folder;
  const std::string file = (folder.path() / "run.csv").string();
  const auto robot = use_fake_robot();
  robot->reset_at_frame = 1000;
  hrt_config config = hrt_config_default();
  config.hold_s = 0.2;
  file.copy(config.record, sizeof config.record - 1);
  REQUIRE(hrt_kenaf_init_with(&config) == HRT_OK);
  hrt_state before = hrt_state_init(), after = hrt_state_init();
  REQUIRE(hrt_sleep(9) == HRT_OK);
  REQUIRE(hrt_get_state(&before) == HRT_OK);
  REQUIRE(hrt_sleep(2) == HRT_OK);
  REQUIRE(hrt_get_state(&after) == HRT_OK);
  REQUIRE(hrt_close() == HRT_OK);
  CHECK(after.time_s < before.time_s);
  CHECK(after.cycle - before.cycle == 201);  // the reset's own takes no time that is known
  const kenaf::runs::Run run = kenaf::runs::read_run(file);
  CHECK(run.row_count() == after.cycle - 1);
  CHECK(run.column("t_s").back() == Approx(11));
  CHECK(run.column("robot_time_s").back() == Approx(after.time_s));
}

TEST_CASE("A recording has every cycle once, with what was commanded and measured") {
  const kenaf::support::TemporaryFolder folder;
  const std::string file = (folder.path() / "run.csv").string();
  const auto robot = use_fake_robot();
  hrt_config config = hrt_config_default();
  file.copy(config.record, sizeof config.record - 1);
  REQUIRE(hrt_kenaf_init_with(&config) == HRT_OK);
  REQUIRE(hrt_set_flipper(HRT_FRONT_LEFT, 10) == HRT_OK);
  REQUIRE(hrt_go_forward(100) == HRT_OK);
  CHECK(hrt_record_start(file.c_str()) == HRT_E_BUSY);
  CHECK_FALSE(std::filesystem::exists(file));
  hrt_state last = hrt_state_init();
  REQUIRE(hrt_get_state(&last) == HRT_OK);
  REQUIRE(hrt_close() == HRT_OK);

  const kenaf::runs::Run run = kenaf::runs::read_run(file);
  const std::size_t rows = run.row_count();
  CHECK(rows == last.cycle);
  const auto t = run.column("t_s"), frame = run.column("frame"), x = run.column("x_m");
  const auto command = run.column("cmd_track_left_mps"), track = run.column("track_left_m");
  const auto flipper = run.column("cmd_flipper_fl_rad"), other = run.column("cmd_flipper_fr_rad");
  CHECK(t[0] == 0);
  CHECK(command[0] == 0);
  CHECK(std::isnan(flipper[0]));
  CHECK(std::isnan(other[rows - 1]));
  double integral_m = 0, belt_mps = 0;
  for (std::size_t i = 0; i < rows; ++i) {
    REQUIRE(frame[i] == static_cast<double>(i + 1));
    REQUIRE(t[i] == Approx(0.01 * static_cast<double>(i)).margin(1e-12));
    REQUIRE(x[i] == Approx(track[i]).margin(1e-9));
    // A row's command is in force from its time on: the plant driven by it gives the next row.
    REQUIRE(track[i] == Approx(integral_m).margin(1e-9));
    if (i + 1 < rows) REQUIRE(command[i + 1] == robot->commands[i].track_speed_mps[0]);
    belt_mps += (command[i] - belt_mps) * -std::expm1(-0.01 / 0.05);
    integral_m += belt_mps * 0.01;
  }
  CHECK(flipper[1] == Approx(10 * kDegree));
}

TEST_CASE("A recording ends with the cycle in which hrt_close() is called, however late the robot hears of it") {
  const auto rows_of = [](int late_interrupts) {
    const kenaf::support::TemporaryFolder folder;
    const std::string file = (folder.path() / "run.csv").string();
    const auto robot = use_fake_robot();
    robot->late_interrupts = late_interrupts;
    hrt_config config = hrt_config_default();
    config.hold_s = 0.2;
    file.copy(config.record, sizeof config.record - 1);
    REQUIRE(hrt_kenaf_init_with(&config) == HRT_OK);
    REQUIRE(hrt_set_tracks(50, 50) == HRT_OK);
    REQUIRE(hrt_sleep(0.1) == HRT_OK);
    REQUIRE(hrt_close() == HRT_OK);
    return kenaf::runs::read_run(file).row_count();
  };
  // Cycles at 0, 0.01 ... 0.1 s.
  for (const int late : {0, 1, 3}) CHECK(rows_of(late) == 11);
}

TEST_CASE("A recording of many cycles loses none, begins at the newest cycle and ends on request") {
  const kenaf::support::TemporaryFolder folder;
  const std::string file = (folder.path() / "run.csv").string();
  use_fake_robot();
  const Open open;
  // robot time goes on where a machine stalls this thread for longer than hold_s
  std::uint32_t activity = 0;
  const auto newest_cycle = [&activity] {
    hrt_state state = hrt_state_init();
    REQUIRE(hrt_get_state(&state) == HRT_OK);
    activity = state.activity;
    return static_cast<double>(state.cycle);
  };
  REQUIRE(hrt_sleep(0.1) == HRT_OK);
  const double before = newest_cycle();
  REQUIRE(hrt_record_start(file.c_str()) == HRT_OK);
  const double begun = newest_cycle();
  CHECK((activity & HRT_RECORDING) != 0);
  REQUIRE(hrt_sleep(120) == HRT_OK);  // 12000 cycles: more than the queue holds
  const double ending = newest_cycle();
  REQUIRE(hrt_record_stop() == HRT_OK);
  const double after = newest_cycle();
  CHECK(hrt_record_stop() == HRT_E_RECORD);

  const kenaf::runs::Run run = kenaf::runs::read_run(file);
  const auto frame = run.column("frame");
  CHECK(frame.front() >= before);
  CHECK(frame.front() <= begun);
  CHECK(frame.back() >= ending);
  CHECK(frame.back() <= after);
  CHECK(static_cast<double>(run.row_count()) == frame.back() - frame.front() + 1);
  CHECK(run.row_count() > 12000);
}

TEST_CASE("A recording that cannot be begun is an error of init") {
  const auto robot = use_fake_robot();
  hrt_config config = hrt_config_default();
  std::string("/nonexistent/folder/run.csv").copy(config.record, sizeof config.record - 1);
  CHECK(hrt_kenaf_init_with(&config) == HRT_E_RECORD);
  CHECK_THAT(hrt_last_error(), Catch::Contains("/nonexistent/folder/run.csv"));
  CHECK(robot->closed);
}
