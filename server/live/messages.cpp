#include "server/live/messages.hpp"

#include <algorithm>

#include "server/image_server/view_name.hpp"
#include "server/live/json_writer.hpp"

namespace kenaf::live {

namespace {

using Writer = JsonWriter;
using world_server::BoxState;
using world_server::RobotState;
using world_server::WorldState;

void write_cameras(Writer& out, const RobotState& robot) {
  out.key("cameras").open('[');
  for (const world_server::CameraState& camera : robot.cameras) {
    out.comma().open('{').key("name").text(camera.name);
    out.key("width").integer(static_cast<std::uint64_t>(camera.width));
    out.key("height").integer(static_cast<std::uint64_t>(camera.height));
    out.key("fov").numbers(std::array{camera.min_field_of_view_rad, camera.max_field_of_view_rad});
    if (camera.pan) out.key("pan").numbers(std::array{camera.pan->min_rad, camera.pan->max_rad});
    if (camera.tilt) out.key("tilt").numbers(std::array{camera.tilt->min_rad, camera.tilt->max_rad});
    out.close('}');
  }
  out.close(']');
}

// Directions of the cameras, and the age of the newest picture.
void write_camera_states(Writer& out, const RobotState& robot, std::span<const FrameAge> frames) {
  if (robot.cameras.empty()) return;
  out.key("cameras").open('[');
  for (std::size_t i = 0; i < robot.cameras.size(); ++i) {
    const world_server::CameraState& camera = robot.cameras[i];
    out.comma().open('{').key("fov").number(camera.field_of_view_rad);
    if (camera.pan) out.key("pan").number(camera.pan->angle_rad);
    if (camera.tilt) out.key("tilt").number(camera.tilt->angle_rad);
    const auto frame = std::ranges::find(frames, kenaf::image_server::CameraId{robot.robot, i}, &FrameAge::id);
    if (frame != frames.end()) {
      out.key("n").integer(frame->number).key("t").number(frame->robot_time_s).key("age").number(frame->age_s);
    }
    out.close('}');
  }
  out.close(']');
}

// A row of seven numbers each: a hundred of them come 30 times a second.
void write_contacts(Writer& out, const RobotState& robot) {
  out.key("contacts").open('[');
  for (const physics::ContactPoint& contact : robot.contacts) {
    out.comma().open('[').integer(static_cast<std::uint64_t>(contact.part));
    for (const double m : contact.p_W) out.comma().number(m);
    for (const double n : contact.force_W_n) out.comma().number(n, 2);
    out.close(']');
  }
  out.close(']');
}

void write_sensors(Writer& out, const RobotState& robot) {
  out.key("scans").open('[');
  for (const world_server::RangeScan& scan : robot.scans) {
    out.comma().open('{').key("name").text(scan.name).key("sonar").boolean(scan.sonar);
    out.key("p").vector(scan.X_WS.p).key("q").rotation(scan.X_WS.q).key("fov").number(scan.field_of_view_rad);
    out.key("ranges").numbers(scan.range_m, 3).close('}');
  }
  out.close(']');
  if (!robot.inertial) return;
  out.key("imu").open('{').key("p").vector(robot.inertial->p_W);
  out.key("a").vector(robot.inertial->a_W_mps2).key("w").vector(robot.inertial->w_W_radps).close('}');
}

std::string_view mode_name(robot::JointMode mode) {
  switch (mode) {
    case robot::JointMode::angle:
      return "angle";
    case robot::JointMode::speed:
      return "speed";
    case robot::JointMode::torque:
      return "torque";
    case robot::JointMode::brake:
      return "brake";
    case robot::JointMode::keep:
      break;
  }
  return "keep";
}

void write_command(Writer& out, const RobotState& robot) {
  out.key("command").open('{').key("track").numbers(robot.command.track_speed_mps);
  if (robot.dimensions.has_flippers()) {
    out.key("flipper").open('[');
    for (const robot::JointCommand& joint : robot.command.flipper) {
      out.comma().open('[').text(mode_name(joint.mode)).comma().number(joint.value).close(']');
    }
    out.close(']');
  }
  out.close('}');
}

void write_robot(Writer& out, const RobotState& robot, std::span<const FrameAge> frames, const ShowRequest& shown) {
  out.comma().open('{').key("id").integer(robot.id);
  out.key("p").vector(robot.X_WB.p).key("q").rotation(robot.X_WB.q).key("v").vector(robot.v_WB_mps);
  out.key("track_mps").numbers(robot.track_mps).key("track_m").numbers(robot.track_m);
  out.key("track_a").numbers(robot.track_a, 2);
  if (robot.dimensions.has_flippers()) {
    out.key("flipper").numbers(robot.flipper_rad).key("flipper_a").numbers(robot.flipper_a, 2);
  }
  out.key("battery_v").number(robot.battery_v, 2).key("battery_s").number(robot.battery_left_s, 0);
  write_command(out, robot);
  if (robot.has_client) {
    out.key("client").open('{').key("silent").boolean(robot.client_silent);
    out.key("age").number(robot.client_silent_s, 2).key("late").integer(robot.late_answers).close('}');
  }
  if (robot.holder != world_server::OperatorId{0}) {
    out.key("holder").integer(static_cast<std::uint32_t>(robot.holder));
    out.key("holder_silent").boolean(robot.holder_silent);
  }
  write_camera_states(out, robot, frames);
  if (shown.contacts) write_contacts(out, robot);
  if (shown.sensors == robot.id) write_sensors(out, robot);
  if (!robot.fault.empty()) out.key("fault").text(robot.fault);
  out.close('}');
}

void write_pauser(Writer& out, const world_server::Pauser& pauser) {
  out.key("paused_by").open('{');
  if (pauser.page != world_server::OperatorId{0}) {
    out.key("operator").integer(static_cast<std::uint32_t>(pauser.page));
  } else if (!pauser.program.empty()) {
    out.key("program").text(pauser.program);
  }
  out.close('}');
}

}  // namespace

std::string hello_message(world_server::OperatorId you, std::uint32_t server, std::string_view world,
                          double time_step_s, double operator_silence_s, bool pictures) {
  Writer out;
  out.open('{').key("type").text("hello").key("protocol").integer(kViewProtocol);
  out.key("you").integer(static_cast<std::uint32_t>(you)).key("server").integer(server).key("world").text(world);
  out.key("time_step").number(time_step_s, 6).key("operator_silence").number(operator_silence_s, 3);
  out.key("pictures").boolean(pictures);
  return out.close('}').take();
}

std::string inventory_message(const WorldState& state, const std::optional<physics::RobotDimensions>& placeable) {
  Writer out;
  out.open('{').key("type").text("inventory").key("robots").open('[');
  for (const RobotState& robot : state.robots) {
    out.comma().open('{').key("id").integer(robot.id).key("name").text(robot.name);
    out.key("class").text(robot.class_name).key("placed").boolean(!robot.has_client);
    out.key("view").text(kenaf::image_server::view_of(robot.robot));
    write_dimensions(out, robot.dimensions);
    write_cameras(out, robot);
    out.close('}');
  }
  out.close(']').key("boxes").open('[');
  for (const BoxState& box : state.boxes) {
    out.comma().open('{').key("id").integer(box.id).key("size").vector(box.size_m).close('}');
  }
  out.close(']');
  if (placeable) {
    out.key("placeable").open('{');
    write_dimensions(out, *placeable);
    out.close('}');
  }
  return out.close('}').take();
}

bool same_inventory(const WorldState& a, const WorldState& b) {
  const auto same_id = [](const auto& x, const auto& y) { return x.id == y.id; };
  return std::ranges::equal(a.robots, b.robots, same_id) && std::ranges::equal(a.boxes, b.boxes, same_id);
}

std::string state_message(const WorldState& state, std::uint64_t number, double sent_s, double reached,
                          std::size_t viewers, std::span<const FrameAge> frames, const ShowRequest& shown) {
  Writer out;
  out.open('{').key("type").text("state").key("n").integer(number).key("sent").number(sent_s, 6);
  out.key("t").number(state.time_s).key("step").integer(state.step).key("paused").boolean(state.paused);
  if (state.paused) write_pauser(out, state.pauser);
  out.key("speed").number(state.speed, 3).key("reached").number(reached, 3).key("viewers").integer(viewers);
  out.key("robots").open('[');
  for (const RobotState& robot : state.robots) write_robot(out, robot, frames, shown);
  out.close(']').key("boxes").open('[');
  for (const BoxState& box : state.boxes) {
    out.comma().open('{').key("p").vector(box.X_WBox.p).key("q").rotation(box.X_WBox.q).close('}');
  }
  return out.close(']').close('}').take();
}

std::string refused_message(std::string_view request, std::string_view reason) {
  Writer out;
  out.open('{').key("type").text("refused").key("request").text(request).key("reason").text(reason);
  return out.close('}').take();
}

std::string placed_message(std::uint32_t robot) {
  Writer out;
  return out.open('{').key("type").text("placed").key("robot").integer(robot).close('}').take();
}

std::string pong_message(double t) {
  Writer out;
  return out.open('{').key("type").text("pong").key("t").number(t).close('}').take();
}

}  // namespace kenaf::live
