#include "gap/diagnose/diagnosis.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "gap/diagnose/channels.hpp"
#include "gap/diagnose/repeats.hpp"

namespace kenaf::gap {
namespace {

using Eigen::VectorXd;

// Models that a next manoeuvre is to tell apart, at most.
constexpr std::size_t kRivals = 4;
constexpr double kAtBound = 1e-3;  // of the range

std::vector<double> stated_noise(const runs::Dataset& dataset) {
  std::vector<double> stated;
  for (const Channel& channel : diagnosis_channels()) {
    const auto noise = dataset.noise.find(std::string(channel.column));
    stated.push_back(noise == dataset.noise.end() ? 0 : noise->second);
  }
  return stated;
}

class Diagnoser {
 public:
  Diagnoser(Diagnosis& d, const DiagnosisOptions& options)
      : d_(d),
        options_(options),
        predictor_(d.observations, d.features, d.repeats, options.jobs, options.stop, options.ranks,
                   [this](std::size_t roll_outs) { tell(roll_outs); }) {}

  void run() {
    begin({"simulating the nominal robot", 0, 0.01, 1});
    predictor_.simulate_nominal();
    d_.same_orders = same_orders_of(d_.observations);
    d_.nominal = predictor_.nominal();
    for (std::size_t r = 0; r < d_.features.size(); ++r)
      residuals_.push_back(d_.features[r].measured() - d_.nominal[r]);
    begin({"measuring the noise floor", 0.01, 0.1, 20});
    d_.nominal_floor = noise_floor(d_.features, residuals_, d_.same_orders, open_at(predictor_.unvaried()),
                                   stated_noise(d_.observations.dataset));
    d_.floor = d_.nominal_floor;
    deviations_ = deviations_from_repeats(d_.features, residuals_, d_.same_orders);
    coherence_.emplace(d_.features, d_.repeats, options_.stretch_s);
    d_.where = places(residuals_);
    d_.stages = stage_gaps(d_.features, d_.nominal_floor, *coherence_, residuals_,
                           predictor_.nominal_with_measured_drives(), d_.observations);

    begin({"comparing effects", 0.1, 0.5, 60});
    d_.curves = scan_effects(candidate_curves(d_.observations, options_.without), residuals_, d_.floor, predictor_);
    begin({"fitting effects", 0.5, 0.85, 60});
    d_.decision = decide(d_.curves, *coherence_, spread(), simulator(), options_.decision, options_.seed);
    begin({"holding runs out", 0.85, 0.93, 5});
    weigh();
    d_.isolability = isolability(d_.curves);
    begin({"looking for the next manoeuvre", 0.93, 1, 1});
    if (options_.propose_next && options_.ranks.rank == 0) propose();  // what only the report needs
    begin({"done", 1, 1, 1});
  }

  void finish() { d_.roll_outs = predictor_.roll_outs(); }
  std::string_view doing() const { return stage_.doing; }

 private:
  struct Stage {
    std::string_view doing;
    double from, to;           // shares of the whole time, of a usual diagnosis
    double roll_outs_per_run;  // of a usual one; how many there will be is not known before
  };

  void begin(const Stage& stage) {
    stage_ = stage;
    begun_at_ = predictor_.roll_outs();
    tell(begun_at_);
  }

  void tell(std::size_t roll_outs) const {
    if (!options_.progress) return;
    const double usual = stage_.roll_outs_per_run * static_cast<double>(d_.observations.runs.size());
    const double part = static_cast<double>(roll_outs - begun_at_) / usual;
    options_.progress({stage_.doing, stage_.to - (stage_.to - stage_.from) * std::exp(-part)});
  }

  std::vector<OpenShapes> open_at(const Variation& model) {
    return open_shapes(d_.features, predictor_, model, kOpenStart_m, kOpenStart_rad);
  }

  GapPlaces places(const std::vector<VectorXd>& residuals) const {
    return locate(d_.observations, d_.features, d_.nominal_floor, d_.repeats, *coherence_, residuals);
  }

  Simulator simulator() {
    return {[this](EffectCurves& curves, std::span<const NewPoint> points, Fidelity fidelity) {
              add_points(curves, points, fidelity, predictor_);
            },
            [this](std::span<const std::vector<NewPoint>> asked, Fidelity fidelity) {
              std::vector<Variation> variations;
              for (const std::vector<NewPoint>& effects : asked)
                variations.push_back(varied(d_.curves, effects, predictor_));
              return predictor_.shifts(variations, fidelity);
            },
            [this](std::span<const NewPoint> effects) {
              d_.floor = with_open_shapes(d_.nominal_floor, open_at(varied(d_.curves, effects, predictor_)));
              return d_.floor.whiteners;
            },
            [this] { return d_.floor.numerics; },
            [this](const Shift& shift) { return std::pow(repeats_rms(shift), 2) * bins(); }};
  }

  Spread spread() const {
    return {inflation_from_repeats(d_.features, d_.floor, deviations_, options_.stretch_s),
            std::pow(rms_of_repeats(d_.floor, d_.features, deviations_, d_.same_orders), 2) * bins()};
  }

