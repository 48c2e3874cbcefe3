#include "gap/diagnose/coherence.hpp"

#include <cmath>
#include <map>
#include <tuple>
#include <utility>

#include "gap/diagnose/channels.hpp"

namespace kenaf::gap::diagnose {

Coherence::Coherence(const std::vector<StageFeatures>& features, std::vector<std::vector<std::size_t>> groups,
                     double stretch_s)
    : groups_(std::move(groups)), stretch_s_(stretch_s), cell_of_(features.size()) {
  std::map<std::tuple<std::size_t, std::size_t, std::size_t>, std::size_t> known;
  for (std::size_t g = 0; g < groups_.size(); ++g)
    for (const std::size_t r : groups_[g])
      for (const Bin& bin : features[r].bins) {
        const auto stretch =
            static_cast<std::size_t>((static_cast<double>(bin.span) + 0.5) * features[r].span_s / stretch_s);
        const auto [cell, is_new] = known.try_emplace({g, bin.channel, stretch}, cells_.size());
        if (is_new) {
          cells_.push_back({g, bin.channel, stretch, 0});
          scale_.push_back(0);
        }
        scale_[cell->second] += 1;
        cell_of_[r].push_back(cell->second);
      }
  for (double& scale : scale_) scale = 1 / std::sqrt(scale);
}

std::vector<Cell> Coherence::cells(const std::vector<Eigen::VectorXd>& whitened) const {
  std::vector<Cell> cells = cells_;
  for (std::size_t r = 0; r < cell_of_.size(); ++r)
    for (std::size_t b = 0; b < cell_of_[r].size(); ++b)
      cells[cell_of_[r][b]].z += whitened[r][static_cast<Eigen::Index>(b)];
  for (std::size_t c = 0; c < cells.size(); ++c) cells[c].z *= scale_[c];
  return cells;
}

double Coherence::energy(const std::vector<Eigen::VectorXd>& whitened) const {
  double energy = 0;
  for (const Cell& cell : cells(whitened)) energy += cell.z * cell.z;
  return energy;
}

std::vector<ChannelEnergy> Coherence::by_channel(const std::vector<Eigen::VectorXd>& whitened) const {
  std::vector<ChannelEnergy> channels(diagnosis_channels().size());
  for (const Cell& cell : cells(whitened)) {
    channels[cell.channel].energy += cell.z * cell.z;
    ++channels[cell.channel].cells;
  }
  return channels;
}

}  // namespace kenaf::gap::diagnose
