// Cost of the live view in thread CPU time: filling a state on the world's thread, compared with a step of the world,
// and formatting it on the view's thread.
#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <CLI/CLI.hpp>

#include "bench/thread_time.hpp"
#include "command_line/parse.hpp"
#include "server/live/messages.hpp"
#include "server/world_server/manual_drive.hpp"

namespace {

using namespace kenaf;

template <typename Work>
double microseconds(int times, Work work) {
  work();
  const double began = bench::thread_time_s();
  for (int i = 0; i < times; ++i) work();
  return (bench::thread_time_s() - began) / times * 1e6;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Cost of the live view's states", "view_cost"};
  if (const auto status = kenaf::command_line::parse(app, argc, argv)) return *status;
  spdlog::set_level(spdlog::level::warn);
  fmt::print(
      "robots  step/us  state/us  words/us  bytes  states at 30 Hz of one core  contacts/us, bytes  one robot's "
      "sensors/us\n");
  for (const int robots : {1, 8, 64}) {
    // A world with so many robots, then the time of a step, of a state and of its text.
    world_server::ServerOptions options;
    options.speed = 0;
    world_server::Simulation simulation(options);
    for (int i = 0; i < robots; ++i) {
      world_server::Session& session = simulation.connect("bench");
      simulation.receive(
          session, fmt::format("INIT {{ClassName USARBot.Kenaf}} {{Name R{}}} {{Location 0,{},0}}\r\n", i, 2 * i), 0);
      session.out.clear();
    }
    const double step_us = microseconds(300, [&] { simulation.world.step(); });
    world_server::WorldState state;
    const double state_us = microseconds(3000, [&] { world_server::read_state(simulation, state); });
    std::string text;
    const double words_us = microseconds(300, [&] { text = live::state_message(state, 1, 1, 1, 1); });
    // With contacts of all robots, and with the sensors of one, as a page may ask for them.
    for (int i = 0; i < 500; ++i) simulation.world.step();
    const double contacts_us = microseconds(300, [&] { world_server::read_state(simulation, state, {true, {}}); });
    const std::size_t contacts_bytes = live::state_message(state, 1, 1, 1, 1, {}, {true, 0}).size();
    const std::uint32_t watched = state.robots.front().id;
    const double sensors_us = microseconds(300, [&] {
      world_server::read_state(simulation, state, {false, {watched}});
    });
    fmt::print("{:6}  {:7.1f}  {:8.2f}  {:8.1f}  {:5}  {:26.3f} %  {:11.2f}, {:5}  {:12.1f}\n", robots, step_us,
               state_us, words_us, text.size(), state_us * 30 * 1e-4, contacts_us, contacts_bytes, sensors_us);
  }
}
