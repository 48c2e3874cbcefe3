// What the server tells a client about its robot; each function appends whole messages to session.out.
#pragma once

#include "physics/server/simulation.hpp"

namespace kenaf::server {

// SEN: every sensor that has something to report, in the order of the UT2004 server.
void write_sensors(Simulation& simulation, Session& session);
// MISSTA (UT2004) or ASTA (UDK): a line for each mission package.
void write_mission_packages(const Simulation& simulation, Session& session);
// STA
void write_status(const Simulation& simulation, Session& session);

}  // namespace kenaf::server
