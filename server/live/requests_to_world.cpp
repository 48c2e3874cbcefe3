#include "server/live/requests_to_world.hpp"

#include <spdlog/spdlog.h>

#include "server/live/messages.hpp"
#include "server/world_server/manual_drive.hpp"

namespace kenaf::live {

namespace {

std::string reply(std::string_view request, std::string_view reason) {
  return reason.empty() ? std::string() : refused_message(request, reason);
}

struct CarryOut {
  world_server::Simulation& simulation;
  world_server::OperatorId who;

  std::string operator()(const PauseRequest& request) const {
    simulation.set_paused(request.on, {who, {}});
    return {};
  }
  std::string operator()(const StepRequest& request) const {
    if (simulation.robot_count() == 0) return reply("step", "there is no robot, so time does not advance");
    if (!simulation.begin_steps(0, simulation.steps_for(request.time_s), {who, {}}))
      return reply("step", "too many steps are already waiting");
    return {};
  }
  std::string operator()(const SpeedRequest& request) const {
    simulation.clock.set_speed(request.value);
    return {};
  }
  std::string operator()(const ResetRequest&) const {
    spdlog::info("the live view resets the world");
    simulation.reset();
    return {};
  }
  std::string operator()(const PlaceRequest& request) const {
    std::uint32_t robot = 0;
    const std::string_view reason = world_server::place_robot_by_hand(simulation, who, robot, request.where);
    return reason.empty() ? placed_message(robot) : reply("place", reason);
  }
  std::string operator()(const TakeRequest& request) const {
    return reply("take", world_server::take_robot(simulation, request.robot, who));
  }
  std::string operator()(const LetGoRequest& request) const {
    return reply("let-go", world_server::let_go(simulation, request.robot, who));
  }
  std::string operator()(const RemoveRequest& request) const {
    return reply("remove", world_server::remove_placed_robot(simulation, request.robot, who));
  }
  std::string operator()(const DriveRequest& request) const {
    return reply("drive", world_server::drive_by_hand(simulation, request.robot, who, request.command));
  }
  std::string operator()(const LookRequest& request) const {
    return reply("look", world_server::look_by_hand(simulation, request.robot, who, request.camera, request.order));
  }
  std::string operator()(const ShowRequest&) const { return {}; }
  std::string operator()(const PingRequest&) const { return {}; }
};

}  // namespace

std::string carry_out(world_server::Simulation& simulation, world_server::OperatorId who, const Request& request) {
  return std::visit(CarryOut{simulation, who}, request);
}

}  // namespace kenaf::live
