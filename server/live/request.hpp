// Requests of a page: one JSON object per message. docs/live-view.md has the keys.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "robot/command.hpp"
#include "server/world_server/manual_drive.hpp"

namespace kenaf::live {

struct PauseRequest {
  bool on;
};
struct StepRequest {
  double time_s;
};  // more than 0, at most 60 s of robot time
struct SpeedRequest {
  double value;
};  // 0, or from 0.001 to 1000
struct ResetRequest {};
struct PlaceRequest {
  std::optional<world_server::GroundPlace> where{};  // within 10 km of the origin; none: at a free start pose
};                                                   // places a robot and takes it
struct TakeRequest {
  std::uint32_t robot;
};
struct LetGoRequest {
  std::uint32_t robot;
};
struct RemoveRequest {
  std::uint32_t robot;
};
struct DriveRequest {
  std::uint32_t robot;
  robot::Command command;
};  // finite numbers
struct LookRequest {
  std::uint32_t robot;
  std::string camera;
  world_server::CameraOrder order;
};  // finite numbers
// What this page's states have on top, from now on.
struct ShowRequest {
  bool contacts = false;
  std::uint32_t sensors = 0;  // of that robot; 0: of none
  bool operator==(const ShowRequest&) const = default;
};
struct PingRequest {
  double t;
};  // echoed unchanged

using Request = std::variant<PauseRequest, StepRequest, SpeedRequest, ResetRequest, PlaceRequest, TakeRequest,
                             LetGoRequest, RemoveRequest, DriveRequest, LookRequest, ShowRequest, PingRequest>;

// std::string: the reason why `text` is no request.
std::variant<Request, std::string> parse_request(std::string_view text);

}  // namespace kenaf::live
