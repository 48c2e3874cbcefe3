// What the simulator has said already: two stages are compared in one replay, models share what is open around them,
// and two fits may ask for one point. Nothing of that is simulated twice.
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

// What a run is driven with again.
enum class Replay { commands, belts };

struct RollOut {
  Replay replay;
  std::size_t run;
  std::size_t variation;  // its number
  auto operator<=>(const RollOut&) const = default;
};

using StageValues = std::array<Eigen::VectorXd, kPassages.size()>;  // of the stages that are compared in the replay

class KnownRollOuts {
 public:
  // The same for the same variation, until forget().
  std::size_t number_of(const Variation& variation);
  const Variation& variation(std::size_t number) const { return variations_[number]; }

  // Null: not known.
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
