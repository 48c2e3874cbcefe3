// Effects of the command stage: what becomes of a command before the drives have it.
#include <catch2/catch.hpp>

#include "physics/dynamics/command_channel.hpp"
#include "tests/physics/scenes.hpp"

using namespace kenaf;
using namespace kenaf::physics;

namespace {

constexpr double kStep_s = 0.001, kGauge_m = 0.4;

CommandChannel channel_with(const Effects& effects, std::uint64_t seed = 1, const char* robot = "a") {
  CommandChannel channel(effects, seed, robot, kGauge_m, kStep_s);
  channel.restart(drive(0, 0));
  return channel;
}

double left(CommandChannel& channel) {
  return channel.step().track_speed_mps[robot::kLeft];
}

}  // namespace

TEST_CASE("Command delay: the robot does the same, that much later") {
  const auto path = [](double delay_s) {
    RobotDescription robot = load_robot("kenaf");
    robot.effects.command_delay_s = delay_s;
    World world(ground(), {}, 1);
    const RobotId id = world.add_robot(robot, "a", {});
    run(world, 0.5);
    std::vector<Eigen::Vector3d> out;
    for (int i = 0; i < 1500; ++i) {
      if (i == 0) world.set_command(id, drive(0.2, 0.3));
      if (i == 700) world.set_command(id, drive(0.1, -0.1));
      world.step();
      out.push_back(world.truth(id).X_WB.p);
    }
    return out;
  };
  const auto now = path(0), late = path(0.1);
  for (std::size_t i = 0; i + 100 < now.size(); i += 50) CHECK((late[i + 100] - now[i]).norm() < 1e-4);
}

TEST_CASE("Command delay: whole steps, and between two steps in proportion") {
  for (const double steps : {0.0, 1.0, 2.0, 2.25, 2.5, 7.75}) {
    CommandChannel channel = channel_with({.command_delay_s = steps * kStep_s});
    channel.step();
    channel.send(drive(1, 1));
    // of a command that came n steps ago, the drives have that part which is not under way any more
    for (int n = 0; n < 12; ++n) CHECK(left(channel) == Approx(std::clamp(n + 1 - steps, 0.0, 1.0)).margin(1e-9));
  }
}

TEST_CASE("A flipper that is kept has the command of before, the tracks have the new one") {
  CommandChannel channel = channel_with({});
  robot::Command command = drive(0.1, 0.1);
  command.flipper[robot::kFrontLeft] = {robot::JointMode::speed, 0.8};
  channel.send(command);
  (void)channel.step();
  command = robot::Command{};
  command.flipper[robot::kRearRight] = {robot::JointMode::angle, 0.25};
  channel.send(command);
  const robot::Command& now = channel.step();
  CHECK(now.track_speed_mps == std::array{0.0, 0.0});
  CHECK(now.flipper[robot::kFrontLeft] == robot::JointCommand{robot::JointMode::speed, 0.8});
  CHECK(now.flipper[robot::kFrontRight] == robot::JointCommand{robot::JointMode::angle, 1});  // of drive()
  CHECK(now.flipper[robot::kRearRight] == robot::JointCommand{robot::JointMode::angle, 0.25});
}

TEST_CASE("Command delay: between two modes of a joint there is nothing") {
  CommandChannel channel = channel_with({.command_delay_s = 1.5 * kStep_s});
  robot::Command command;
  command.flipper[robot::kFrontLeft] = {robot::JointMode::speed, 0.8};
  channel.send(command);
  CHECK(channel.step().flipper[robot::kFrontLeft].mode == robot::JointMode::angle);
  CHECK(channel.step().flipper[robot::kFrontLeft].mode == robot::JointMode::angle);
  CHECK(channel.step().flipper[robot::kFrontLeft].mode == robot::JointMode::speed);
  CHECK(channel.step().flipper[robot::kFrontLeft].value == 0.8);
}

TEST_CASE("Command loss: of a message that is lost nothing arrives later, joints included") {
  CommandChannel channel = channel_with({.command_loss = 0.5});
  robot::Command order, keep;  // every second message leaves the flipper as it is
  int obeyed = 0;
  for (int i = 1; i <= 200; ++i) {
    order.flipper[robot::kFrontLeft] = {robot::JointMode::angle, static_cast<double>(i)};
    channel.send(order);
    const double angle = channel.step().flipper[robot::kFrontLeft].value;
    channel.send(keep);
    CHECK(channel.step().flipper[robot::kFrontLeft].value == angle);
    obeyed += angle == i;
  }
  CHECK(obeyed > 60);  // 100 expected, with a sigma of 7
  CHECK(obeyed < 140);
}

