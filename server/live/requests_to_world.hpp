// Carries out what a page asked for, on the world's thread.
#pragma once

#include <string>

#include "server/live/request.hpp"
#include "server/world_server/simulation.hpp"

namespace kenaf::live {

// What to tell the page; empty: nothing. PingRequest is none of the world's business.
std::string carry_out(world_server::Simulation& simulation, world_server::OperatorId who, const Request& request);

}  // namespace kenaf::live
