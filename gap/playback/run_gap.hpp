// How far a simulation is from its recorded run: by channel and by moment, in floors.
//
// A *floor* is the difference below which a channel has no gap. Differences are simulated minus recorded, averaged over
// spans of 0.25 s as in a diagnosis, so that the noise of single samples does not count.
//
// Thread safety: values and pure functions.
#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "gap/playback/played_run.hpp"
#include "gap/playback/reported_places.hpp"

namespace kenaf::gap::playback {

inline constexpr double kSpan_s = 0.25;  // that of a diagnosis

enum class FloorFrom { report, stated_noise, resolution };

struct Floor {
  double value;  // 1 sigma, in the channel's unit, above 0
  FloorFrom from;
};

// The floor of each channel of a diagnosis: the report's; otherwise the noise that the dataset states for a sample, but
// at least the smallest difference that counts in a diagnosis. `report` may be null.
std::map<std::string, Floor> floors_of(const std::map<std::string, double>& stated_noise, const ReportedPlaces* report);

struct WorstMoment {
  double t_s;                // the middle of its span
  double floors;             // rms over all channels
  std::string column;        // the channel with the most floors there
  double difference;         // of that channel, in its unit
  double difference_floors;  // the same in floors, without sign
};

struct RunGap {
  std::map<std::string, std::vector<double>> differences;  // by column: for each span, NaN where one is not known
  std::map<std::string, double> floors;                    // by column: rms over the spans
  std::optional<WorstMoment> worst;                        // none if nothing can be compared
};

// Compares the channels that both have. `times_s` begins at 0; `floors`: as floors_of() returns them.
RunGap gap_of_run(const PlayedBody& recorded, const PlayedBody& simulated, std::span<const double> times_s,
                  const std::map<std::string, Floor>& floors);

std::string_view floor_name(FloorFrom from);  // "report", "stated noise", "resolution"

}  // namespace kenaf::gap::playback
