#include <algorithm>
#include <cmath>

#include "formats/protocol/frames.hpp"
#include "server/world_server/joint_orders.hpp"
#include "server/world_server/report.hpp"

namespace kenaf::world_server {

namespace {

void write_joints(protocol::usarsim::MessageWriter& writer, const SessionRobot& robot, const physics::RobotTruth& truth,
                  protocol::usarsim::NumberFormat format) {
  if (!robot.description->has_flippers()) return;
  for (const robot::Flipper flipper : kUsarsimJoints) {
    if (!robot.description->has(flipper)) continue;
    writer.number(protocol::frames::usarsim_flipper_name(flipper),
                  protocol::frames::usarsim_flipper_from_tip_up(flipper, truth.flipper_rad[flipper]), format);
  }
}

}  // namespace

void write_mission_packages(const Simulation& simulation, Session& session) {
  const SessionRobot& robot = *session.robot;
  const auto& packages = robot.description->mission_packages;
  protocol::usarsim::MessageWriter writer(session.out);
  for (std::size_t i = 0; i < packages.size(); ++i) {
    writer.begin(simulation.dialect == Dialect::ut2004 ? "MISSTA" : "ASTA")
        .number("Time", simulation.world.time_s(), session.formats.status_time)
        .text("Name", packages[i].name);
    for (std::size_t link = 0; link < packages[i].links.size(); ++link) {
      writer.integer("Link", static_cast<std::int64_t>(link) + 1)
          .number("Value",
                  protocol::frames::usarsim_link_from_rep103(simulation.world.mission_link_rad(robot.id, i, link)),
                  session.formats.value)
          .number("Torque", 0, {2, false});
    }
    writer.end();
  }
}

void write_status(const Simulation& simulation, Session& session) {
  const SessionRobot& robot = *session.robot;
  const physics::RobotTruth truth = simulation.world.truth(robot.id);
  const auto battery_s = static_cast<std::int64_t>(std::max(0.0, std::ceil(truth.battery_left_s)));
  const Formats& formats = session.formats;
  const double time_s = simulation.world.time_s();
  protocol::usarsim::MessageWriter writer(session.out);
  writer.begin("STA");
  if (simulation.dialect == Dialect::ut2004) {
    writer.text("Type", "GroundVehicle")
        .number("Time", time_s, formats.status_time)
        .number("FrontSteer", 0, {4, false})
        .number("RearSteer", 0, {4, false});
    write_joints(writer, robot, truth, formats.value);
    writer.boolean("LightToggle", robot.light)
        .integer("LightIntensity", robot.light ? 100 : 0)
        .integer("Battery", battery_s)
        .integer("View", -1);
  } else {
    writer.number("Time", time_s, formats.status_time)
        .integer("Battery", battery_s)
        .text("Type", "GroundVehicle")
        .boolean("LightToggle", robot.light)
        .integer("LightIntensity", 100)
        .integer("FrontSteer", 0)
        .integer("RearSteer", 0);
    write_joints(writer, robot, truth,
                 formats.value);  // UDK did not report them; clients skip unknown keys
  }
  if (session.extended) {
    const FrameSchedule& schedule = session.schedule;
    if (schedule.numbered()) {
      writer.integer("Frame", static_cast<std::int64_t>(schedule.frame()))
          .integer("Late", static_cast<std::int64_t>(schedule.late()));
    }
    writer.integer("Steps", static_cast<std::int64_t>(simulation.world.step_count()))
        .boolean("Paused", simulation.clock.paused());
    if (session.silent) writer.boolean("Silent", true);
    if (!robot.start_instead.empty()) writer.text("Start", robot.start_instead);
    if (const std::string& fault = simulation.world.fault(robot.id); !fault.empty()) writer.text("Fault", fault);
  }
  writer.end();
}

void write_warning(const Simulation& simulation, Session& session, std::string_view words) {
  if (!session.extended) return;
  protocol::usarsim::MessageWriter(session.out)
      .begin("RES")
      .number("Time", simulation.world.time_s(), session.formats.sensor_time)
      .text("Type", "Robot")
      .text("Name", session.robot->name)
      .text("Status", "OK")
      .text("Warning", words)
      .end();
}

}  // namespace kenaf::world_server
