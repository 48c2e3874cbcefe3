// Carries out what a page asked for, on the world's thread.
#pragma once

#include <string>

#include "live/request.hpp"
#include "physics/server/simulation.hpp"

namespace kenaf::live {

// What to tell the page; empty: nothing. PingRequest is none of the world's business.
std::string carry_out(server::Simulation& simulation, server::OperatorId who, const Request& request);

}  // namespace kenaf::live
