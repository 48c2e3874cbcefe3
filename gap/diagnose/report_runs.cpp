#include <utility>

#include "gap/diagnose/page/overlays.hpp"
#include "gap/diagnose/report.hpp"

namespace kenaf::gap::diagnose {

std::vector<ShownRun> shown_runs(const Diagnosis& diagnosis) {
  std::vector<ShownRun> shown;
  for (Overlay& overlay : simulate_overlays(diagnosis)) {
    const Observation& measured = diagnosis.observations.runs[overlay.run];
    shown.push_back({measured.file, measured.run, std::move(overlay.nominal), std::move(overlay.corrected)});
  }
  return shown;
}

}  // namespace kenaf::gap::diagnose
