// What a page sends, what a browser's headers hold, and what a command line says of the view. Invariants: nothing dies,
// and a request that is taken has numbers that a robot can be commanded.
#include <cmath>
#include <cstdlib>
#include <stdexcept>
#include <string_view>

#include "server/live/access.hpp"
#include "server/live/picture_stream.hpp"
#include "server/live/request.hpp"
#include "server/live/view_options.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace kenaf;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const auto parsed = live::parse_request(text);
  if (const auto* request = std::get_if<live::Request>(&parsed)) {
    if (const auto* drive = std::get_if<live::DriveRequest>(request)) {
      for (const double speed : drive->command.track_speed_mps) {
        if (!std::isfinite(speed)) std::abort();
      }
      for (const robot::JointCommand& joint : drive->command.flipper) {
        if (!std::isfinite(joint.value)) std::abort();
      }
    }
    if (const auto* place = std::get_if<live::PlaceRequest>(request); place && place->where) {
      if (!place->where->p_W.allFinite() || !std::isfinite(place->where->yaw_rad)) std::abort();
    }
    if (const auto* look = std::get_if<live::LookRequest>(request)) {
      for (const auto& angle : {look->order.pan_rad, look->order.tilt_rad, look->order.field_of_view_rad}) {
        if (angle && !std::isfinite(*angle)) std::abort();
      }
    }
  } else if (std::get<std::string>(parsed).empty()) {
    std::abort();
  }
  live::host_allowed(text, "workbench");
  live::origin_allowed(text, "127.0.0.1:8080");
  live::query_value(text, "token");
  if (const auto path = live::parse_picture_path(text, text); path && path->view.size() > text.size()) std::abort();
  try {
    live::parse_view_options(text);
  } catch (const std::runtime_error&) {
  }
  return 0;
}
