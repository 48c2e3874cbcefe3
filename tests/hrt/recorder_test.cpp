// A recording runs beside the cycle, on a disk that stalls: a pipe that nobody reads stands for the disk, so that the
// test and not a clock decides how long it stalls. No cycle may wait for the disk, rows are lost only beyond the length
// of the queue, and every loss is counted and reported. A disk that is full says so at once: a limit on the size of the
// process's files stands for it, and the robot drives on. A row holds the values that were measured for it and the
// command in force, and the environment variable records as the call does.
#include "hrt/recorder.hpp"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <system_error>
#include <thread>

#include "formats/runs/run_file.hpp"
#include "hrt/error.hpp"
#include "kenaf/hrt.h"
#include "robot/state.hpp"
#include "tests/hrt/fake_transport.hpp"
#include "tests/support/process.hpp"

using namespace kenaf;
using hrt::Recorder;

namespace {

// Where a recording to `file` is written to its temporary file: nothing more than a pipe holds, 64 KiB, goes there
// before resume().
class StalledDisk {
 public:
  // `makes_file`: at once; otherwise who opens it to write waits for resume(), too.
  explicit StalledDisk(const std::string& file, bool makes_file = true) : part_(file + ".part") {
    REQUIRE(::mkfifo(part_.c_str(), 0600) == 0);
    if (makes_file) open(O_NONBLOCK);
  }
  ~StalledDisk() {
    if (reader_.joinable()) reader_.join();
    if (descriptor_ >= 0) ::close(descriptor_);
  }
  StalledDisk(const StalledDisk&) = delete;
  StalledDisk& operator=(const StalledDisk&) = delete;

  // Takes all from now on, until the recording is closed.
  void resume() {
    if (descriptor_ < 0) open(0);
    REQUIRE(::fcntl(descriptor_, F_SETFL, 0) == 0);  // reading waits
    reader_ = std::thread([this] {
      std::array<char, 65536> chunk;
      for (ssize_t count; (count = ::read(descriptor_, chunk.data(), chunk.size())) > 0;)
        bytes_.append(chunk.data(), static_cast<std::size_t>(count));
    });
  }
  // After the recording was closed.
  runs::Run written() {
    reader_.join();
    return runs::parse_run(bytes_, "recording");
  }

 private:
  void open(int flags) {
    descriptor_ = ::open(part_.c_str(), O_RDONLY | O_CLOEXEC | flags);
    REQUIRE(descriptor_ >= 0);
  }

  std::string part_;
  int descriptor_ = -1;
  std::thread reader_;
  std::string bytes_;
};

// No file of this process grows beyond `bytes`: writing more fails, as on a full disk, after a part of a row has gone.
class FullDisk {
 public:
  explicit FullDisk(rlim_t bytes) : signal_before_(std::signal(SIGXFSZ, SIG_IGN)) {
    REQUIRE(::getrlimit(RLIMIT_FSIZE, &before_) == 0);
    const rlimit limit{bytes, before_.rlim_max};
    REQUIRE(::setrlimit(RLIMIT_FSIZE, &limit) == 0);
  }
  ~FullDisk() {
    ::setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, signal_before_);
  }
  FullDisk(const FullDisk&) = delete;
  FullDisk& operator=(const FullDisk&) = delete;

 private:
  rlimit before_{};
  void (*signal_before_)(int);
};

std::string warning_now() {
  std::array<char, 1024> text{};
  REQUIRE(hrt_get_warning(text.data(), text.size()) == HRT_OK);
  return text.data();
}

std::uint32_t activity_now() {
  hrt_state state = hrt_state_init();
  REQUIRE(hrt_get_state(&state) == HRT_OK);
  return state.activity;
}

robot::State state_of(std::uint32_t frame) {
  robot::State state{};
  state.frame = frame;
  state.robot_time_s = 0.01 * frame;
  return state;
}

std::string recording_in(const support::TemporaryFolder& folder) {
  return (folder.path() / "run.csv").string();
}

}  // namespace

