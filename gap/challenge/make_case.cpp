#include "gap/challenge/make_case.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <tuple>
#include <utility>

#include "gap/challenge/case_runs.hpp"
#include "gap/challenge/case_scale.hpp"
#include "gap/challenge/stand_ins.hpp"
#include "gap/challenge/true_shares.hpp"
#include "gap/diagnose/isolability.hpp"
#include "gap/random_numbers.hpp"

namespace kenaf::gap::challenge {
namespace {

namespace fs = std::filesystem;

double present_value(const std::string& key) {
  return std::ranges::find(challenged_numbers(), key, &candidates::Candidate::name)->present;
}

constexpr int kTries = 14;
constexpr double kNarrow = 1.5;  // ratio of a bracket's ends below which a power law is trusted
constexpr double kSmallestShare = 1e-5, kCloseEnough = 1.05;
constexpr double kSmallestPlay = 0.01;  // 3 mrad of backlash: below, only the give of the teeth remains
constexpr double kCloseToPlanned = 0.9;
// A size that is nearly the same at a quarter of the value is not the effect's, but that of a run which any change
// sends another way.
constexpr double kQuarter = 0.25, kNearlyTheSame = 0.75;
// Nor is one that jumps at so small a share of the range.
constexpr double kHardlyAnything = 0.01, kJump = 2;

// Searches the share of the way at which `size_at` is `wanted`, or up to kCloseEnough times that, and returns it with
// the size there; the whole way if the size is not reached, and 0 for a size that is not the effect's. Works with
// ratios, since a thousandth of an effect's range may be visible.
template <class SizeAt>
std::pair<double, double> share_for(double wanted, double smallest_share, SizeAt&& size_at) {
  const double most = size_at(1);
  if (!(most > wanted)) return {1, most};
  double below = smallest_share, above = 1, size = most, size_below = 0;
  for (int i = 0; i < kTries && size > kCloseEnough * wanted; ++i) {
    // Interpolates size = c share^p between the ends of the bracket: p = ln(size / size_below) / ln(above / below), if
    // that leads inside; alternates with geometric halving, for sizes that jump.
    const double aim = std::sqrt(kCloseEnough) * wanted;
    const double power = size_below > 0 ? std::log(size / size_below) / std::log(above / below) : 1;
    const double by_power = above * std::pow(aim / size, 1 / power);
    const bool halves = i % 2 != 0 && above / below > kNarrow;
    const double next = !halves && by_power > below && by_power < above ? by_power : std::sqrt(below * above);
    const double at_next = size_at(next);
    if (at_next < wanted)
      below = next, size_below = at_next;
    else
      above = next, size = at_next;
  }
  const bool grows = kQuarter * above < smallest_share || size_at(kQuarter * above) < kNearlyTheSame * size;
  const bool jumps = above < kHardlyAnything && above < kNarrow * below && size > kJump * size_below;
  return {above, grows && !jumps ? size : 0};
}

struct Sized {
  double of_planned = -1;  // reached size / planned size
  double value = 0;
};

// Searches the value with the planned size. If it cannot be reached on one side of neutral, tries the other.
template <class FurthestAt, class SizeAt>
Sized sized(double planned, double neutral, double smallest_share, bool upward_first, FurthestAt&& furthest_at,
            SizeAt&& size_at) {
  Sized best{-1, neutral};
  for (const bool upward : {upward_first, !upward_first}) {
    const double furthest = furthest_at(upward);
    if (furthest == neutral || best.of_planned >= kCloseToPlanned) continue;
    const auto value_at = [&](double share) { return neutral + share * (furthest - neutral); };
    const auto [share, size] = share_for(planned, smallest_share, [&](double part) { return size_at(value_at(part)); });
    if (size / planned > best.of_planned) best = {size / planned, value_at(share)};
  }
  return best;
}

double planned_size(const CasePlan& plan, const HiddenEffect& hidden) {
  return plan.is_sized_by_background() ? hidden.times_background : hidden.floors;
}

// Sets value and size of an effect; returns reached size / planned size.
double size_effect(const CasePlan& plan, HiddenEffect& hidden, CaseScale& scale, bool upward_first) {
  const physics::EffectParameter& parameter = parameter_of(hidden);
  const double planned = planned_size(plan, hidden);
  const auto size_at = [&](double value) {
    physics::Effects effects;
    effects.*parameter.value = value;
    return scale.size_of(effects);
  };
  const Sized result = sized(
      planned, parameter.neutral,
      parameter.value == &physics::Effects::flipper_backlash_rad ? kSmallestPlay : kSmallestShare, upward_first,
      [&](bool upward) { return furthest_value(plan, parameter, upward); },
      [&](double value) { return size_at(value).planned_as(plan); });
  hidden.value = result.value;
  const Size size = size_at(result.value);
  hidden.floors = size.floors;
  hidden.times_background = size.times_background;
  return result.of_planned;
}

// Sets the size of each effect to what it adds beside the others, which may hide it: drives that follow a ramp never
// reach their largest force. Returns the least reached size / planned size.
double size_beside_others(const CasePlan& planned, CasePlan& plan, CaseScale& scale) {
  double reached = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < plan.effects.size(); ++i) {
    HiddenEffect& hidden = plan.effects[i];
    physics::Effects effects, others;
    for (const HiddenEffect& each : plan.effects) {
      effects.*parameter_of(each).value = each.value;
      if (&each != &hidden) others.*parameter_of(each).value = each.value;
    }
    const Size size = scale.size_beside(others, effects);
    hidden.floors = size.floors;
    hidden.times_background = size.times_background;
    reached = std::min(reached, size.planned_as(plan) / planned_size(planned, planned.effects[i]));
  }
  return reached;
}

// Sets value and size of the hidden number of the description; returns reached size / planned size.
double size_number(CasePlan& plan, CaseScale& scale, bool upward_first) {
  HiddenNumber& number = plan.number;
  const auto size_at = [&](double value) { return scale.size_of_number(number.key, value); };
  const Sized result = sized(
      number.times_background, present_value(number.key), kSmallestShare, upward_first,
      [&](bool upward) { return furthest_value_of_number(plan, upward); },
      [&](double value) { return size_at(value).times_background; });
  number.value = result.value;
  const Size size = size_at(result.value);
  number.floors = size.floors;
  number.times_background = size.times_background;
  return result.of_planned;
}

// Likewise for the foreign deviation, whose amount goes from 0 to 1.
double size_foreign(CasePlan& plan, CaseScale& scale) {
  const double planned = plan.is_sized_by_background() ? plan.foreign_times_background : plan.foreign_floors;
  const auto [amount, size] = share_for(
      planned, kSmallestShare, [&](double part) { return scale.size_of_foreign(plan.foreign, part).planned_as(plan); });
  const Size at_amount = scale.size_of_foreign(plan.foreign, amount);
  plan.foreign_amount = amount;
  plan.foreign_floors = at_amount.floors;
  plan.foreign_times_background = at_amount.times_background;
  return size / planned;
}

}  // namespace

