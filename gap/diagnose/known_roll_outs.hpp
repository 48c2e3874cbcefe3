// Cache of roll-outs, so that nothing is simulated twice: two stages share a replay, models share their open shapes,
// and two fits may request the same point.
//
// Thread safety: a value.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <map>
#include <tuple>
#include <vector>

#include "gap/diagnose/stage_features.hpp"
#include "gap/diagnose/variation.hpp"

namespace kenaf::gap::diagnose {

// The source of motion of the simulated robot.
enum class Replay { commands, belts };

struct RollOut {
  Replay replay;
  std::size_t run;
  std::size_t variation;  // its number, of number_of()
  auto operator<=>(const RollOut&) const = default;
};

using StageValues = std::array<Eigen::VectorXd, kPassages.size()>;  // for the stages compared in the replay

class KnownRollOuts {
 public:
  // Equal variations have equal numbers, until forget().
  std::size_t number_of(const Variation& variation);
  const Variation& variation(std::size_t number) const { return variations_[number]; }

  // Null if unknown.
  const StageValues* find(const RollOut& roll_out) const;
  void add(const RollOut& roll_out, StageValues values);

  std::size_t bytes() const { return bytes_; }
  void forget();

 private:
  std::vector<Variation> variations_;
  std::map<RollOut, StageValues> values_;
  std::size_t bytes_ = 0;
};

}  // namespace kenaf::gap::diagnose