TEST_CASE("A disk that stalls for as many cycles as the queue holds costs neither a wait nor a row") {
  const support::TemporaryFolder folder;
  StalledDisk disk(recording_in(folder));
  Recorder recorder(recording_in(folder), false);
  // If one add() waited for the disk, it would wait for good: nobody reads before all of them are done.
  constexpr std::uint32_t kRows = Recorder::kQueueRows;
  for (std::uint32_t i = 0; i < kRows; ++i) recorder.add(state_of(i), robot::Command{}, 0.01 * i);
  disk.resume();
  recorder.finish();
  const runs::Run run = disk.written();
  REQUIRE(run.row_count() == kRows);
  for (std::size_t i = 0; i < kRows; ++i) REQUIRE(run.column("frame")[i] == static_cast<double>(i));
}

TEST_CASE("A disk that stalls for longer loses rows, still without a wait, and the recording says how many") {
  const support::TemporaryFolder folder;
  std::ofstream(recording_in(folder)) << "of before";
  StalledDisk disk(recording_in(folder));
  Recorder recorder(recording_in(folder), false);
  constexpr std::uint32_t kRows = 3 * Recorder::kQueueRows;
  for (std::uint32_t i = 0; i < kRows; ++i) recorder.add(state_of(i), robot::Command{}, 0.01 * i);
  disk.resume();
  std::string said;
  try {
    recorder.finish();
  } catch (const hrt::Error& error) {
    CHECK(error.code() == HRT_E_RECORD);
    said = error.what();
  }
  const runs::Run run = disk.written();
  // A row of a state without values is more than 32 bytes, so that the pipe takes fewer than 2048 of them.
  CHECK(run.row_count() >= Recorder::kQueueRows);
  CHECK(run.row_count() < Recorder::kQueueRows + 2048);
  CHECK_THAT(said, Catch::Contains(std::to_string(kRows - run.row_count()) + " rows are missing"));
  // one with holes is no recording: it stays a temporary file, and what was recorded before stays too
  CHECK(std::filesystem::exists(recording_in(folder) + ".part"));
  std::string text;
  std::getline(std::ifstream(recording_in(folder)), text);
  CHECK(text == "of before");
}

TEST_CASE("A robot that does not wait for its program is answered in every cycle while the disk stalls") {
  const support::TemporaryFolder folder;
  StalledDisk disk(recording_in(folder));
  const auto robot = hrt::test::use_fake_robot();
  robot->lockstep = false;
  REQUIRE(hrt_kenaf_init() == HRT_OK);
  REQUIRE(hrt_record_start(recording_in(folder).c_str()) == HRT_OK);
  REQUIRE(hrt_set_tracks(100, 100) == HRT_OK);
  // 40 s are 4000 cycles, twice what the pipe takes. The fake robot goes on only when a cycle is answered, so that one
  // that waited for the disk would never end.
  REQUIRE(hrt_sleep(40) == HRT_OK);
  disk.resume();
  REQUIRE(hrt_record_stop() == HRT_OK);
  REQUIRE(hrt_close() == HRT_OK);
  const runs::Run run = disk.written();
  CHECK(run.row_count() >= 4000);
  const auto frame = run.column("frame"), late = run.column("late_commands");
  for (std::size_t i = 0; i < run.row_count(); ++i) {
    REQUIRE(frame[i] == frame[0] + static_cast<double>(i));
    REQUIRE(late[i] == 0);
  }
}

