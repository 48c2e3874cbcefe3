#include "gap/diagnose/diagnosis.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>
#include <stdexcept>
#include <utility>

#include "formats/settings/nearest_word.hpp"
#include "gap/candidates/own_effects.hpp"
#include "gap/diagnose/baseline.hpp"
#include "gap/diagnose/channels.hpp"
#include "gap/diagnose/other_stages.hpp"
#include "gap/diagnose/repeats.hpp"
#include "gap/diagnose/stage_candidates.hpp"

namespace kenaf::gap::diagnose {
namespace {

std::vector<double> stated_noise(const runs::Dataset& dataset) {
  std::vector<double> stated;
  for (const Channel& channel : diagnosis_channels()) {
    const auto noise = dataset.noise.find(std::string(channel.column));
    stated.push_back(noise == dataset.noise.end() ? 0 : noise->second);
  }
  return stated;
}

// The names that --without knows: the catalogue's, and those of candidates that only this robot or the user has.
void check_is_effect(const std::string& name, const std::vector<candidates::Candidate>& all, const std::string& robot) {
  std::vector<std::string> names;
  for (const physics::EffectInfo& effect : physics::effect_catalogue()) names.emplace_back(effect.name);
  for (const candidates::Candidate& candidate : all) names.push_back(candidate.effect);
  if (std::ranges::find(names, name) != names.end()) return;
  const std::string_view nearest = settings::nearest_word(name, names);
  throw std::invalid_argument(fmt::format("--without {}: no such effect; {}", settings::shown(name),
                                          nearest.empty()
                                              ? fmt::format("`kenaf-gap effects --robot {}` lists them", robot)
                                              : fmt::format("did you mean {}?", nearest)));
}

// Catalogue, numbers of the description and user-defined effects, without those left out; of equivalent candidates the
// first.
std::vector<candidates::Candidate> candidates_for(const Observations& observations, const DiagnosisOptions& options) {
  const physics::RobotDescription& robot = observations.robot;
  std::vector<candidates::Candidate> all = candidates::all_candidates(robot, has_obstacles(observations));
  if (!options.effects.empty())
    std::ranges::move(candidates::read_own_effects(options.effects, robot), std::back_inserter(all));
  std::vector<std::string> left_out = options.without;
  for (const std::string& name : options.without) {
    check_is_effect(name, all, robot.name);
    for (const candidates::Candidate& c : all)
      if (c.effect == name && !c.same_as.empty()) left_out.push_back(c.same_as);
  }
  std::vector<candidates::Candidate> result = candidates::leave_out(std::move(all), left_out);
  if (result.empty()) throw std::invalid_argument("--without leaves no effect to search for");
  return result;
}

// Reports progress: a stage's share of the time is known beforehand, its number of roll-outs is not.
class ProgressReport {
 public:
  explicit ProgressReport(const std::function<void(const Progress&)>& tell) : tell_(tell) {}

  void begin(std::string_view doing, double from, double to, double usual_roll_outs, std::size_t roll_outs) {
    doing_ = doing, from_ = from, to_ = to, usual_ = usual_roll_outs, begun_at_ = roll_outs;
    update(roll_outs);
  }
  void update(std::size_t roll_outs) const {
    if (tell_) tell_({doing_, to_ - (to_ - from_) * std::exp(-static_cast<double>(roll_outs - begun_at_) / usual_)});
  }
  std::string_view doing() const { return doing_; }

