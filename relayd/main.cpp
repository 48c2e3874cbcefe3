// kenaf-relayd: relay between a program on libkenaf_sim and a world server.
#include <signal.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <memory>
#include <stdexcept>

#include "formats/runs/port_file.hpp"
#include "relayd/embedded_world.hpp"
#include "relayd/options.hpp"
#include "relayd/relay.hpp"

namespace {

kenaf::relayd::Relay* relay_to_stop = nullptr;

void on_signal(int) {
  relay_to_stop->stop();
}

// Stops the relay on signals during its lifetime; afterwards signals are ignored, as the program is about to end.
class StopOnSignals {
 public:
  explicit StopOnSignals(kenaf::relayd::Relay& relay) {
    relay_to_stop = &relay;
    handle(on_signal);
  }
  ~StopOnSignals() { handle(SIG_IGN); }
  StopOnSignals(const StopOnSignals&) = delete;
  StopOnSignals& operator=(const StopOnSignals&) = delete;

 private:
  static void handle(void (*handler)(int)) {
    struct sigaction action {};
    action.sa_handler = handler;
    sigaction(SIGTERM, &action, nullptr);
    sigaction(SIGINT, &action, nullptr);
  }
};

}  // namespace

int main(int argc, char** argv) {
  // Help, version and wrong options end the program here.
  int exit_status = 0;
  auto options = kenaf::relayd::read_options(argc, argv, exit_status);
  if (!options) return exit_status;
  spdlog::set_default_logger(spdlog::stderr_color_mt("kenaf-relayd"));
  spdlog::set_level(spdlog::level::from_str(options->log_level));

  // With --embedded the world server is in this process, on a port of its own; it outlives the relay.
  try {
    std::unique_ptr<kenaf::relayd::EmbeddedWorldServer> world;
    if (options->embedded) {
      world = std::make_unique<kenaf::relayd::EmbeddedWorldServer>(*options->embedded);
      options->relay.world_server = {"127.0.0.1", world->port()};
    }

    // The socket is bound before the port file says so; run() lasts until a signal.
    kenaf::relayd::Relay relay(options->relay);
    const StopOnSignals stop_on_signals(relay);
    spdlog::info("listening on {}", to_text(relay.address()));
    if (!options->port_file.empty()) kenaf::runs::write_port_file(options->port_file, relay.address().port);
    relay.run();
    spdlog::info("ended");
    return 0;
  } catch (const std::exception& error) {
    spdlog::critical("{}", error.what());
    return 1;
  }
}