TEST_CASE("A full disk is told while the robot drives on, and keeps what was written before") {
  const support::TemporaryFolder folder;
  const auto robot = hrt::test::use_fake_robot();
  REQUIRE(hrt_kenaf_init() == HRT_OK);
  REQUIRE(hrt_record_start(recording_in(folder).c_str()) == HRT_OK);
  REQUIRE(hrt_sleep(0.1) == HRT_OK);
  CHECK((activity_now() & HRT_RECORDING) != 0);
  CHECK((activity_now() & HRT_DEGRADED) == 0);
  CHECK(warning_now().empty());
  std::string said;
  {
    const FullDisk full(16384);  // 0.1 s are 10 rows, of less than 1024 bytes each
    while ((activity_now() & HRT_RECORDING) != 0) REQUIRE(hrt_wait_cycle(nullptr) == HRT_OK);
    CHECK((activity_now() & HRT_DEGRADED) != 0);
    said = warning_now();
    CHECK_THAT(said, Catch::Contains("the recording is incomplete: " + recording_in(folder) +
                                     ".part: cannot be written: " + std::generic_category().message(EFBIG)));
    REQUIRE(hrt_go_forward(50) == HRT_OK);
  }
  // room on the disk again: a recording with a hole is none, so it does not go on
  REQUIRE(hrt_sleep(0.1) == HRT_OK);
  CHECK((activity_now() & HRT_RECORDING) == 0);
  CHECK(warning_now() == said);
  CHECK(hrt_record_start((folder.path() / "next.csv").c_str()) == HRT_E_BUSY);
  CHECK_THAT(hrt_last_error(), Catch::Contains("hrt_record_stop()") && Catch::Contains(said));

  CHECK(hrt_record_stop() == HRT_E_RECORD);
  CHECK(hrt_last_error() == said);
  CHECK(warning_now().empty());
  CHECK_FALSE(std::filesystem::exists(recording_in(folder)));
  // the row that the limit cut is left out when the part file is read
  const std::string part = recording_in(folder) + ".part";
  CHECK(std::filesystem::file_size(part) == 16384);
  CHECK(runs::read_run(part).row_count() > 10);
  CHECK(hrt_record_start((folder.path() / "next.csv").c_str()) == HRT_OK);
  CHECK((activity_now() & HRT_RECORDING) != 0);
  CHECK(hrt_close() == HRT_OK);
}

TEST_CASE("A disk without room for the first line refuses the recording") {
  const support::TemporaryFolder folder;
  std::filesystem::create_symlink("/dev/full", recording_in(folder) + ".part");
  hrt::test::use_fake_robot();
  REQUIRE(hrt_kenaf_init() == HRT_OK);
  CHECK(hrt_record_start(recording_in(folder).c_str()) == HRT_E_RECORD);
  CHECK_THAT(hrt_last_error(),
             Catch::Contains(recording_in(folder)) && Catch::Contains(std::generic_category().message(ENOSPC)));
  CHECK((activity_now() & HRT_RECORDING) == 0);
  CHECK(hrt_close() == HRT_OK);
}

TEST_CASE("Rows that a slow disk costs are told while it is recorded on") {
  const support::TemporaryFolder folder;
  StalledDisk disk(recording_in(folder));
  Recorder recorder(recording_in(folder), false);
  constexpr std::uint32_t kRows = 3 * Recorder::kQueueRows;
  for (std::uint32_t i = 0; i < kRows; ++i) recorder.add(state_of(i), robot::Command{}, 0.01 * i);
  CHECK_THAT(recorder.trouble(), Catch::Contains("rows are missing, because the disk was too slow"));
  CHECK(recorder.is_writing());
  disk.resume();
  CHECK_THROWS_AS(recorder.finish(), hrt::Error);
}

TEST_CASE("Cycles go on while the disk makes the file of a recording") {
  const support::TemporaryFolder folder;
  StalledDisk disk(recording_in(folder), false);
  const auto robot = hrt::test::use_fake_robot();
  robot->lockstep = false;
  REQUIRE(hrt_kenaf_init() == HRT_OK);
  int started = HRT_E_INTERNAL;
  std::thread starter([&] { started = hrt_record_start(recording_in(folder).c_str()); });
  // 4000 cycles are a tenth of a second at least: a start that kept them waiting would keep this call for good
  CHECK(hrt_sleep(40) == HRT_OK);
  disk.resume();
  starter.join();
  CHECK(started == HRT_OK);
  CHECK(hrt_sleep(0.1) == HRT_OK);
  CHECK(hrt_record_stop() == HRT_OK);
  REQUIRE(hrt_close() == HRT_OK);
  CHECK(disk.written().row_count() >= 10);
}

