#include "gap/playback/run_gap.hpp"

namespace kenaf::gap::playback {

std::map<std::string, Floor> floors_of(const std::map<std::string, double>& stated_noise,
                                       const ReportedPlaces* report) {
  return diagnose::floors_of(stated_noise, report ? report->channel_floor : std::map<std::string, double>());
}

diagnose::RunGap gap_of_run(const runs::Run& recorded, const runs::Run& simulated,
                            const std::map<std::string, Floor>& floors) {
  const std::span<const double> time = recorded.column("t_s");
  if (time.empty()) return {};
  return diagnose::gap_of_run(diagnose::FeatureMap(recorded, kSpan_s), time.back() - time.front(), simulated, floors);
}

std::string_view floor_name(FloorFrom from) {
  switch (from) {
    case FloorFrom::report:
      return "report";
    case FloorFrom::stated_noise:
      return "stated noise";
    case FloorFrom::resolution:
      break;
  }
  return "resolution";
}

}  // namespace kenaf::gap::playback
