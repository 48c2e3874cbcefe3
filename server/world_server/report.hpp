// Reports to a client about its robot; each function appends whole messages to session.out.
#pragma once

#include "server/world_server/simulation.hpp"

namespace kenaf::world_server {

// SEN: every sensor with new data.
void write_sensors(Simulation& simulation, Session& session);
// The same for given samples, in the order of the UT2004 server. Reverses range scans in place.
void write_samples(std::vector<physics::SensorSample>& samples, const std::vector<physics::SensorDescription>& sensors,
                   Dialect dialect, const Formats& formats, bool extended, std::string& out);
// MISSTA (UT2004) or ASTA (UDK): a line for each mission package.
void write_mission_packages(const Simulation& simulation, Session& session);
// STA
void write_status(const Simulation& simulation, Session& session);
// RES {Time t} {Type Robot} {Name n} {Status OK} {Warning words}, for a client with a Session alone.
void write_warning(const Simulation& simulation, Session& session, std::string_view words);

}  // namespace kenaf::world_server
