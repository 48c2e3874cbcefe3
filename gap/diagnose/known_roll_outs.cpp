#include "gap/diagnose/known_roll_outs.hpp"

#include <algorithm>
#include <utility>

namespace kenaf::gap::diagnose {

std::size_t KnownRollOuts::number_of(const Variation& variation) {
  const auto place = std::ranges::find(variations_, variation);
  const auto number = static_cast<std::size_t>(place - variations_.begin());
  if (place == variations_.end()) variations_.push_back(variation);
  return number;
}

const StageValues* KnownRollOuts::find(const RollOut& roll_out) const {
  const auto place = values_.find(roll_out);
  return place == values_.end() ? nullptr : &place->second;
}

void KnownRollOuts::add(const RollOut& roll_out, StageValues values) {
  for (const Eigen::VectorXd& of_stage : values) bytes_ += static_cast<std::size_t>(of_stage.size()) * sizeof(double);
  values_.emplace(roll_out, std::move(values));
}

void KnownRollOuts::forget() {
  *this = {};
}

}  // namespace kenaf::gap::diagnose
