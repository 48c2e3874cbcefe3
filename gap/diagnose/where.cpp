#include "gap/diagnose/where.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <span>
#include <tuple>

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

// Differences of each run with the open shapes taken off (whitened), and with them (in sigmas).
struct Differences {
  std::vector<VectorXd> whitened, in_sigmas;
};
Differences differences_of(const NoiseFloor& floor, const std::vector<VectorXd>& residual) {
  Differences d;
  for (std::size_t r = 0; r < residual.size(); ++r) {
    d.whitened.push_back(floor.whiteners[r](residual[r]));
    d.in_sigmas.push_back(residual[r].cwiseQuotient(floor.sigma_of_bin[r]));
  }
  return d;
}

struct StandingOut {
  std::vector<Cell> cells;
  std::vector<bool> with_shapes;  // of each cell: whether its smaller energy is that with the shapes
};
StandingOut standing_out(const Differences& d, const Coherence& coherence) {
  StandingOut out{coherence.cells(d.whitened), {}};
  const std::vector<Cell> with_shapes = coherence.cells(d.in_sigmas);
  for (std::size_t c = 0; c < out.cells.size(); ++c) {
    out.with_shapes.push_back(std::abs(with_shapes[c].z) < std::abs(out.cells[c].z));
    if (out.with_shapes.back()) out.cells[c].z = with_shapes[c].z;
  }
  return out;
}

// The energy of what repeats have in common, in each span of each cell.
using SpanEnergies = std::map<std::tuple<std::size_t, std::size_t, std::size_t>, double>;  // group, channel, span
SpanEnergies span_energies(const std::vector<StageFeatures>& features,
                           const std::vector<std::vector<std::size_t>>& repeats,
                           const std::vector<VectorXd>& differences) {
  SpanEnergies energies;
  for (std::size_t g = 0; g < repeats.size(); ++g)
    for (const std::size_t r : repeats[g])
      for (std::size_t b = 0; b < features[r].bins.size(); ++b)
        energies[{g, features[r].bins[b].channel, features[r].bins[b].span}] +=
            differences[r][static_cast<Eigen::Index>(b)];
  for (auto& [place, sum] : energies) sum *= sum;
  return energies;
}

// The phases' parts of a cell: a stretch across several phases is divided between them by the energies of its spans, as
// a gap at its beginning is none of the phase at its end. Sums to 1, or less where no phase is.
std::vector<double> parts_of_phases(const Cell& cell, double stretch_s, double span_s, const SpanEnergies& energies,
                                    std::span<const PhaseGap> phases) {
  // the cell's spans are those whose middle is in its stretch
  const auto middle_s = [span_s](std::size_t span) { return (static_cast<double>(span) + 0.5) * span_s; };
  std::vector<double> parts(phases.size(), 0);
  double whole = 0;
  for (auto span = energies.lower_bound({cell.group, cell.channel, 0}); span != energies.end(); ++span) {
    const auto& [group, channel, number] = span->first;
    if (group != cell.group || channel != cell.channel) break;
    if (static_cast<std::size_t>(middle_s(number) / stretch_s) != cell.stretch) continue;
    whole += span->second;
    for (std::size_t p = 0; p < phases.size(); ++p) {
      const double from_s = middle_s(number) - span_s / 2, to_s = from_s + span_s;
      const double common_s = std::min(phases[p].to_s, to_s) - std::max(phases[p].from_s, from_s);
      if (common_s > 0) parts[p] += common_s / span_s * span->second;
    }
  }
  for (double& part : parts) part = whole > 0 ? part / whole : 0;
  return parts;
}

}  // namespace

double beyond_chance(const Cell& cell) {
  return std::max(0.0, cell.z * cell.z - 1);
}

std::vector<Cell> cells_that_stand_out(const NoiseFloor& floor, const Coherence& coherence,
                                       const std::vector<VectorXd>& residual) {
  return standing_out(differences_of(floor, residual), coherence).cells;
}

GapPlaces locate(const Observations& observations, const std::vector<StageFeatures>& features, const NoiseFloor& floor,
                 const std::vector<std::vector<std::size_t>>& repeats, const Coherence& coherence,
                 const std::vector<VectorXd>& residual) {
  // total energy beyond chance
  const Differences differences = differences_of(floor, residual);
  const auto [cells, with_shapes] = standing_out(differences, coherence);
  double total = 0;
  for (const Cell& cell : cells) total += beyond_chance(cell);

  // shares of channels
  GapPlaces places{channels_of(features, floor, residual), {}, total};
  for (const Cell& cell : cells)
    if (total > 0) places.channels[cell.channel].share += beyond_chance(cell) / total;
  std::erase_if(places.channels, [](const ChannelGap& channel) { return channel.floor == 0; });
  std::ranges::stable_sort(places.channels, std::ranges::greater{}, &ChannelGap::share);

  // shares of the phases of each group's representative
  const SpanEnergies whitened = span_energies(features, repeats, differences.whitened);
  const SpanEnergies in_sigmas = span_energies(features, repeats, differences.in_sigmas);
  const auto with_bins = std::ranges::find_if(features, [](const StageFeatures& f) { return !f.bins.empty(); });
  const double span_s = with_bins == features.end() ? 0 : with_bins->span_s;
  for (std::size_t g = 0; g < repeats.size(); ++g) {
    const Observation& run = observations.runs[representative(observations, repeats[g])];
    std::vector<PhaseGap> phases;
    for (const PhaseSpan& span : phases_of(run))
      phases.push_back({run.manoeuvre, span.name, span.from_s, span.to_s, span.x_m, span.y_m, 0, g});
    for (std::size_t c = 0; c < cells.size() && total > 0; ++c) {
      if (cells[c].group != g || beyond_chance(cells[c]) == 0) continue;
      const std::vector<double> parts =
          parts_of_phases(cells[c], coherence.stretch_s(), span_s, with_shapes[c] ? in_sigmas : whitened, phases);
      for (std::size_t p = 0; p < phases.size(); ++p) phases[p].share += parts[p] * beyond_chance(cells[c]) / total;
    }
    places.phases.insert(places.phases.end(), phases.begin(), phases.end());
  }
  std::ranges::stable_sort(places.phases, std::ranges::greater{}, &PhaseGap::share);
  return places;
}

}  // namespace kenaf::gap::diagnose
