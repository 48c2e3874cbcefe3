// Messages from the server to a page: one JSON object each. docs/live-view.md has the keys. Pure functions.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "server/image_server/frame.hpp"
#include "server/live/request.hpp"
#include "server/world_server/world_state.hpp"

namespace kenaf::live {

// Incremented when a page of an earlier version would misunderstand.
inline constexpr int kViewProtocol = 2;

// `server`: a new number for each start of a server. `pictures`: whether the robots' cameras can be viewed.
std::string hello_message(world_server::OperatorId you, std::uint32_t server, std::string_view world,
                          double time_step_s, double operator_silence_s, bool pictures);
// The fixed properties of robots and boxes: sent when one comes or leaves. `placeable`: of a robot that a page can
// place.
std::string inventory_message(const world_server::WorldState& state,
                              const std::optional<physics::RobotDimensions>& placeable = std::nullopt);
// Returns whether the inventory of `a` is still valid for `b`.
bool same_inventory(const world_server::WorldState& a, const world_server::WorldState& b);
// The motion of everything. `number` counts the messages, `sent_s` is the time on a clock that never jumps, `reached`
// is robot time per wall-clock time. `frames`: of all cameras being viewed, by any page, with their ages at `sent_s`.
// `shown`: what it has on top, as far as `state` was read with it.
struct FrameAge {
  image_server::CameraId id;
  std::uint64_t number;
  double robot_time_s, age_s;
};
std::string state_message(const world_server::WorldState& state, std::uint64_t number, double sent_s, double reached,
                          std::size_t viewers, std::span<const FrameAge> frames = {}, const ShowRequest& shown = {});
std::string refused_message(std::string_view request, std::string_view reason);
std::string placed_message(std::uint32_t robot);
std::string pong_message(double t);

}  // namespace kenaf::live
