// Energy of whitened differences in cells, in which a gap adds up and noise averages out.
//
// A gap is correlated between repeats of a manoeuvre and between neighbouring spans of time; noise is not. So
// differences are averaged over both (a cell: one channel in one stretch of a manoeuvre) before squaring: 1 is chance.
//
// Thread safety: values and pure functions.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "gap/diagnose/noise_floor.hpp"
#include "gap/diagnose/stage_features.hpp"

namespace kenaf::gap::diagnose {

struct Cell {
  std::size_t group;  // of repeats_of()
  std::size_t channel;
  std::size_t stretch;  // number from the start: [stretch, stretch + 1) times stretch_s
  double z;             // standard normal by chance
};

// Sum over the cells of one channel.
struct ChannelEnergy {
  double energy = 0;  // sum of z^2
  std::size_t cells = 0;
};

class Coherence {
 public:
  Coherence(const std::vector<StageFeatures>& features, std::vector<std::vector<std::size_t>> groups, double stretch_s);

  const std::vector<std::vector<std::size_t>>& groups() const { return groups_; }
  std::size_t cell_count() const { return cells_.size(); }
  double stretch_s() const { return stretch_s_; }
  std::vector<Cell> cells(const std::vector<Eigen::VectorXd>& whitened) const;
  // Sum of z^2 over all cells; close to cell_count() by chance.
  double energy(const std::vector<Eigen::VectorXd>& whitened) const;
  // The same for each of diagnosis_channels().
  std::vector<ChannelEnergy> by_channel(const std::vector<Eigen::VectorXd>& whitened) const;

 private:
  std::vector<std::vector<std::size_t>> groups_;
  double stretch_s_;
  std::vector<Cell> cells_;                        // with z = 0
  std::vector<double> scale_;                      // 1 / sqrt(number of bins in a cell)
  std::vector<std::vector<std::size_t>> cell_of_;  // of each bin of each run
};

}  // namespace kenaf::gap::diagnose
