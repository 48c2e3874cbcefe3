// Where a report.json says that the gap is, as far as playback marks it.
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
  std::string run;      // file of the repeat whose times these are; empty in reports that do not say
  double from_s, to_s;  // finite, 0 <= from_s <= to_s
  double share;         // of the gap, from 0 to 1
};

struct ReportedPlaces {
  std::string verdict;
  std::vector<std::string> named;
  std::vector<ReportedPhase> phases;            // as the report has them: largest share first
  std::map<std::string, double> channel_share;  // by column
};

// Throws std::runtime_error in words where `report_json` is none of the formats kenaf-gap-report/1 and /2. (Of
// version 2 these are the places of the stage that holds most of the gap.)
ReportedPlaces parse_reported_places(std::string_view report_json);

// Those of one run: its own, or those of the repeat that the report has in its place. `world_of`: of each run's file; a
// report that has several repeats of that manoeuvre in that world, and not this run, says nothing of it.
std::vector<ReportedPhase> phases_of_run(const ReportedPlaces& places, const std::string& file,
                                         const std::string& manoeuvre,
                                         const std::map<std::string, std::string>& world_of);

}  // namespace kenaf::gap::playback