TEST_CASE("Closing a robot that does not show that it stopped says so, and the recording is whole all the same") {
  const support::TemporaryFolder folder;
  const auto robot = hrt::test::use_fake_robot();
  robot->close_error = "closed, but track right (node 2) did not stop";
  REQUIRE(hrt_kenaf_init() == HRT_OK);
  REQUIRE(hrt_record_start(recording_in(folder).c_str()) == HRT_OK);
  REQUIRE(hrt_sleep(0.1) == HRT_OK);
  CHECK(hrt_close() == HRT_E_DEVICE);
  CHECK(std::string(hrt_last_error()) == robot->close_error);
  CHECK(std::filesystem::exists(recording_in(folder)));
  // it is closed: there is nothing left to close, and it can be opened again
  CHECK(hrt_close() == HRT_OK);
  CHECK(hrt_kenaf_init() == HRT_OK);
  robot->close_error.clear();
  CHECK(hrt_close() == HRT_OK);
}

TEST_CASE("A lost robot is closed before a new one is opened, also while its recording waits for the disk") {
  const support::TemporaryFolder folder;
  StalledDisk disk(recording_in(folder));
  const auto lost = hrt::test::use_fake_robot();
  lost->lockstep = false;
  REQUIRE(hrt_kenaf_init() == HRT_OK);
  REQUIRE(hrt_record_start(recording_in(folder).c_str()) == HRT_OK);
  REQUIRE(hrt_sleep(10) == HRT_OK);  // 1000 rows are more than the pipe takes: the recording's end waits for it
  {
    const std::lock_guard lock(lost->mutex);
    lost->lost_at_frame = 1;
  }
  while (hrt_wait_cycle(nullptr) == HRT_OK) {
  }
  int stopped = HRT_E_INTERNAL;
  std::thread stopper([&] { stopped = hrt_record_stop(); });
  hrt_state state = hrt_state_init();
  do {
    std::this_thread::yield();
    CHECK(hrt_get_state(&state) == HRT_E_LINK);
  } while ((state.activity & HRT_RECORDING) != 0);
  hrt::test::use_fake_robot();
  CHECK(hrt_kenaf_init() == HRT_OK);
  CHECK(lost->closed);
  disk.resume();
  stopper.join();
  CHECK((stopped == HRT_OK || stopped == HRT_E_RECORD));  // rows are lost where this thread took long
  CHECK(hrt_close() == HRT_OK);
}

TEST_CASE("A robot that is being closed is busy until it is") {
  const support::TemporaryFolder folder;
  StalledDisk disk(recording_in(folder));
  hrt::test::use_fake_robot()->lockstep = false;
  REQUIRE(hrt_kenaf_init() == HRT_OK);
  REQUIRE(hrt_record_start(recording_in(folder).c_str()) == HRT_OK);
  REQUIRE(hrt_sleep(10) == HRT_OK);
  int closed = HRT_E_INTERNAL;
  std::thread closer([&] { closed = hrt_close(); });
  while (hrt_time() != -1) std::this_thread::yield();
  CHECK(hrt_kenaf_init() == HRT_E_BUSY);
  CHECK_THAT(hrt_last_error(), Catch::Contains("is being closed"));
  disk.resume();
  closer.join();
  CHECK((closed == HRT_OK || closed == HRT_E_RECORD));  // as above
  hrt::test::use_fake_robot();
  CHECK(hrt_kenaf_init() == HRT_OK);
  CHECK(hrt_close() == HRT_OK);
}

TEST_CASE("A recording that gets no row leaves the file of its name as it is") {
  const support::TemporaryFolder folder;
  std::ofstream(recording_in(folder)) << "of before";
  { const Recorder recorder(recording_in(folder), false); }
  std::string text;
  std::getline(std::ifstream(recording_in(folder)), text);
  CHECK(text == "of before");
}

TEST_CASE("A value that is only held is not recorded as measured") {
  robot::State state = state_of(7);
  state.posture_rad = {0.1, 0.2, 0.3};
  state.battery_v = 24;
  state.fields = robot::kHasPosture | robot::kHasBattery | robot::held(robot::kHasPosture);
  const hrt::RecordRow row = hrt::record_row(state, robot::Command{}, 0);
  const auto cell = [&](const char* name) {
    const auto columns = hrt::record_columns();
    return row[static_cast<std::size_t>(std::ranges::find(columns, name) - columns.begin())];
  };
  CHECK(cell("battery_v") == 24);
  CHECK(std::isnan(cell("posture_yaw_rad")));
  CHECK(std::isnan(cell("track_left_m")));
}

