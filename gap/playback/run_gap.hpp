// What a playback says of a run's gap: gap/diagnose/run_gap.hpp defines it, for the report too.
//
// Thread safety: values and pure functions.
#pragma once

#include <map>
#include <string>
#include <string_view>

#include "gap/diagnose/run_gap.hpp"
#include "gap/playback/reported_places.hpp"

namespace kenaf::gap::playback {

using diagnose::Floor;
using diagnose::FloorFrom;

inline constexpr double kSpan_s = 0.25;  // that of a diagnosis

// The floor of each channel of a diagnosis, by column. `report` may be null.
std::map<std::string, Floor> floors_of(const std::map<std::string, double>& stated_noise, const ReportedPlaces* report);

// How far a simulation is from the run as it was recorded, in the channels that both have.
diagnose::RunGap gap_of_run(const runs::Run& recorded, const runs::Run& simulated,
                            const std::map<std::string, Floor>& floors);

std::string_view floor_name(FloorFrom from);  // "report", "stated noise", "resolution"

}  // namespace kenaf::gap::playback
