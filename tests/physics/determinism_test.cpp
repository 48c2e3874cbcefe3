// The same descriptions, settings, seed and calls give the same bits.
#include <catch2/catch.hpp>
#include <cstring>
#include <thread>

#include "tests/physics/scenes.hpp"

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

TEST_CASE("D1: two worlds, and one that was reset, run alike to the last bit") {
  World first = make_world(), second = make_world();
  const std::uint64_t expected = drive_around(first);
  CHECK(drive_around(second) == expected);
  first.reset();
  CHECK(first.time_s() == 0);
  CHECK(drive_around(first) == expected);
}

TEST_CASE("D2: worlds on two threads do not meet") {
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

TEST_CASE("D3: another robot far away changes no bit") {
  const auto hash = [](bool company) {
    World world(ground(), {}, 1);
    const RobotId id = world.add_robot(load_robot("kenaf"), "a", {});
    if (company) world.add_robot(load_robot("kenaf"), "b", {{10, 0, 0}, Eigen::Quaterniond::Identity()});
    world.set_command(id, drive(0.3, 0.1));
    Hash value;
    for (int i = 0; i < 2000; ++i) {
      world.step();
      value.add(world.truth(id));
    }
    return value.value;
  };
  CHECK(hash(false) == hash(true));
}