TEST_CASE("Command loss: of a share that is lost the rest arrives, and the command before holds meanwhile") {
  const auto arrivals = [](double loss, std::uint64_t seed, const char* robot) {
    CommandChannel channel = channel_with({.command_loss = loss}, seed, robot);
    std::vector<bool> arrived;
    double before = 0;
    for (int i = 1; i <= 10000; ++i) {
      channel.send(drive(i, i));
      const double now = left(channel);
      CHECK((now == i || now == before));
      arrived.push_back(now == i);
      before = now;
    }
    return arrived;
  };
  const auto share = [](const std::vector<bool>& arrived) {
    return static_cast<double>(std::count(arrived.begin(), arrived.end(), true)) / 10000;
  };
  // a share of 10 000 draws has a sigma of sqrt(p (1 - p) / 10000), below 0.005
  CHECK(share(arrivals(0.3, 1, "a")) == Approx(0.7).margin(0.02));
  CHECK(share(arrivals(0.9, 1, "a")) == Approx(0.1).margin(0.02));
  CHECK(share(arrivals(0, 1, "a")) == 1);
  CHECK(arrivals(0.3, 1, "a") == arrivals(0.3, 1, "a"));
  CHECK(arrivals(0.3, 1, "a") != arrivals(0.3, 2, "a"));
  CHECK(arrivals(0.3, 1, "a") != arrivals(0.3, 1, "b"));
}

TEST_CASE("Command gain: the tracks run by that much faster, the flippers follow their commands") {
  RobotDescription robot = load_robot("kenaf");
  robot.effects.command_gain = 1.2;
  World world(ground(), {}, 1);
  const RobotId id = world.add_robot(robot, "a", {});
  world.set_command(id, drive(0.2, 0.2, 0.6, 0.6));
  run(world, 1);
  CHECK(world.truth(id).v_WB_mps.x() == Approx(0.24).epsilon(1e-3));
  CHECK(world.truth(id).flipper_rad[robot::kFrontLeft] == Approx(0.6).margin(1e-3));
}

TEST_CASE("Command gain of the turn, and limits: forward speed and turn rate, each by itself") {
  // v = 0.2 m/s and w = (0.5 - -0.1) / 0.4 = 1.5 rad/s
  const auto output_of = [](const Effects& effects) {
    CommandChannel channel = channel_with(effects);
    channel.send(drive(-0.1, 0.5));
    const auto [left, right] = channel.step().track_speed_mps;
    return std::array{(left + right) / 2, (right - left) / kGauge_m};
  };
  const auto check = [&](const Effects& effects, double v_mps, double w_radps) {
    const auto [v, w] = output_of(effects);
    CHECK(v == Approx(v_mps));
    CHECK(w == Approx(w_radps));
  };
  check({.command_gain_turn = 0.8}, 0.2, 1.2);
  check({.command_limit_forward_spm = 10}, 0.1, 1.5);                                  // 1 / (10 s/m)
  check({.command_limit_turn_sprad = 2}, 0.2, 0.5);                                    // 1 / (2 s/rad)
  check({.command_limit_forward_spm = 4, .command_limit_turn_sprad = 0.5}, 0.2, 1.5);  // 0.25 m/s and 2 rad/s: beyond
  // the limit is of what the gains make of it: 1.2 * 1.5 rad/s, and 0.24 m/s
  check({.command_gain = 1.2, .command_limit_forward_spm = 4.5, .command_limit_turn_sprad = 0.6}, 1 / 4.5, 1 / 0.6);
}

TEST_CASE("Command slew: speed = time / slowness, up and down") {
  RobotDescription robot = load_robot("kenaf");
  robot.effects.command_slew_s2pm = 5;
  World world(ground(), {}, 1);
  const RobotId id = world.add_robot(robot, "a", {});
  world.set_command(id, drive(0.4, 0.4));
  run(world, 1);
  // 0.2 m/s^2; the speed loop's lag of 0.05 s leaves it 0.01 m/s behind the ramp
  CHECK(world.truth(id).track_mps[robot::kLeft] == Approx(0.19).epsilon(0.01));
  run(world, 2);
  CHECK(world.truth(id).track_mps[robot::kLeft] == Approx(0.4).epsilon(1e-3));
  world.set_command(id, drive(0, 0));
  run(world, 1);
  CHECK(world.truth(id).track_mps[robot::kLeft] == Approx(0.21).epsilon(0.01));
}

TEST_CASE("Command slew, forward and turn: each has its own limit, and the other one is there at once") {
  // v = 0.2 m/s and w = (0.5 - -0.1) / 0.4 = 1.5 rad/s
  const auto reached = [](const Effects& effects, int steps) {
    CommandChannel channel = channel_with(effects);
    channel.send(drive(-0.1, 0.5));
    for (int i = 1; i < steps; ++i) channel.step();
    const auto [left, right] = channel.step().track_speed_mps;
    return std::array{(left + right) / 2, (right - left) / kGauge_m};
  };
  // 1 / (10 s²/m) for 0.5 s; 1 / (0.8 s²/rad) = 1.25 rad/s² for 0.4 s
  const auto [v, w] = reached({.command_slew_forward_s2pm = 10}, 500);
  CHECK(v == Approx(0.05));
  CHECK(w == Approx(1.5));
  const auto [v_turning, w_turning] = reached({.command_slew_turn_s2prad = 0.8}, 400);
  CHECK(v_turning == Approx(0.2));
  CHECK(w_turning == Approx(0.5));
  const auto [v_both, w_both] = reached({.command_slew_forward_s2pm = 10, .command_slew_turn_s2prad = 0.8}, 400);
  CHECK(v_both == Approx(0.04));
  CHECK(w_both == Approx(0.5));
  const auto [v_end, w_end] = reached({.command_slew_forward_s2pm = 10, .command_slew_turn_s2prad = 0.8}, 2100);
  CHECK(v_end == Approx(0.2));
  CHECK(w_end == Approx(1.5));
}

