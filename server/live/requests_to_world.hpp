// Carries out a page's requests, on the world's thread.
#pragma once

#include <string>

#include "server/live/request.hpp"
#include "server/world_server/simulation.hpp"

namespace kenaf::live {

// Returns the answer to the page; empty: none. ShowRequest and PingRequest do not concern the world.
std::string carry_out(world_server::Simulation& simulation, world_server::OperatorId who, const Request& request);

}  // namespace kenaf::live
