// The same descriptions, settings, seed and calls give the same bits. Worlds are compared by hashes of all their
// numbers: run again, on threads, and in the company of other bodies. Stored hashes hold every compiler to the same
// result.
#include <catch2/catch.hpp>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>
#include <thread>

#include "tests/physics/scenes.hpp"

using namespace kenaf;
using namespace kenaf::physics;

namespace {

struct Hash {
  std::uint64_t value = 0xcbf29ce484222325u;
  void add(double number) {
    std::uint64_t bits;
    std::memcpy(&bits, &number, sizeof bits);
    for (int i = 0; i < 8; ++i) value = (value ^ (bits >> (8 * i) & 0xff)) * 0x100000001b3u;
  }
  void add(const RobotTruth& truth) {
    for (Eigen::Index i = 0; i < 3; ++i) add(truth.X_WB.p[i]);
    for (Eigen::Index i = 0; i < 4; ++i) add(truth.X_WB.q.coeffs()[i]);
    for (const double speed : truth.track_mps) add(speed);
    for (const double angle : truth.flipper_rad) add(angle);
    add(truth.battery_v);
  }
};

World make_world() {
  std::vector<std::string> unsupported;
  World world(load_world("boxes", unsupported), {}, 7);
  world.add_robot(load_robot("kenaf"), "a", {});
  world.add_robot(load_robot("p2at"), "b", {{-1.2, 0.5, 0}, rotation_from({0, 0, 1})});
  return world;
}

// 5 s of driving into the loose crate, with what the sensors report.
std::uint64_t drive_around(World& world) {
  Hash hash;
  std::vector<SensorSample> samples;
  const std::vector<RobotId> ids = world.robots();
  for (int i = 0; i < 500; ++i) {
    world.set_command(ids[0], drive(0.4, i % 100 < 50 ? 0.4 : 0.3, i % 200 < 100 ? 1.0 : -0.3, 0.5));
    world.set_command(ids[1], drive(0.3, -0.1));
    for (int k = 0; k < 10; ++k) world.step();
    for (const RobotId id : ids) {
      samples.clear();
      world.read_sensors(id, samples);
      hash.add(world.truth(id));
      for (const SensorSample& sample : samples)
        if (const auto* ins = std::get_if<InsReading>(&sample.reading)) hash.add(ins->roll_pitch_yaw_rad.x());
    }
  }
  return hash.value;
}

}  // namespace

TEST_CASE("Two worlds, and one that was reset, run alike to the last bit") {
  World first = make_world(), second = make_world();
  const std::uint64_t expected = drive_around(first);
  CHECK(drive_around(second) == expected);
  first.reset();
  CHECK(first.time_s() == 0);
  CHECK(drive_around(first) == expected);
}

TEST_CASE("Worlds on two threads do not meet") {
  World reference = make_world();
  const std::uint64_t expected = drive_around(reference);
  std::array<std::uint64_t, 2> got{};
  std::vector<std::thread> threads;
  for (std::uint64_t& value : got)
    threads.emplace_back([&value] {
      World world = make_world();
      value = drive_around(world);
    });
  for (std::thread& thread : threads) thread.join();
  CHECK(got[0] == expected);
  CHECK(got[1] == expected);
}

namespace {

// 2 s of one robot that comes before or after `others` further ones, 10 m apart, each with `their` command.
std::uint64_t hash_in_company(const robot::Command& own, int others, const robot::Command& their = {},
                              bool first = true) {
  World world(ground(), {}, 1);
  const auto add = [&](const std::string& name, double x_m, const robot::Command& command) {
    const RobotId id = world.add_robot(load_robot("kenaf"), name, {{x_m, 0, 0}, Eigen::Quaterniond::Identity()});
    world.set_command(id, command);
    return id;
  };
  std::optional<RobotId> id;
  if (first) id = add("a", 0, own);
  for (int i = 1; i <= others; ++i) add("b" + std::to_string(i), 10 * i, their);
  if (!first) id = add("a", 0, own);
  Hash value;
  for (int i = 0; i < 2000; ++i) {
    world.step();
    value.add(world.truth(*id));
  }
  return value.value;
}

}  // namespace