 private:
  const std::function<void(const Progress&)>& tell_;
  std::string_view doing_ = "reading the runs";
  double from_ = 0, to_ = 0, usual_ = 1;
  std::size_t begun_at_ = 0;
};

void conclude(Diagnosis& d) {
  d.verdict = whole_verdict(d.stages);
  d.complete = !d.stages.empty() && std::ranges::all_of(d.stages, [](const StageDiagnosis& stage) {
    return stage.decision.verdict == Verdict::none || stage.decision.complete;
  });
  for (std::size_t s = 0; s < d.stages.size(); ++s)
    if (d.stages[s].decision.verdict != Verdict::none &&
        (!d.largest_stage || squared_gap(d.stages[s]) > squared_gap(d.stages[*d.largest_stage])))
      d.largest_stage = s;
}

// The robot with `settings`, and with each of their values moved a tenth of the way back to nominal.
RivalModel rival_model(const Diagnosis& d, const Settings& settings) {
  constexpr double kMoved = 0.1;
  RivalModel rival{with_settings(d.observations.robot, d.candidates, settings), {}};
  for (std::size_t i = 0; i < settings.size(); ++i) {
    Settings moved = settings;
    moved[i].value += kMoved * (d.candidates[moved[i].candidate].present - moved[i].value);
    rival.moved.push_back(with_settings(d.observations.robot, d.candidates, moved));
  }
  return rival;
}

// A model that a stage leaves open, and the candidate by which it differs from the others.
struct OpenModel {
  Settings settings;
  std::size_t candidate;
};

// Models with each rival of the effect that has most of them; if there are sets alone, those without each member of the
// largest set; the best single effects if nothing is named.
std::vector<OpenModel> open_models(const StageDiagnosis& stage) {
  constexpr std::size_t kMostRivals = 4;
  std::vector<OpenModel> models;
  const StageDecision& decision = stage.decision;
  if (decision.verdict == Verdict::ambiguous) {
    const auto most_of = [&](auto&& count_of) {
      std::size_t most = 0, place = 0;
      for (std::size_t e = 0; e < decision.effects.size(); ++e)
        if (const std::size_t count = decision.effects[e].doubts.empty() ? count_of(e) : 0; count > most)
          most = count, place = e;
      return std::pair{most, place};
    };
    const auto [rivals, place] = most_of([&](std::size_t e) { return decision.models_of_rivals[e].size(); });
    const auto [partners, member] = most_of([&](std::size_t e) { return decision.effects[e].partners.size(); });
    if (rivals > 1) {
      for (const Settings& settings : decision.models_of_rivals[place])
        models.push_back({settings, settings[place].candidate});
    } else if (partners > 0) {
      std::vector<std::size_t> set = decision.effects[member].partners;
      set.push_back(member);
      std::ranges::sort(set);
      for (const std::size_t without : set)
        models.push_back({settings_of(values_without(decision.data, decision.best, {&without, 1}).places),
                          decision.effects[without].candidate});
    }
  } else if (decision.verdict == Verdict::unknown) {
    for (const Model& single : decision.singles)
      models.push_back({settings_of(single.places), single.places.front().curve});
  }
  if (models.size() > kMostRivals) models.resize(kMostRivals);
  return models;
}

// `stop`: once true, proposes nothing.
void propose_next(Diagnosis& d, const std::atomic<bool>* stop) {
  // the stage with the largest gap among those that leave a choice
  const StageDiagnosis* open = nullptr;
  for (const StageDiagnosis& stage : d.stages) {
    const Verdict verdict = stage.decision.verdict;
    if (verdict != Verdict::ambiguous && verdict != Verdict::unknown) continue;
    if (open == nullptr || squared_gap(stage) > squared_gap(*open)) open = &stage;
  }
  if (open == nullptr) return;
  std::vector<RivalModel> rivals;
  std::vector<std::size_t> candidates;
  for (const OpenModel& model : open_models(*open)) {
    rivals.push_back(rival_model(d, model.settings));
    candidates.push_back(model.candidate);
  }
  if (rivals.size() < 2) return;

  // the discrepancy counts as noise of a bin, added in squares to that of its channel
  ProposalOptions options{std::vector<double>(diagnosis_channels().size(), 0), d.options.span_s};
  for (const StageDiagnosis& stage : d.stages)
    for (std::size_t c = 0; c < options.sigma_of_channel.size(); ++c)
      if (stage.passage != Passage::body_to_sensor && stage.nominal_floor.sigma[c] > 0)
        options.sigma_of_channel[c] = std::hypot(
            stage.nominal_floor.sigma[c], stage.decision.best.model.likelihood.discrepancies.of_kind[kind_of(c)].sigma);
  options.threads = d.options.jobs;
  options.stop = stop;
  try {
    d.next = propose_manoeuvres(d.observations.robot, rivals, options);
    d.to_separate = std::move(candidates);
  } catch (const Stopped&) {
    // the diagnosis itself is finished
  }
}

// Simulates the baseline's runs and subtracts their residuals.
void take_off(const Baseline& baseline, Diagnosis& d, const DiagnosisOptions& options) {
  const ComparedFeatures before = compared_features(baseline.observations, options.span_s);
  Predictor predictor(baseline.observations, before, repeats_of(baseline.observations), options.jobs, options.stop,
                      options.ranks);
  predictor.simulate_nominal();
  std::array<std::vector<Eigen::VectorXd>, kPassages.size()> residuals;
  for (const Passage passage : kPassages)
    for (std::size_t r = 0; r < baseline.observations.runs.size(); ++r)
      residuals[static_cast<std::size_t>(passage)].push_back(before.of(passage)[r].measured -
                                                             predictor.nominal(passage)[r]);
  compare_against(d.features, baseline, before, residuals);
  d.baseline_runs = baseline.observations.runs.size();
}

}  // namespace

double squared_gap(const StageDiagnosis& stage) {
  const double gap = std::max(0.0, stage.gap.before * stage.gap.before - stage.gap.floor * stage.gap.floor);
  return gap * static_cast<double>(bin_count(stage.decision.data));
}

Verdict whole_verdict(const std::vector<StageDiagnosis>& stages) {
  const auto any = [&](Verdict verdict) {
    return std::ranges::any_of(stages, [&](const StageDiagnosis& stage) { return stage.decision.verdict == verdict; });
  };
  if (any(Verdict::ambiguous)) return Verdict::ambiguous;
  if (any(Verdict::named)) return Verdict::named;
  return any(Verdict::unknown) || stages.empty() ? Verdict::unknown : Verdict::none;
}

Diagnosis diagnose_dataset(const std::filesystem::path& folder, const DiagnosisOptions& options) {
  Diagnosis d;
  d.options = options;
  d.options.progress = {};
  d.options.stop = nullptr;
  d.folder = folder.string();

  // what is compared: runs, candidates, features, and which runs repeat each other
  d.observations = observe(folder, options.robot, options.world, options.most_runs, options.refused_runs);
  std::optional<Baseline> baseline;
  if (!options.against.empty())
    baseline = observe_baseline(options.against, d.observations, options.world, options.refused_runs);
  d.candidates = candidates_for(d.observations, options);
  d.features = compared_features(d.observations, options.span_s);
  if (std::ranges::all_of(d.features.maps, [](const FeatureMap& map) { return map.bins().empty(); }))
    throw runs::RunFileError(
        fmt::format("{}: no measured column can be compared, because the described robot has no sensor for any of them",
                    folder.string()));
  d.repeats = repeats_of(d.observations);
  d.same_command_sequence = same_command_sequence_of(d.observations);

  // one simulator for all stages, so that stages which share a replay share its roll-outs
  ProgressReport progress(options.progress);
  Predictor predictor(d.observations, d.features, d.repeats, options.jobs, options.stop, options.ranks,
                      [&](std::size_t roll_outs) { progress.update(roll_outs); });
  const auto runs = static_cast<double>(d.observations.runs.size());
  StageOptions stage_options{options.decision, options.stretch_s, options.seed};
  stage_options.decision.search.threads = options.jobs;
  try {
    // the nominal robot first: every residual and every shift is relative to it
    progress.begin("simulating the nominal robot", 0, 0.02, 2 * runs, 0);
    if (baseline) take_off(*baseline, d, options);
    predictor.simulate_nominal();

    // each stage by itself; stages that no run measures are skipped
    std::vector<PreparedStage> prepared;
    for (const Passage passage : kPassages) {
      const auto number = static_cast<double>(passage);
      progress.begin(passage_name(passage), 0.02 + 0.32 * number, 0.34 + 0.32 * number, 100 * runs,
                     predictor.roll_outs());
      PreparedStage stage = prepare_stage({passage, &d.observations, &d.features.maps, &d.features.of(passage),
                                           &d.repeats, &d.same_command_sequence, stated_noise(d.observations.dataset)},
                                          d.candidates, predictor);
      if (stage.nominal.data.groups.empty()) continue;
      const Elsewhere elsewhere{{}, {}, numbers_off_elsewhere(d.stages, passage)};
      d.stages.push_back(diagnose_stage(stage, predictor, stage_options, elsewhere));
      prepared.push_back(std::move(stage));
    }

    // then all stages together: contradictions between them, the verdict, and what to drive next
    settle_by_other_stages(d.stages, prepared, predictor, stage_options);
    conclude(d);
    progress.begin("looking for the next manoeuvre", 0.98, 1, 1, predictor.roll_outs());
    if (options.propose_next && options.ranks.rank == 0) propose_next(d, options.stop);
    progress.begin("done", 1, 1, 1, predictor.roll_outs());
  } catch (const Stopped&) {
    // stopped: finished stages are kept, but there is no verdict
    d.interrupted = progress.doing();
    d.verdict = Verdict::unknown;
  }
  d.roll_outs = predictor.roll_outs();
  return d;
}

Settings corrections(const Diagnosis& d) {
  const bool is_named = d.verdict == Verdict::named || d.verdict == Verdict::ambiguous;
  // the interval narrowest relative to the change from the present value wins
  std::map<std::size_t, std::pair<double, double>> best;  // candidate: relative width, value
  for (const StageDiagnosis& stage : d.stages)
    for (const ModelEffect& effect : stage.decision.effects) {
      if (is_named && !effect.doubts.empty()) continue;
      const Interval& value = effect.value.value;
      const double width =
          (value.to - value.from) / std::max(1e-12, std::abs(value.value - d.candidates[effect.candidate].present));
      const auto [place, is_new] = best.try_emplace(effect.candidate, width, value.value);
      if (!is_new && width < place->second.first) place->second = {width, value.value};
    }
  Settings settings;
  for (const auto& [candidate, value] : best) settings.push_back({candidate, value.second});
  return settings;
}

std::string group_title(const Diagnosis& d, std::size_t group) {
  const auto first = [&](std::size_t g) -> const Observation& { return d.observations.runs[d.repeats[g].front()]; };
  const Observation& run = first(group);
  if (run.manoeuvre.empty()) return run.file;
  for (std::size_t g = 0; g < d.repeats.size(); ++g)
    if (g != group && first(g).manoeuvre == run.manoeuvre) return fmt::format("{} ({})", run.manoeuvre, run.file);
  return run.manoeuvre;
}

}  // namespace kenaf::gap::diagnose