TEST_CASE("Command slew, all three: no limit is exceeded") {
  // straight ahead the side's 0.2 m/s² is the tighter one; in place 0.5 rad/s² is, which is 0.1 m/s² on each side
  const Effects effects{.command_slew_s2pm = 5, .command_slew_forward_s2pm = 2, .command_slew_turn_s2prad = 2};
  CommandChannel ahead = channel_with(effects), in_place = channel_with(effects);
  ahead.send(drive(0.4, 0.4));
  in_place.send(drive(-0.4, 0.4));
  for (int i = 1; i <= 1000; ++i) {
    CHECK(left(ahead) == Approx(0.2 * i * kStep_s));
    CHECK(left(in_place) == Approx(-0.1 * i * kStep_s));
  }
}

TEST_CASE("Command slew of the turn: yaw = rate² slowness / 2 later than without") {
  // A ramp to w takes w slowness and turns by half of w times that; the rest is as without a ramp.
  RobotDescription robot = load_robot("kenaf");
  robot.flipper.clear();
  const double w = 0.5, slowness = 2;
  const auto yaw = [&](const Effects& effects) {
    RobotDescription with = robot;
    with.effects = effects;
    World world(ground(), {}, 1);
    const RobotId id = world.add_robot(with, "a", {});
    world.set_command(id, drive(-w * robot.track_gauge_m() / 2, w * robot.track_gauge_m() / 2));
    run(world, 3);
    return std::array{yaw_of(world.truth(id).X_WB), world.truth(id).w_WB_radps.z()};
  };
  const auto [at_once, rate] = yaw({});
  const auto [ramped, ramped_rate] = yaw({.command_slew_turn_s2prad = slowness});
  CHECK(ramped_rate == Approx(rate).epsilon(0.01));
  // tracks that turn in place slip: of what they ran, rate / w shows
  CHECK(at_once - ramped == Approx(rate / w * w * w * slowness / 2).epsilon(0.03));
}

TEST_CASE("Command dead band: below it nothing, from it on the command, after the gain") {
  for (const double commanded_mps : {0.0, 0.07, -0.07, 0.079, 0.08, -0.08, 0.3}) {
    CommandChannel channel = channel_with({.command_gain = 1.25, .command_dead_band_mps = 0.1});
    channel.send(drive(commanded_mps, 0.4));
    const auto [left_mps, right_mps] = channel.step().track_speed_mps;
    CHECK(left_mps == (std::abs(commanded_mps) < 0.08 ? 0 : 1.25 * commanded_mps));
    CHECK(right_mps == 0.5);
  }
}

TEST_CASE("Command dead band: from 0.3 m/s into it a track ramps down to rest, and a delay between steps is no jump") {
  CommandChannel channel =
      channel_with({.command_delay_s = 1.5 * kStep_s, .command_dead_band_mps = 0.2, .command_slew_s2pm = 1});
  channel.send(drive(0.3, 0.3));
  for (int i = 0; i < 400; ++i) left(channel);
  CHECK(left(channel) == Approx(0.3));
  channel.send(drive(0.1, 0.1));
  for (int i = 0; i < 102; ++i) left(channel);
  // the first of 103 steps is too early for it, the others are of 1 mm/s
  CHECK(left(channel) == Approx(0.3 - 0.102).margin(1e-9));
  for (int i = 0; i < 300; ++i) left(channel);
  CHECK(left(channel) == 0);
}

TEST_CASE("Command stage: the ramp is of the speed after the gain, and begins when the command has arrived") {
  CommandChannel channel = channel_with({.command_delay_s = 0.1, .command_gain = 1.5, .command_slew_s2pm = 1});
  channel.send(drive(0.2, 0.2));
  for (int i = 0; i < 100; ++i) CHECK(left(channel) == 0);
  for (int i = 1; i <= 299; ++i) CHECK(left(channel) == Approx(i * kStep_s));
  for (int i = 0; i < 10; ++i) left(channel);
  CHECK(left(channel) == Approx(0.3));
}

TEST_CASE("Command stage: after a teleport the ramp begins at rest") {
  RobotDescription robot = load_robot("kenaf");
  robot.effects.command_slew_s2pm = 5;
  World world(ground(), {}, 1);
  const RobotId id = world.add_robot(robot, "a", {});
  world.set_command(id, drive(0.4, 0.4));
  run(world, 3);
  world.teleport(id, {});
  run(world, 0.1);
  CHECK(world.truth(id).track_mps[robot::kLeft] < 0.025);
}