TEST_CASE("On a plane another robot far away changes no bit, whatever it does") {
  const robot::Command stand{}, straight = drive(0.3, 0.3), curve = drive(0.3, 0.1), spin = drive(0.3, -0.3);
  for (const robot::Command& own : {straight, curve}) {
    const std::uint64_t alone = hash_in_company(own, 0);
    for (const robot::Command& their : {stand, straight, spin}) {
      CHECK(hash_in_company(own, 1, their, true) == alone);
      CHECK(hash_in_company(own, 1, their, false) == alone);
    }
    CHECK(hash_in_company(own, 2, spin) == alone);
  }
}

TEST_CASE("On a plane a loose box far away that falls and tumbles changes no bit") {
  const auto hash = [](bool box) {
    World world(ground(), {}, 1);
    if (box) world.add_box(loose_box({0.5, 0.3, 0.2}, {{10, 0, 2}, rotation_from({0.5, 0.3, 0})}, 5, 0.5));
    const RobotId id = world.add_robot(load_robot("kenaf"), "a", {});
    world.set_command(id, drive(0.3, 0.3));
    Hash value;
    for (int i = 0; i < 2000; ++i) {
      world.step();
      value.add(world.truth(id));
    }
    return value.value;
  };
  CHECK(hash(false) == hash(true));
}

namespace {

struct GoldenScene {
  std::string_view world;
  double start_x_m;  // beyond the world's own start
  robot::Command command;
  std::uint64_t hash;  // of 3 s
};

// Hashes mean nothing but that they stay. A change that is meant to change what the physics gives renews them, and
// says so: a failure prints what it got. docs/physics.md says which compilers and machines they hold for.
const GoldenScene kGolden[] = {{"step-100", 0.5, drive(0.3, 0.3, 0.8, 0), 0xe8fa17785a316f2c},
                               {"trench-300", 0.6, drive(0.3, 0.3, 0, 0), 0x532a3cca98203eeb},
                               {"flat", 0, drive(-0.2, 0.2), 0xebc3a3dcc1116ee1},
                               {"rubble-mesh", 0.5, drive(0.3, 0.25, 0.8, -0.2), 0xd6168741ff2c8392}};

std::uint64_t hash_of(const GoldenScene& scene) {
  std::vector<std::string> unsupported;
  const WorldDescription description = load_world(std::string(scene.world), unsupported);
  World world(description, {}, 1);
  const StartPose& start = description.start_poses.front();
  Pose X_WB = start.X_WB;
  X_WB.p.x() += scene.start_x_m;
  const RobotId robot = world.add_robot(load_robot("kenaf"), start.name, X_WB);
  world.set_command(robot, scene.command);
  Hash hash;
  std::vector<SensorSample> samples;
  for (int i = 0; i < 300; ++i) {
    for (int k = 0; k < 10; ++k) world.step();
    hash.add(world.truth(robot));
    samples.clear();
    world.read_sensors(robot, samples);
    for (const SensorSample& sample : samples)
      if (const auto* imu = std::get_if<ImuReading>(&sample.reading)) hash.add(imu->acceleration_mps2.z());
  }
  return hash.value;
}

}  // namespace

TEST_CASE("Every compiler makes the same bits, on one thread and on four") {
  std::array<std::uint64_t, std::size(kGolden)> got{};
  std::vector<std::thread> threads;
  for (std::size_t i = 0; i < got.size(); ++i) threads.emplace_back([&, i] { got[i] = hash_of(kGolden[i]); });
  for (std::thread& thread : threads) thread.join();
  for (std::size_t i = 0; i < got.size(); ++i) {
    INFO(kGolden[i].world << ", 0x" << std::hex << got[i]);
    CHECK(got[i] == kGolden[i].hash);
    CHECK(hash_of(kGolden[i]) == got[i]);
  }
}