void make_case(CasePlan& plan, const fs::path& folder, unsigned jobs, const std::atomic<bool>* stop) {
  Random random(mixed(plan.seed, 1));
  const bool upward = (random() & 1) != 0;

  // Tries manoeuvres until the planned size is reached and, outside the catalogue, nothing in it looks alike; keeps the
  // best.
  CasePlan best = plan;
  double best_size = -1;
  for (CaseRuns& runs : runs_to_choose_from(plan)) {
    if (plan.stratum == Stratum::none && !plan.is_imperfect()) break;
    if (std::ranges::count(runs.manoeuvres, plan.unseen) > 0) continue;
    // The size of whatever is hidden, in these manoeuvres; of two effects the one that falls short more counts.
    CasePlan candidate = plan;
    candidate.manoeuvres = std::move(runs.manoeuvres);
    candidate.longest_s = std::move(runs.longest_s);
    CaseScale scale(candidate, jobs, stop);
    candidate.background.floors = scale.background_floors();
    double reached = 1e9;
    for (HiddenEffect& hidden : candidate.effects)
      reached = std::min(reached, size_effect(candidate, hidden, scale, upward));
    if (candidate.effects.size() > 1) reached = std::min(reached, size_beside_others(plan, candidate, scale));
    if (!plan.number.key.empty()) reached = size_number(candidate, scale, upward);
    if (!plan.foreign.empty()) reached = size_foreign(candidate, scale);

    // Larger is better, up to nearly the planned size; then less alike.
    const double size = std::min(reached, kCloseToPlanned);
    if (size < best_size) continue;
    if (is_outside(plan.stratum)) candidate.look_alike = scale.look_alike_of(candidate);
    if (size == best_size && !(candidate.look_alike.angle_deg > best.look_alike.angle_deg)) continue;
    best_size = size;
    best = std::move(candidate);
    if (size == kCloseToPlanned &&
        (!is_outside(plan.stratum) || best.look_alike.angle_deg >= diagnose::kDistinguishable_deg))
      break;
  }

  plan = best;
  make_again(plan, folder, jobs, stop);
  // No shares of what the diagnosis cannot name; since a baseline the background is no part of the gap.
  const bool has_shares = plan.stratum == Stratum::single || plan.stratum == Stratum::pair;
  if (plan.is_imperfect() && has_shares) set_true_shares(plan, folder, jobs, stop);
}

void make_again(const CasePlan& plan, const fs::path& folder, unsigned jobs, const std::atomic<bool>* stop) {
  write_case_runs(plan, hidden_robot(plan), {plan.manoeuvres, plan.longest_s, plan.repeats, mixed(plan.seed, 2)},
                  folder, jobs, stop);
  if (plan.stratum == Stratum::baseline)
    write_case_runs(plan, robot_before(plan), {plan.manoeuvres, plan.longest_s, plan.repeats, mixed(plan.seed, 6)},
                    folder / kBeforeFolder, jobs, stop);
}

void make_unseen(const CasePlan& plan, const fs::path& folder, unsigned jobs) {
  write_case_runs(plan, hidden_robot(plan), {{plan.unseen}, {}, 2, mixed(plan.seed, 3)}, folder, jobs, nullptr);
}

}  // namespace kenaf::gap::challenge
