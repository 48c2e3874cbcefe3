// No effect changes a bit at its neutral value, every effect acts at any other value, and its action fades to nothing
// as the value approaches neutral. Effects are written as NAME:PARAMETER=VALUE, and mistakes in that are reported. The
// tests of each stage check how its effects act.
#include <catch2/catch.hpp>
#include <cstring>

#include "physics/terrain_effects.hpp"
#include "tests/physics/scenes.hpp"

using namespace kenaf::physics;

namespace {

struct Drive {
  std::uint64_t hash = 0xcbf29ce484222325u;
  Eigen::Vector3d end{0, 0, 0};
  void add(double number) {
    std::uint64_t bits;
    std::memcpy(&bits, &number, sizeof bits);
    for (int i = 0; i < 8; ++i) hash = (hash ^ (bits >> (8 * i) & 0xff)) * 0x100000001b3u;
  }
};

// Two seconds over a low step, with turns and moving flippers, and everything that is measured on the way.
Drive drive_with(const Effects& effects) {
  RobotDescription robot = load_robot("kenaf");
  robot.track.front().lug_height_m = 0.0005;
  robot.effects = effects;
  WorldDescription nominal = ground();
  nominal.boxes.push_back(fixed_box({1, 2, 0.02}, {0.85, 0, 0.01}));
  World world(with_terrain_effects(nominal, effects), {.time_step_s = 0.004}, 5);
  const RobotId id = world.add_robot(robot, "a", {});
  Drive result;
  std::vector<SensorSample> samples;
  for (int i = 0; i < 50; ++i) {
    const double turn = i % 20 < 10 ? 0 : 0.1;
    world.set_command(id, drive(0.38 - turn, 0.38 + turn, i < 25 ? 0.5 : 0.9, 0.3));
    for (int k = 0; k < 10; ++k) world.step();
    samples.clear();
    world.read_sensors(id, samples);
    for (const SensorSample& sample : samples) {
      if (const auto* ins = std::get_if<InsReading>(&sample.reading))
        for (Eigen::Index k = 0; k < 3; ++k) result.add(ins->roll_pitch_yaw_rad[k]);
      if (const auto* imu = std::get_if<ImuReading>(&sample.reading))
        for (Eigen::Index k = 0; k < 3; ++k) {
          result.add(imu->acceleration_mps2[k]);
          result.add(imu->angular_velocity_radps[k]);
        }
      if (const auto* encoder = std::get_if<EncoderReading>(&sample.reading))
        for (const auto count : encoder->counts) result.add(static_cast<double>(count));
      if (const auto* drives = std::get_if<DrivesReading>(&sample.reading))
        for (const double number : {drives->track_a[0], drives->battery_v, drives->flipper_rad[0]}) result.add(number);
    }
    const RobotTruth truth = world.truth(id);
    for (Eigen::Index k = 0; k < 3; ++k) result.add(truth.X_WB.p[k]);
    for (Eigen::Index k = 0; k < 4; ++k) result.add(truth.X_WB.q.coeffs()[k]);
    for (const double angle : truth.flipper_rad) result.add(angle);
  }
  result.end = world.truth(id).X_WB.p;
  return result;
}

// Motion capture is no sensor of the robot: what tracking does is in tests/rollout/tracking_test.cpp.
bool is_of_tracking(const EffectInfo& effect) {
  return effect.name.starts_with("track") || effect.name == "clock_offset";
}

}  // namespace

TEST_CASE("At its neutral value no effect changes a bit", "[long]") {
  const std::uint64_t nominal = drive_with({}).hash;
  CHECK(drive_with({}).hash == nominal);
  for (const EffectInfo& effect : effect_catalogue()) {
    Effects effects;
    for (const EffectParameter& parameter : effect.parameters)
      set_effect(effects, std::string(effect.name) + ":" + std::string(parameter.name) + "=" +
                              std::to_string(parameter.neutral));
    INFO(effect.name);
    CHECK(effects == Effects{});
    CHECK(drive_with(effects).hash == nominal);
  }
}

TEST_CASE("At any other value every effect but those of tracking changes what the robot does or measures", "[long]") {
  const std::uint64_t nominal = drive_with({}).hash;
  for (const EffectInfo& effect : effect_catalogue()) {
    for (const EffectParameter& parameter : effect.parameters) {
      for (const double value : {parameter.min, parameter.max}) {
        if (value == parameter.neutral) continue;
        Effects effects;
        effects.*(parameter.value) = value;
        INFO(effect.name << ", " << parameter.name << " = " << value);
        CHECK((drive_with(effects).hash != nominal) == !is_of_tracking(effect));
      }
    }
  }
}

TEST_CASE("An effect comes out of nothing: a millionth of its range moves the robot by less than 2 mm", "[long]") {
  const Eigen::Vector3d nominal = drive_with({}).end;
  for (const EffectInfo& effect : effect_catalogue()) {
    if (effect.name == "command_loss") continue;  // that a command is lost is chance, not a matter of how much
    for (const EffectParameter& parameter : effect.parameters) {
      Effects effects;
      const double toward = parameter.neutral < parameter.max ? parameter.max : parameter.min;
      effects.*(parameter.value) += 1e-6 * (toward - parameter.neutral);
      INFO(effect.name << ", " << parameter.name << " = " << effects.*(parameter.value));
      CHECK((drive_with(effects).end - nominal).norm() < 2e-3);
    }
  }
}

TEST_CASE("An effect is set by name, and what is wrong is said") {
  Effects effects;
  set_effect(effects, "command_delay:delay_s=0.05");
  CHECK(effects.command_delay_s == 0.05);
  const auto error = [](const char* text) {
    Effects unused;
    try {
      set_effect(unused, text);
    } catch (const std::invalid_argument& wrong) {
      return std::string(wrong.what());
    }
    return std::string();
  };
  CHECK(error("command_delay=0.05").find("NAME:PARAMETER=VALUE") != std::string::npos);
  CHECK(error("comand_delay:delay_s=0.05").find("there are command_delay, command_loss") != std::string::npos);
  CHECK_THAT(error("comand_delay:delay_s=0.05"), Catch::EndsWith("; did you mean command_delay?"));
  CHECK_THAT(error("xyzzy:delay_s=0.05"), !Catch::Contains("did you mean"));
  CHECK_THAT(error("drive_lag:lags_s=0.05"),
             Catch::EndsWith("has no parameter \"lags_s\", but lag_s; did you mean lag_s?"));
  CHECK(error("command_delay:delay=0.05").find("no parameter \"delay\", but delay_s") != std::string::npos);
  CHECK(error("command_delay:delay_s=soon").find("\"soon\" is not a number") != std::string::npos);
  CHECK(error("command_delay:delay_s=9").find("from 0 to 1 s") != std::string::npos);
}
