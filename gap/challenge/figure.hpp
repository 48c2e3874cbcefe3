// A figure of a score: a share, a mean or a median with its confidence interval and target.
//
// Thread safety: values and pure functions.
#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

namespace kenaf::gap::challenge {

struct Figure {
  std::string_view id, what, target;
  std::size_t cases = 0;
  double value = 0, from = 0, to = 0;  // with its 95 % interval; meaningless without cases
  bool met = false;                    // by the value itself, whatever the interval
  bool is_share = false;               // printed in percent
  std::size_t hits = 0;                // number of cases that count, of a share
};

// 95 % interval of a share, after Wilson (1927).
struct Share {
  double value, from, to;
};
Share wilson(std::size_t hits, std::size_t cases);

struct Count {
  std::size_t hits = 0, cases = 0;
  void add(bool hit) {
    hits += hit ? 1 : 0;
    ++cases;
  }
};

// The target is met from `least` to `most`.
Figure share_figure(std::string_view id, std::string_view what, std::string_view target, const Count& count,
                    double least, double most);
// The mean of absolute differences; the target is met up to `most`.
Figure difference_figure(std::string_view id, std::string_view what, std::string_view target,
                         const std::vector<double>& differences, double most);
// The median with an interval by ranks, which holds for any distribution of the values.
Figure median_figure(std::string_view id, std::string_view what, std::string_view target, std::vector<double> values,
                     double least, double most);

}  // namespace kenaf::gap::challenge
