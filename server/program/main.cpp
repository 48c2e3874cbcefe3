// kenaf-world: the simulated world behind the USARSim protocol.
#include <pthread.h>
#include <signal.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <limits>
#include <thread>

#include "command_line/checks.hpp"
#include "command_line/parse.hpp"
#include "formats/description/description_file.hpp"
#include "formats/protocol/host_port.hpp"
#include "formats/runs/port_file.hpp"
#include "server/image_server/served_cameras.hpp"
#include "server/live/view.hpp"
#include "server/world_server/world_server.hpp"

int main(int argc, char** argv) {
  namespace command_line = kenaf::command_line;
  using command_line::readable_by;
  kenaf::world_server::ServerOptions options;
  std::string dialect = "ut2004", log_level = "info", port_file, view = "127.0.0.1:8080", token, cameras = "on",
              camera_port = "5003", camera_image = "good";
  CLI::App app{"The Kenaf world server: simulated robots behind the USARSim protocol, a TCP connection for each.",
               "kenaf-world"};
  app.add_option("--world", options.world, "World: a shipped name or an SDF file")
      ->capture_default_str()
      ->check(
          readable_by([](const std::string& text) { kenaf::description::require_description("world", text, ".sdf"); }));
  app.add_option("--robot", options.robot,
                 "Robot of the class USARBot.Kenaf: a shipped name or a TOML file. Other classes, such as "
                 "USARBot.P2AT, keep their shipped descriptions")
      ->capture_default_str()
      ->check(readable_by(
          [](const std::string& text) { kenaf::description::require_description("robot", text, ".toml"); }));
  app.add_option("--port", options.port, "TCP port; 0: any free one, which is printed")
      ->capture_default_str()
      ->check(command_line::whole_number(0, 65535));
  app.add_option("--listen", options.listen_address, "Address to listen on")
      ->capture_default_str()
      ->check(readable_by([](const std::string& text) {
        if (!kenaf::protocol::parse_listen_host(text))
          throw std::runtime_error(std::string(kenaf::protocol::kMustBeListenHost));
      }));
  app.add_option("--speed", options.speed, "Speed in multiples of real time; 0: as fast as possible")
      ->capture_default_str()
      ->check(command_line::number_in(0, 1e6));
  app.add_option("--dialect", dialect, "Dialect of the messages sent; both are understood")
      ->capture_default_str()
      ->check(command_line::one_of({"ut2004", "udk"}));
  app.add_option("--seed", options.seed, "Seed of the sensors' noise")
      ->capture_default_str()
      ->check(command_line::whole_number(0, std::numeric_limits<decltype(options.seed)>::max()));
  app.add_option("--time-step", options.time_step_s, "Physics time step in seconds")
      ->capture_default_str()
      ->check(command_line::number_in(1e-6, 0.02));
  app.add_option("--peer-timeout", options.peer_silence_s,
                 "Seconds of wall-clock time without an answer of a client's machine after which its robot stops, "
                 "whatever it commands; 0: never")
      ->capture_default_str()
      ->check(command_line::number_in(0, 1e6));
  app.add_option("--port-file", port_file, "Write the port into this file once the server listens");
  app.add_option("--view", view, "Address of the live view, ADDRESS:PORT, or off")
      ->capture_default_str()
      ->check(readable_by(kenaf::live::parse_view_options));
  app.add_option("--view-token", token, "Token that a browser must give; off loopback the default is a random one")
      ->check(readable_by(kenaf::live::parse_view_token));
  kenaf::image_server::CameraOptions camera_options;
  const auto sets = [&camera_options](void (*set)(kenaf::image_server::CameraOptions&, std::string_view)) {
    return readable_by([&camera_options, set](const std::string& text) { set(camera_options, text); });
  };
  app.add_option("--cameras", cameras, "off: no camera pictures, neither by TCP nor in the live view")
      ->capture_default_str()
      ->check(sets(kenaf::image_server::set_cameras));
  app.add_option("--camera-port", camera_port, "TCP port of USARSim's image server; 0: any free one; off: none")
      ->capture_default_str()
      ->check(sets(kenaf::image_server::set_camera_port));
  app.add_option("--camera-image", camera_image,
                 "Format of the pictures: raw, or JPEG of quality superb, good, normal, fair or bad")
      ->capture_default_str()
      ->check(sets(kenaf::image_server::set_camera_image));
  app.add_option("--log-level", log_level, "Log level")->capture_default_str()->transform(command_line::log_level());
  if (const auto status = command_line::parse(app, argc, argv)) return *status;
  options.udk_dialect = dialect == "udk";
  spdlog::set_level(spdlog::level::from_str(log_level));
  spdlog::flush_on(spdlog::level::info);

  try {
    kenaf::live::ViewOptions view_options = kenaf::live::parse_view_options(view);
    view_options.token = token;
    view_options.asked_for = app.count("--view") + app.count("--view-token") > 0;
    camera_options.port_asked_for = app.count("--camera-port") > 0;
    kenaf::world_server::WorldServer server(options);

    // Not before the world is loaded: until then a signal ends the program at once, whatever it waits for. From here on
    // blocked in every thread, so that only the waiting thread gets them.
    sigset_t signals;
    sigemptyset(&signals);
    sigaddset(&signals, SIGTERM);
    sigaddset(&signals, SIGINT);
    pthread_sigmask(SIG_BLOCK, &signals, nullptr);

    const auto served_cameras = kenaf::image_server::open_cameras(server, camera_options, options.listen_address);
    const auto live_view = kenaf::live::open_view(server, view_options, served_cameras.feed.get());
    std::thread stopper([&] {
      int signal = 0;
      sigwait(&signals, &signal);
      server.stop();
    });
    int status = 0;
    try {
      const std::string host = kenaf::protocol::parse_listen_host(options.listen_address).value();
      spdlog::info("world {} on {}", options.world, kenaf::protocol::to_text({host, server.port()}));
      if (!port_file.empty()) kenaf::runs::write_port_file(port_file, server.port());
      server.run();
      spdlog::info("stopped");
    } catch (const std::exception& error) {
      spdlog::critical("{}", error.what());
      status = 1;
    }
    // NOLINTNEXTLINE(bugprone-bad-signal-to-kill-thread): the thread waits for it by sigwait
    pthread_kill(stopper.native_handle(), SIGTERM);  // in case no signal ended it
    stopper.join();
    return status;
  } catch (const std::exception& error) {
    spdlog::critical("{}", error.what());
    return 1;
  }
}
