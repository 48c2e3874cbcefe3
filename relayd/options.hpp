// The command line of kenaf-relayd.
#pragma once

#include <optional>
#include <string>

#include "relayd/relay.hpp"
#include "server/image_server/options.hpp"
#include "server/live/view_options.hpp"

namespace kenaf::relayd {

struct EmbeddedWorld {
  std::string world = "flat";
  std::string robot = "kenaf";
  double speed = 1;
  live::ViewOptions view;
  image_server::CameraOptions cameras;
};

struct Options {
  RelayOptions relay;
  std::string port_file;  // empty: none
  std::string log_level = "info";
  std::optional<EmbeddedWorld> embedded;
};

// Prints help, version or the error and sets `exit_status`; then returns no options.
std::optional<Options> read_options(int argc, const char* const* argv, int& exit_status);

}  // namespace kenaf::relayd