  double bins() const {
    double bins = 0;
    for (const VectorXd& run : residuals_) bins += static_cast<double>(run.size());
    return bins;
  }

  double floor_rms() const { return repeats_rms(d_.decision.best.shift); }
  // Around a model: where the nominal robot falls in one repeat and not in the other, the real one need not.
  double repeats_rms(const Shift& shift) const {
    std::vector<VectorXd> left = residuals_;
    for (std::size_t r = 0; r < left.size(); ++r) left[r] -= shift[r];
    return rms_of_repeats(d_.floor, d_.features, deviations_from_repeats(d_.features, left, d_.same_orders),
                          d_.same_orders);
  }

  double p_of_chance(double explained) const {
    const double beyond = std::sqrt(std::max(0.0, explained / d_.decision.inflation / 2));
    return std::min(1.0, std::erfc(beyond) * static_cast<double>(d_.curves.curves.size()));
  }

  // `explained`: squared length by which it leaves less than the model without it.
  EffectEvidence evidence(const OnCurve& place, const Interval& value, double explained, const Interval& shrink) const {
    const physics::EffectParameter& parameter = *d_.curves.curves[place.curve].parameter;
    const double same = kAtBound * (parameter.max - parameter.min);
    // the neutral end is where an effect is not there: nothing lies beyond
    const auto at = [&](double end) { return end != parameter.neutral && std::abs(place.value - end) < same; };
    const double gap = squared_length(d_.curves.gap);
    return {place.curve,
            value,
            gap > 0 ? explained / gap : 0,
            shrink,
            p_of_chance(explained),
            at(parameter.min) || at(parameter.max)};
  }

  void weigh() {
    const bool stands = !d_.decision.beside.empty(), alone = d_.decision.best.places.size() == 1;
    if (stands && alone) std::swap(d_.curves.curves, d_.decision.beside);
    rank_singles();
    if (d_.decision.best.places.empty()) {
      d_.gap.shrink = {0, 0, 0};
      d_.gap.before = d_.gap.after = d_.floor.rms(residuals_);
      d_.gap.floor = std::min(floor_rms(), d_.gap.before);
      d_.gap.before_si = d_.gap.after_si = rms_si(residuals_);
      d_.where_left = d_.where;
      return;
    }
    if (stands && !alone) std::swap(d_.curves.curves, d_.decision.beside);
    weigh_best();
    if (stands) std::swap(d_.curves.curves, d_.decision.beside);
  }

  void rank_singles() {
    const Folds by_repeat = folds_by_repeat(d_.repeats);
    const double nominal_left = squared_length(d_.curves.gap), floor = floor_rms();
    for (const Model& model : d_.decision.singles) {
      if (d_.curves.curves[model.places[0].curve].visible < 1) continue;
      const auto shift = [&](const auto& places_of_run) { return by_curves(d_.curves, model, places_of_run); };
      const HeldOut held = hold_out(d_.curves, d_.floor, model, by_repeat, floor, options_.seed, shift);
      d_.ranking.push_back(evidence(model.places[0], intervals(model).front(), nominal_left - model.left, held.shrink));
    }
    std::ranges::stable_sort(d_.ranking, std::ranges::greater{},
                             [](const EffectEvidence& e) { return e.heldout_shrink.value; });
  }

  void weigh_best() {
    const Model& best = d_.decision.best;
    const Folds by_manoeuvre = folds_by_manoeuvre(d_.observations);
    const double floor = floor_rms();
    const HeldOut held = hold_out(d_.curves, d_.floor, best, folds_by_repeat(d_.repeats), floor, options_.seed,
                                  [this](const std::vector<std::vector<OnCurve>>& places_of_run) {
                                    std::vector<Variation> variations;
                                    for (const std::vector<OnCurve>& places : places_of_run)
                                      variations.push_back(varied(d_.curves, values_of(places), predictor_));
                                    return predictor_.shift_of_each(variations);
                                  });
    d_.gap.before = held.before;
    d_.gap.after = held.after;
    d_.gap.floor = held.floor;
    d_.gap.shrink = held.shrink;
    d_.gap.before_si = rms_si(residuals_);
    d_.gap.after_si = rms_si(held.left);
    if (by_manoeuvre.size() > 1)
      d_.gap.shrink_by_manoeuvre =
          hold_out(d_.curves, d_.floor, best, by_manoeuvre, floor, options_.seed, [&](const auto& places_of_run) {
            return by_curves(d_.curves, best, places_of_run);
          }).shrink;
    if (!is_borne_out(held)) doubt(Doubt::not_held_out);
    if (d_.floor.from_repeats && !is_within_repeats(held, options_.decision.model_share)) doubt(Doubt::beyond_repeats);
    d_.where_left = places(held.left);
    const std::vector<Interval> values = intervals(best);
    for (std::size_t i = 0; i < best.places.size(); ++i) {
      const double without = best.places.size() == 1 ? squared_length(d_.curves.gap) : left_without(d_.curves, best, i);
      d_.best.push_back(evidence(best.places[i], values[i], without - best.left, held.shrink));
    }
  }

