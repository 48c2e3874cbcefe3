// kenaf-gap play: shows recorded runs beside their simulations in a browser.
#include <pthread.h>
#include <signal.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <stdexcept>

#include "command_line/checks.hpp"
#include "gap/commands/commands.hpp"
#include "gap/playback/playback_server.hpp"
#include "server/live/view_options.hpp"

namespace kenaf::gap::commands {
namespace {

constexpr double kLongest_s = 1e6;  // of a run: about twelve days

// Blocks the signals in this thread and those that it starts: none is interrupted, and one waits for them.
sigset_t block_signals_to_end() {
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGINT);
  sigaddset(&signals, SIGTERM);
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  return signals;
}

void wait_for(const sigset_t& signals) {
  int signal = 0;
  sigwait(&signals, &signal);
  // A second signal ends the program at once, whatever is still being simulated.
  pthread_sigmask(SIG_UNBLOCK, &signals, nullptr);
}

}  // namespace

void add_play_command(CLI::App& program) {
  struct Options {
    playback::PlaybackRequest request;
    std::string view = "127.0.0.1:8080", token;
  };
  // Shared with the callback, which runs after this function has returned.
  const auto options = std::make_shared<Options>();
  playback::PlaybackRequest& request = options->request;
  CLI::App* command = program.add_subcommand("play", "plays recorded runs in a browser, next to their simulations");
  command->add_option("RUNS", request.runs, "a dataset's folder, or the CSV file of one run; required")->type_name("");
  command->add_option("--report", request.report, "folder that a diagnosis of these runs wrote: marks where the gap is")
      ->type_name("DIR");
  command->add_option("--run", request.run, "file or manoeuvre to show first [the first]");
  command->add_option("--at", request.at_s, "when to begin in that run, from its first row [its start]")
      ->type_name("SECONDS")
      ->check(command_line::number_in(0, kLongest_s));
  command->add_option("--robot", request.robot, "a shipped name or a TOML file [the dataset's, or kenaf]");
  command->add_option("--world", request.world, "a shipped name or an SDF file [each run's own, or flat]");
  command->add_option("--view", options->view, "address of the page, ADDRESS:PORT; port 0: any free one")
      ->type_name("ADDRESS:PORT")
      ->check(command_line::readable_by([](const std::string& text) {
        if (!live::parse_view_options(text).on)
          throw std::runtime_error("must be ADDRESS:PORT: off leaves nothing to do");
      }))
      ->capture_default_str();
  command
      ->add_option("--view-token", options->token,
                   "token that a browser must give; off loopback the default is a random one")
      ->type_name("TOKEN")
      ->check(command_line::readable_by([](const std::string& text) { (void)live::parse_view_token(text); }));

  command->callback([options] {
    if (options->request.runs.empty()) throw CLI::RequiredError("RUNS");

    live::ViewOptions view = live::parse_view_options(options->view);
    view.token = options->token;
    playback::Playback playback = playback::load_playback(options->request);
    for (const std::string& note : playback.notes) std::fprintf(stderr, "kenaf-gap: %s\n", note.c_str());

    // Signals are blocked before the server starts its threads, which inherit that.
    const sigset_t signals = block_signals_to_end();
    const playback::PlaybackServer server(std::move(playback), view);
    std::printf("%s\nControl-C ends it\n", server.url().c_str());
    std::fflush(stdout);
    wait_for(signals);
  });
}

}  // namespace kenaf::gap::commands
