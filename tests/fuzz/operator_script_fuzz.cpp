// A script is read or refused with its line; what is read can be played.
#include <cstdlib>
#include <stdexcept>
#include <string_view>

#include "teleop/script.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace kenaf::teleop;
  Script script;
  try {
    script = read_script(std::string_view(reinterpret_cast<const char*>(data), size));
  } catch (const std::runtime_error& error) {
    if (!std::string_view(error.what()).starts_with("line ")) std::abort();
    return 0;
  }
  Player player(script);
  Desk desk;
  Status status{};
  status.mode = Mode::halted;
  for (int i = 0; i < 50; ++i) {
    status.robot_time_s = i;
    const Player::Turn turn = player.turn(0.3 * i, i < 3 ? nullptr : &status, 0, desk);
    for (const Action action : turn.pressed) desk.act(action, 0.3 * i, &status);
    if (turn.finished) break;
  }
  return 0;
}
