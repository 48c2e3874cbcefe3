// What of a run is compared: the mean of each channel over short spans of time.
//
// A span's mean has less noise than a sample, and real and simulated runs need not be sampled at the same times. Time
// is never warped: that would hide a delay.
//
// Thread safety: immutable after construction.
#pragma once

#include <Eigen/Core>
#include <span>
#include <string>
#include <vector>

#include "formats/runs/run_file.hpp"

namespace kenaf::gap::diagnose {

struct Bin {
  std::size_t channel;  // of diagnosis_channels()
  std::size_t span;     // its number from the start of the run: [span, span + 1) times span_s
  std::size_t samples;  // that were measured in it, at least one
};

class FeatureMap {
 public:
  // Bins of every channel that was measured, but those of columns `left_out`, channel by channel, in the order of time.
  FeatureMap(const runs::Run& measured, double span_s, std::span<const std::string> left_out = {});

  std::span<const Bin> bins() const { return bins_; }
  double span_s() const { return span_s_; }
  const Eigen::VectorXd& measured() const { return measured_; }
  // A simulated run at the times at which the channels were measured, interpolated, then likewise averaged. Where it
  // ended early its last value stands; a channel that it does not have is 0. `late`: how much earlier than they say the
  // samples were taken, in parts of the time since the one before.
  Eigen::VectorXd of(const runs::Run& simulated, double late = 0) const;

 private:
  struct Series {
    std::size_t channel;
    std::vector<double> t_s, value;
    double interval_s;  // from one sample to the next, the median
  };
  std::vector<double> simulated_at(const runs::Run& simulated, const Series& series, double late) const;

  double span_s_;
  std::vector<Series> series_;
  std::vector<Bin> bins_;
  Eigen::VectorXd measured_;
};

}  // namespace kenaf::gap::diagnose
