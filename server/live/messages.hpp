// What the server tells a page: one JSON object a message. docs/live-view.md has the keys. Pure functions.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "server/image_server/frame.hpp"
#include "server/world_server/world_state.hpp"

namespace kenaf::live {

// Raised by one where a page of before would misunderstand.
inline constexpr int kViewProtocol = 2;

// `server`: another one each time a server is started. `pictures`: whether robots' cameras can be seen.
std::string hello_message(world_server::OperatorId you, std::uint32_t server, std::string_view world,
                          double time_step_s, double operator_silence_s, bool pictures);
// What a robot or a box is, beside how it moves: sent when one comes or leaves.
std::string inventory_message(const world_server::WorldState& state);
// Whether a page that has the inventory of `a` needs that of `b`.
bool same_inventory(const world_server::WorldState& a, const world_server::WorldState& b);
// How everything moves. `number` counts the messages, `reached` is robot time by wall-clock time.
// `frames`: of the cameras that somebody looks through, wherever.
struct FrameAge {
  image_server::CameraId id;
  std::uint64_t number;
  double robot_time_s, age_s;
};
std::string state_message(const world_server::WorldState& state, std::uint64_t number, double reached,
                          std::size_t viewers, std::span<const FrameAge> frames = {});
std::string refused_message(std::string_view request, std::string_view reason);
std::string placed_message(std::uint32_t robot);
std::string pong_message(double t);

}  // namespace kenaf::live
