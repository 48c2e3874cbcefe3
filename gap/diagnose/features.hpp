// The features of a run that are compared: means of each channel over short spans of time.
//
// A mean has less noise than a sample, and real and simulated runs need not be sampled at the same times. Time is never
// warped, as that would hide a delay.
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
  std::size_t span;     // number from the start of the run: [span, span + 1) times span_s
  std::size_t samples;  // measured in it, at least one
};

class FeatureMap {
 public:
  // Bins of every measured channel except columns `left_out`, channel by channel, in the order of time. Yaw goes on
  // over a gap by the whole turns of the gyro, or else of the tracks as far as they turn the body elsewhere in the run;
  // without them the shorter way.
  FeatureMap(const runs::Run& measured, double span_s, std::span<const std::string> left_out = {});

  std::span<const Bin> bins() const { return bins_; }
  double span_s() const { return span_s_; }
  const Eigen::VectorXd& measured() const { return measured_; }
  // Features of a simulated run: interpolated at the measured times, then averaged likewise. After its end its last
  // value holds; channels that it lacks are 0. `late`: how much earlier than stated the samples were taken, in sample
  // intervals.
  Eigen::VectorXd of(const runs::Run& simulated, double late = 0) const;

 private:
  struct Series {
    std::size_t channel;
    std::vector<double> t_s, value;
    double interval_s;  // median sample interval
  };
  std::vector<double> simulated_at(const runs::Run& simulated, const Series& series, double late) const;

  double span_s_;
  std::vector<Series> series_;
  std::vector<Bin> bins_;
  Eigen::VectorXd measured_;
};

}  // namespace kenaf::gap::diagnose
