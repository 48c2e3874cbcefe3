// The places of the gap in a report.json, as far as playback shows them.
//
// Thread safety: values and pure functions.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace kenaf::gap::playback {

struct ReportedPhase {
  std::string manoeuvre, phase;
  std::string run;      // file of the repeat to which the times belong; empty in reports that do not name it
  double from_s, to_s;  // finite, 0 <= from_s <= to_s
  double share;         // of the gap, from 0 to 1
};

// The worst moment of a run, by the report.
struct ReportedWorst {
  double at_s;
  double times_noise;  // rms over all channels
};

struct ReportedPlaces {
  std::string verdict;
  std::vector<std::string> named;
  std::string stage;                            // whose gap the shares are of; empty if the report does not say it
  std::vector<ReportedPhase> phases;            // as the report has them: largest share first
  std::map<std::string, double> channel_share;  // by column
  // By column, in its unit, 1 sigma of a mean over 0.25 s, above 0: of every stage's channels, not of one stage alone.
  std::map<std::string, double> channel_floor;
  std::map<std::string, ReportedWorst> worst_of_run;  // by file; empty in reports that do not have it
};

// Throws std::runtime_error with words for the user if `report_json` has neither format kenaf-gap-report/1 nor /2. In
// version 2 these are the places of the stage with most of the gap.
ReportedPlaces parse_reported_places(std::string_view report_json);

// Returns the phases of one run: its own, or those of the only repeat that the report has of the same manoeuvre and
// world. Empty if it has several repeats, but not this run. `world_of`: the world of each run's file.
std::vector<ReportedPhase> phases_of_run(const ReportedPlaces& places, const std::string& file,
                                         const std::string& manoeuvre,
                                         const std::map<std::string, std::string>& world_of);

}  // namespace kenaf::gap::playback
