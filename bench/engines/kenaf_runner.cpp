#include "bench/engines/compared_engines.hpp"

#include "physics/world.hpp"

namespace kenaf::bench {
namespace {

using namespace physics;

constexpr std::size_t kStepsBetweenReadings = 10;  // a connection's output period of 10 ms

// Kenaf as a user runs it: World, with sensors read when their periods have passed.
class KenafRunner : public Runner {
 public:
  KenafRunner(const EngineScene& scene, bool with_sensors)
      : world_(scene.world, {.time_step_s = scene.time_step_s}, 1), with_sensors_(with_sensors) {
    if (scene.robot) {
      RobotDescription robot = *scene.robot;
      if (!with_sensors) robot.sensors.clear();
      robot_ = world_.add_robot(robot, "robot", scene.X_start);
      world_.set_command(*robot_, scene.command);
    } else {
      block_ = world_.add_box(*scene.block);
    }
  }
  void step() override {
    world_.step();
    if (!with_sensors_ || !robot_ || world_.step_count() % kStepsBetweenReadings) return;
    readings_.clear();
    world_.read_sensors(*robot_, readings_);
  }
  std::size_t contacts() const override { return world_.contact_count(); }
  Pose pose() const override { return robot_ ? world_.truth(*robot_).X_WB : world_.box_pose(block_); }

 private:
  World world_;
  bool with_sensors_;
  std::optional<RobotId> robot_;
  BoxId block_{};
  std::vector<SensorSample> readings_;
};

}  // namespace

std::vector<Engine> kenaf_engines() {
  const auto engine = [](const char* setting, bool with_sensors) {
    return Engine{"Kenaf", KENAF_VERSION, setting, true,
                  [with_sensors](const EngineScene& scene) -> std::unique_ptr<Runner> {
                    return std::make_unique<KenafRunner>(scene, with_sensors);
                  }};
  };
  return {engine("without sensors", false), engine("all sensors, read at 100 Hz", true)};
}

}  // namespace kenaf::bench
