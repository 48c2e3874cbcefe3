#include "relayd/options.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <stdexcept>
#include <vector>

#include "command_line/checks.hpp"
#include "command_line/parse.hpp"
#include "formats/description/description_file.hpp"

namespace kenaf::relayd {

namespace {

using command_line::readable_by;

constexpr double kFarthest = 1e6;  // of --pose, m and rad: chosen

// A name becomes part of a message whose words are separated by blanks, within braces.
void require_name(const std::string& text) {
  if (text.empty() || text.find_first_of("{} \t\r\n") != std::string::npos)
    throw std::runtime_error("must be a word without blanks and braces");
}

}  // namespace

std::optional<Options> read_options(int argc, const char* const* argv, int& exit_status) {
  Options options;
  EmbeddedWorld embedded;
  std::string world_server = "127.0.0.1:3000", listen = "127.0.0.1:45454";
  std::vector<double> pose;
  RobotPlacement& placement = options.relay.placement;

  CLI::App app("Relays between a program on libkenaf_sim (UDP) and a USARSim world server (TCP).", "kenaf-relayd");
  auto* server_option = app.add_option("--world-server", world_server, "the world server, HOST:PORT")
                            ->check(readable_by(parse_server))
                            ->capture_default_str();
  app.add_option("--listen", listen, "address to listen on, ADDR:PORT; port 0: any free one")
      ->check(readable_by(parse_address))
      ->capture_default_str();
  app.add_option("--port-file", options.port_file, "write the port into this file");
  app.add_option("--class", placement.class_name, "the robot's USARSim class")
      ->check(readable_by(require_name))
      ->capture_default_str();
  app.add_option("--name", placement.name, "the robot's name in the world")
      ->check(readable_by(require_name))
      ->capture_default_str();
  auto* start_option =
      app.add_option("--start", placement.start, "the start pose of the world to use (default: the server chooses)");
  start_option->check(readable_by(require_name));
  app.add_option("--pose", pose, "start pose instead: x,y,z,roll,pitch,yaw in metres and radians, z up")
      ->delimiter(',')
      ->expected(6)
      ->check(command_line::number_in(-kFarthest, kFarthest))
      ->excludes(start_option);
  app.add_option("--log-level", options.log_level, "trace, debug, info, warn, error or off")
      ->transform(command_line::log_level())
      ->capture_default_str();
  bool is_embedded = false;
  auto* embedded_flag =
      app.add_flag("--embedded", is_embedded, "runs the world server inside this process")->excludes(server_option);
  app.add_option("--world", embedded.world, "world of --embedded")
      ->needs(embedded_flag)
      ->check(readable_by([](const std::string& text) { description::require_description("world", text, ".sdf"); }))
      ->capture_default_str();
  app.add_option("--robot", embedded.robot, "robot of --embedded")
      ->needs(embedded_flag)
      ->check(readable_by([](const std::string& text) { description::require_description("robot", text, ".toml"); }))
      ->capture_default_str();
  app.add_option("--speed", embedded.speed, "speed of --embedded, in multiples of real time; 0: as fast as possible")
      ->needs(embedded_flag)
      ->check(command_line::number_in(0, 1e6))
      ->capture_default_str();

  std::string view_token, view = "127.0.0.1:8080";
  app.add_option("--view", view, "address of the live view of --embedded, ADDRESS:PORT, or off")
      ->needs(embedded_flag)
      ->check(readable_by(live::parse_view_options))
      ->capture_default_str();
  app.add_option("--view-token", view_token, "token that a browser must give; off loopback the default is a random one")
      ->needs(embedded_flag)
      ->check(readable_by(live::parse_view_token));

  std::string cameras = "on", camera_port = "5003", camera_image = "good";
  const auto camera_option = [&](const char* name, std::string& text,
                                 void (*set)(image_server::CameraOptions&, std::string_view), const char* what) {
    app.add_option(name, text, what)
        ->needs(embedded_flag)
        ->check(readable_by([&embedded, set](const std::string& given) { set(embedded.cameras, given); }))
        ->capture_default_str();
  };
  camera_option("--cameras", cameras, image_server::set_cameras,
                "off: no camera pictures from --embedded, neither by TCP nor in the live view");
  camera_option("--camera-port", camera_port, image_server::set_camera_port,
                "TCP port of the image server of --embedded, on loopback; 0: any free one; off: none");
  camera_option("--camera-image", camera_image, image_server::set_camera_image,
                "format of the pictures: raw, or JPEG of quality superb, good, normal, fair or bad");

  if (const auto status = command_line::parse(app, argc, argv)) {
    exit_status = *status;
    return std::nullopt;
  }
  options.relay.world_server = parse_server(world_server);
  options.relay.listen = parse_address(listen);
  if (!pose.empty()) {
    placement.pose.emplace();
    std::copy_n(pose.begin(), 6, placement.pose->begin());
  }
  embedded.view = live::parse_view_options(view);
  embedded.view.token = view_token;
  embedded.view.asked_for = app.count("--view") + app.count("--view-token") > 0;
  embedded.cameras.port_asked_for = app.count("--camera-port") > 0;
  if (is_embedded) options.embedded = embedded;
  return options;
}

}  // namespace kenaf::relayd