  std::vector<Interval> intervals(const Model& model) const {
    return value_intervals(d_.curves, model, d_.floor.numerics, options_.decision.model_share, d_.decision.inflation,
                           options_.seed);
  }

  void doubt(Doubt why) {
    d_.decision.doubts.push_back(why);
    d_.decision.verdict = Verdict::unknown;
  }

  std::vector<double> rms_si(const std::vector<VectorXd>& differences) const {
    std::vector<double> squares(diagnosis_channels().size(), 0), bins(squares.size(), 0);
    for (std::size_t r = 0; r < differences.size(); ++r)
      for (std::size_t b = 0; b < d_.features[r].bins().size(); ++b) {
        const double value = differences[r][static_cast<Eigen::Index>(b)];
        squares[d_.features[r].bins()[b].channel] += value * value;
        ++bins[d_.features[r].bins()[b].channel];
      }
    for (std::size_t c = 0; c < squares.size(); ++c)
      squares[c] = bins[c] > 0 ? std::sqrt(squares[c] / bins[c]) : std::numeric_limits<double>::quiet_NaN();
    return squares;
  }

  // Where the verdict leaves a choice, the models between which it is. Nothing of the verdict depends on it.
  void propose() try {
    const Decision& decision = d_.decision;
    std::vector<Model> rivals;
    if (decision.verdict == Verdict::ambiguous) {
      const bool alone = decision.best.places.size() == 1;
      for (const Model& model : alone ? decision.singles : decision.together) {
        const bool is_rival = std::ranges::all_of(model.places, [&](const OnCurve& place) {
          return std::ranges::any_of(decision.rivals, [&](const std::vector<std::size_t>& set) {
            return std::ranges::count(set, place.curve) > 0;
          });
        });
        if (is_rival && rivals.size() < kRivals) rivals.push_back(model);
      }
    } else if (decision.verdict == Verdict::unknown) {
      rivals.assign(decision.singles.begin(),
                    decision.singles.begin() + std::min(std::ssize(decision.singles), std::ptrdiff_t{kRivals}));
    }
    d_.next = rank_manoeuvres(d_.observations.robot, d_.curves, rivals, d_.floor, options_.span_s, options_.jobs,
                              options_.stop);
  } catch (const Stopped&) {
    d_.next_interrupted = true;
    d_.observations.warnings.emplace_back("interrupted while looking for the next manoeuvre, which is not told");
  }

  Diagnosis& d_;
  const DiagnosisOptions& options_;
  Predictor predictor_;
  std::vector<VectorXd> residuals_, deviations_;
  std::optional<Coherence> coherence_;
  Stage stage_{"reading the runs", 0, 0, 1};
  std::size_t begun_at_ = 0;  // roll-outs
};

void check_names(const std::vector<std::string>& without) {
  for (const std::string& name : without)
    if (physics::find_effect(name) == nullptr)
      throw std::invalid_argument(fmt::format("--without {}: no such effect; `kenaf-gap effects` lists them", name));
}

}  // namespace

Diagnosis diagnose(const std::filesystem::path& folder, const DiagnosisOptions& options) {
  check_names(options.without);
  Diagnosis d;
  d.options = options;
  d.options.progress = {};
  d.options.stop = nullptr;
  d.observations = observe(folder, options.robot, options.world, options.most_runs);
  for (const Observation& run : d.observations.runs)
    d.features.emplace_back(run.run, options.span_s, d.observations.not_simulated);
  if (std::ranges::all_of(d.features, [](const FeatureMap& map) { return map.bins().empty(); }))
    throw runs::RunFileError(
        fmt::format("{}: nothing that was measured can be compared: the described robot has no sensor for any of it",
                    folder.string()));
  d.repeats = repeats_of(d.observations);
  if (candidate_curves(d.observations, options.without).empty())
    throw std::invalid_argument("--without leaves no effect to look for");
  Diagnoser diagnoser(d, options);
  d.decision.verdict = Verdict::unknown;  // until it is known
  d.decision.p_gap = d.decision.p_left = d.decision.p_agree = GapMeasure::kNotMeasured;
  try {
    diagnoser.run();
  } catch (const Stopped&) {
    d.interrupted = diagnoser.doing();
    d.decision.verdict = Verdict::unknown;  // what is decided by then may still be doubted
  }
  diagnoser.finish();
  return d;
}

physics::Effects corrected_effects(const Diagnosis& d) {
  physics::Effects effects = d.observations.robot.effects;
  for (const OnCurve& place : d.decision.best.places)
    effects.*d.curves.curves[place.curve].parameter->value = place.value;
  return effects;
}

std::string group_title(const Diagnosis& d, std::size_t group) {
  const auto first = [&](std::size_t g) -> const Observation& { return d.observations.runs[d.repeats[g].front()]; };
  const Observation& run = first(group);
  if (run.manoeuvre.empty()) return run.file;
  for (std::size_t g = 0; g < d.repeats.size(); ++g)
    if (g != group && first(g).manoeuvre == run.manoeuvre) return fmt::format("{} ({})", run.manoeuvre, run.file);
  return run.manoeuvre;
}

}  // namespace kenaf::gap
