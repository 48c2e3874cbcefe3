// Random bytes from a client through the splitter, the verbs and the world, with steps in between. Invariants: nothing
// dies, the world stays finite, and what is written back are whole lines.
#include <spdlog/spdlog.h>

#include <cstdlib>
#include <string_view>

#include "server/world_server/simulation.hpp"

namespace {

using namespace kenaf;

world_server::ServerOptions options(bool udk_dialect) {
  world_server::ServerOptions chosen;
  chosen.speed = 0;
  chosen.udk_dialect = udk_dialect;
  chosen.time_step_s = 0.005;
  return chosen;
}

void check(bool fine) {
  if (!fine) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  [[maybe_unused]] static const bool quiet = [] {
    spdlog::set_level(spdlog::level::off);
    return true;
  }();
  if (size == 0 || size > 4096) return 0;
  // Loading a world and a robot takes far longer than a line, so one simulation of each dialect serves all inputs; each
  // input gets sessions of its own, and the objects it made are removed.
  static world_server::Simulation simulations[2] = {world_server::Simulation(options(false)),
                                                    world_server::Simulation(options(true))};
  world_server::Simulation& simulation = simulations[data[0] & 1];
  simulation.clock.set_speed(0);
  simulation.set_paused(false);
  world_server::Session& session = simulation.connect("fuzz");
  if ((data[0] & 2) != 0) {
    simulation.receive(session, "CONTROL {Type Session} {Period 0.01}\r\nINIT {ClassName USARBot.P2DX}\r\n", 0);
  }

  std::string_view bytes(reinterpret_cast<const char*>(data + 1), size - 1);
  double wall_s = 0;
  while (!bytes.empty() && !session.close) {
    const std::string_view piece = bytes.substr(0, 256);
    bytes.remove_prefix(piece.size());
    simulation.receive(session, piece, wall_s);
    for (int i = 0; i < 3; ++i) simulation.advance(wall_s += 0.01);
  }
  check(session.out.empty() || session.out.ends_with("\r\n"));
  for (const physics::RobotId id : simulation.world.robots()) {
    const physics::RobotTruth truth = simulation.world.truth(id);
    check(truth.X_WB.p.allFinite() && truth.X_WB.q.coeffs().allFinite());
    check(truth.v_WB_mps.allFinite() && truth.w_WB_radps.allFinite());
  }
  simulation.disconnect(session);
  for (const world_server::WorldObject& object : simulation.objects) simulation.world.remove_box(object.box);
  simulation.objects.clear();
  simulation.reset();
  return 0;
}