TEST_CASE("Flippers' currents may be held while those of the tracks are new") {
  robot::State state = state_of(7);
  state.track_a = {1, 2};
  state.flipper_a = {3, 4, 5, 6};
  const auto columns = hrt::record_columns();
  const auto cell = [&](const hrt::RecordRow& row, const char* name) {
    return row[static_cast<std::size_t>(std::ranges::find(columns, name) - columns.begin())];
  };
  state.fields = robot::kHasCurrents;
  CHECK(cell(hrt::record_row(state, robot::Command{}, 0), "flipper_fl_a") == 3);
  state.fields |= robot::kHeldFlipperCurrents;
  const hrt::RecordRow row = hrt::record_row(state, robot::Command{}, 0);
  CHECK(cell(row, "track_left_a") == 1);
  CHECK(std::isnan(cell(row, "flipper_fl_a")));
}

TEST_CASE("A recording that begins between two cycles has the command in force in its first row") {
  const support::TemporaryFolder folder;
  const auto robot = hrt::test::use_fake_robot();
  robot->lockstep = false;
  REQUIRE(hrt_kenaf_init() == HRT_OK);
  REQUIRE(hrt_sleep(0.1) == HRT_OK);
  std::jthread driver([](const std::stop_token& stop) {  // another speed in each cycle, or nearly
    for (int i = 0; !stop.stop_requested(); ++i) hrt_set_tracks(i % 1000, i % 1000);
  });
  for (int i = 0; i < 10; ++i) {
    CHECK(hrt_record_start(recording_in(folder).c_str()) == HRT_OK);
    CHECK(hrt_record_stop() == HRT_OK);
    const runs::Run run = runs::read_run(recording_in(folder));
    REQUIRE(run.row_count() > 0);
    // Frame f is answered by commands[f - 1], which is in force from frame f + 1 on
    const auto frame = static_cast<std::size_t>(run.column("frame")[0]);
    const std::lock_guard lock(robot->mutex);
    CHECK(run.column("cmd_track_left_mps")[0] == robot->commands.at(frame - 2).track_speed_mps[0]);
  }
  driver = {};
  CHECK(hrt_close() == HRT_OK);
}

TEST_CASE("KENAF_RECORD records the same as the call, from the first cycle on") {
  const support::TemporaryFolder folder;
  const std::string by_variable = (folder.path() / "variable.csv").string(),
                    by_call = (folder.path() / "call.csv").string();
  const auto drive = [] {
    REQUIRE(hrt_set_flipper(HRT_FRONT_LEFT, 10) == HRT_OK);
    REQUIRE(hrt_go_forward(50) == HRT_OK);
    REQUIRE(hrt_close() == HRT_OK);
  };
  const auto driven_by_variable = hrt::test::use_fake_robot();
  ::setenv("KENAF_RECORD", by_variable.c_str(), 1);
  const int opened = hrt_kenaf_init();
  ::unsetenv("KENAF_RECORD");
  REQUIRE(opened == HRT_OK);
  drive();

  const auto driven_by_call = hrt::test::use_fake_robot();
  REQUIRE(hrt_kenaf_init() == HRT_OK);
  REQUIRE(hrt_record_start(by_call.c_str()) == HRT_OK);
  drive();

  // The call may come in a later cycle than the first. From there on each recording holds what its robot did.
  const runs::Run variable = runs::read_run(by_variable), call = runs::read_run(by_call);
  CHECK(variable.columns == call.columns);
  CHECK(variable.column("frame")[0] == 1);
  const auto check_drive = [](const runs::Run& run, const hrt::test::FakeRobot& robot) {
    REQUIRE(run.row_count() > 0);
    const auto frame = run.column("frame"), travel_m = run.column("track_left_m");
    for (std::size_t row = 0; row < run.row_count(); ++row) {
      const auto first = static_cast<std::size_t>(frame[0]);
      REQUIRE(frame[row] == static_cast<double>(first + row));
      REQUIRE(travel_m[row] == robot.travel_m.at(first + row - 1));
    }
    CHECK(travel_m.back() == Approx(0.05).margin(0.001));
  };
  check_drive(variable, *driven_by_variable);
  check_drive(call, *driven_by_call);
}
