#include "gap/diagnose/where.hpp"

#include <algorithm>
#include <cmath>

#include "gap/diagnose/channels.hpp"
#include "gap/diagnose/repeats.hpp"

namespace kenaf::gap::diagnose {
namespace {

using Eigen::VectorXd;

std::vector<ChannelGap> channels_of(const std::vector<StageFeatures>& features, const NoiseFloor& floor,
                                    const std::vector<VectorXd>& residual) {
  std::vector<ChannelGap> channels(diagnosis_channels().size());
  std::vector<double> bins(channels.size(), 0);
  for (std::size_t c = 0; c < channels.size(); ++c) channels[c] = {c, 0, 0, 0};
  for (std::size_t r = 0; r < features.size(); ++r)
    for (std::size_t b = 0; b < features[r].bins.size(); ++b) {
      const auto i = static_cast<Eigen::Index>(b);
      const std::size_t c = features[r].bins[b].channel;
      channels[c].rms += residual[r][i] * residual[r][i];
      channels[c].floor += floor.sigma_of_bin[r][i] * floor.sigma_of_bin[r][i];
      ++bins[c];
    }
  for (std::size_t c = 0; c < channels.size(); ++c)
    if (bins[c] > 0)
      for (double* value : {&channels[c].rms, &channels[c].floor}) *value = std::sqrt(*value / bins[c]);
  return channels;
}

}  // namespace

double beyond_chance(const Cell& cell) {
  return std::max(0.0, cell.z * cell.z - 1);
}

std::vector<Cell> cells_that_stand_out(const NoiseFloor& floor, const Coherence& coherence,
                                       const std::vector<VectorXd>& residual) {
  std::vector<VectorXd> whitened, in_sigmas;
  for (std::size_t r = 0; r < residual.size(); ++r) {
    whitened.push_back(floor.whiteners[r](residual[r]));
    in_sigmas.push_back(residual[r].cwiseQuotient(floor.sigma_of_bin[r]));
  }
  std::vector<Cell> cells = coherence.cells(whitened);
  const std::vector<Cell> with_shapes = coherence.cells(in_sigmas);
  for (std::size_t c = 0; c < cells.size(); ++c)
    if (std::abs(with_shapes[c].z) < std::abs(cells[c].z)) cells[c].z = with_shapes[c].z;
  return cells;
}

GapPlaces locate(const Observations& observations, const std::vector<StageFeatures>& features, const NoiseFloor& floor,
                 const std::vector<std::vector<std::size_t>>& repeats, const Coherence& coherence,
                 const std::vector<VectorXd>& residual) {
  // total energy beyond chance
  const std::vector<Cell> cells = cells_that_stand_out(floor, coherence, residual);
  double total = 0;
  for (const Cell& cell : cells) total += beyond_chance(cell);

  // shares of channels
  GapPlaces places{channels_of(features, floor, residual), {}, total};
  for (const Cell& cell : cells)
    if (total > 0) places.channels[cell.channel].share += beyond_chance(cell) / total;
  std::erase_if(places.channels, [](const ChannelGap& channel) { return channel.floor == 0; });
  std::ranges::stable_sort(places.channels, std::ranges::greater{}, &ChannelGap::share);

  // shares of the phases of each group's representative
  for (std::size_t g = 0; g < repeats.size(); ++g) {
    const Observation& run = observations.runs[representative(observations, repeats[g])];
    std::vector<PhaseGap> phases;
    for (const PhaseSpan& span : phases_of(run))
      phases.push_back({run.manoeuvre, span.name, span.from_s, span.to_s, span.x_m, span.y_m, 0, g});
    for (const Cell& cell : cells) {
      if (cell.group != g || total == 0) continue;
      // a stretch across several phases is divided between them by time
      const double from_s = static_cast<double>(cell.stretch) * coherence.stretch_s();
      for (PhaseGap& phase : phases) {
        const double common_s = std::min(phase.to_s, from_s + coherence.stretch_s()) - std::max(phase.from_s, from_s);
        if (common_s > 0) phase.share += common_s / coherence.stretch_s() * beyond_chance(cell) / total;
      }
    }
    places.phases.insert(places.phases.end(), phases.begin(), phases.end());
  }
  std::ranges::stable_sort(places.phases, std::ranges::greater{}, &PhaseGap::share);
  return places;
}

}  // namespace kenaf::gap::diagnose
