// A diagnosis made by hand, without any simulation: two manoeuvres, "drive" twice and one whose name needs escaping;
// the simulated robot is 0.1 m ahead in x, and its tracks are 0.05 m/s too fast.
#pragma once

#include <cmath>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "gap/diagnose/channels.hpp"
#include "gap/diagnose/page/overlays.hpp"
#include "physics/robot_description.hpp"

namespace kenaf::test {

inline constexpr double kMadeSigma = 0.01;
// Places in Diagnosis::candidates.
enum MadeCandidate : std::size_t { drive_lag, com_forward, ground_slope, track_separation };

inline std::size_t channel(std::string_view column) {
  for (std::size_t c = 0; c < gap::diagnose::diagnosis_channels().size(); ++c)
    if (gap::diagnose::diagnosis_channels()[c].column == column) return c;
  throw std::invalid_argument("no such channel");
}

// 2 s along x, climbing, with both tracks' speed.
inline runs::Run run_ahead_by(double ahead_m, double faster_mps = 0) {
  runs::Run run{{"t_s", "x_m", "y_m", "z_m", "track_left_mps", "track_right_mps"}, std::vector<std::vector<double>>(6)};
  for (int i = 0; i <= 20; ++i) {
    const double t_s = 0.1 * i,
                 row[] = {t_s, 0.5 * t_s + ahead_m, 0, 0.1 + 0.1 * t_s, 0.5 + faster_mps, 0.5 + faster_mps};
    for (std::size_t c = 0; c < 6; ++c) run.values[c].push_back(row[c]);
  }
  return run;
}

inline constexpr double kMadeModel = 0.85;  // share of its stage that the model of drives explains

inline gap::diagnose::ModelEffect made_effect(std::size_t candidate, gap::diagnose::Interval value, double share) {
  return {candidate,
          {value, 0, 1},
          400,
          {share, share, share, 0, share, 0, kMadeModel},
          {share - 0.01, share - 0.01, share - 0.01, 0, share, 0, kMadeModel},
          false,
          {},
          {candidate}};
}

inline gap::diagnose::Dependence made_dependence() {
  return {"yaw rate",
          "turn rate",
          0.84,
          -0.2,
          0,
          "yaw rate: measured 0.80 of the simulated, in every run",
          {"track.separation_m", "friction_across"},
          {{0.0, 0.1}, {1.0, -0.1}},
          "rad/s",
          "rad/s"};
}

// Measured minus simulated of every run, and all that follows from it; no verdict.
inline gap::diagnose::StageDiagnosis made_stage(const gap::diagnose::Diagnosis& d, gap::diagnose::Passage passage) {
  using namespace gap;
  using namespace gap::diagnose;
  using namespace gap::candidates;
  StageDiagnosis stage{};
  stage.passage = passage;
  stage.nominal_floor.from_repeats = true;
  stage.nominal_floor.sigma.assign(diagnosis_channels().size(), kMadeSigma);
  for (std::size_t r = 0; r < d.observations.runs.size(); ++r) {
    const FeatureMap& map = d.features.maps[r];
    const StageFeatures& features = d.features.of(passage)[r];
    stage.residuals.push_back(features.measured - map.of(run_ahead_by(0.1, 0.05))(features.rows));
    const Eigen::VectorXd sigma = Eigen::VectorXd::Constant(features.measured.size(), kMadeSigma);
    stage.nominal_floor.sigma_of_bin.push_back(sigma);
    stage.nominal_floor.whiteners.emplace_back(sigma, Eigen::MatrixXd::Zero(sigma.size(), 1));
  }
  stage.left = stage.residuals;
  stage.decision.floor = stage.nominal_floor;
  stage.decision.data.groups.resize(1);
  stage.decision.data.groups[0].bins.resize(100);
  stage.decision.p_gap = 1e-9;
  stage.decision.p_left = 1e-5;
  stage.before_si.assign(diagnosis_channels().size(), std::nan(""));
  stage.after_si = stage.before_si;
  return stage;
}

// From command to drive drive_lag is named and explains 85 %; from drive to body com_forward is in the best model,
// which gets no name, and half is left.
inline gap::diagnose::Diagnosis made_diagnosis() {
  using namespace gap;
  using namespace gap::diagnose;
  using namespace gap::candidates;
  Diagnosis d;
  d.options.seed = 4711;
  d.observations.robot_name = "kenaf";
  d.observations.robot = physics::load_robot("kenaf");
  d.observations.dataset.description = "Logs of <Monday> & Tuesday";
  d.observations.warnings = {"run-007.csv: \"late\" <clock>"};
  d.repeats = {{0, 1}, {2}};
  for (const auto& [file, manoeuvre] :
       {std::pair{"run-000.csv", "drive"}, {"run-001.csv", "drive"}, {"run-002.csv", "up & <over>"}})
    d.observations.runs.push_back({.file = file,
                                   .manoeuvre = manoeuvre,
                                   .world = 0,
                                   .run = run_ahead_by(0),
                                   .replay = {},
                                   .measured = {},
                                   .resting_rows = 0});
  d.features = compared_features(d.observations, d.options.span_s);
  const auto add = [&](std::vector<Candidate> from, std::string_view name) {
    for (Candidate& candidate : from)
      if (candidate.name == name) d.candidates.push_back(std::move(candidate));
  };
  for (const char* name : {"drive_lag", "com_forward", "ground_slope"})
    add(catalogue_candidates(d.observations.robot, true), name);
  add(description_candidates(d.observations.robot), "track.separation_m");
  if (d.candidates.size() != 4) throw std::logic_error("a candidate of the made diagnosis is gone");

  StageDiagnosis drive = made_stage(d, Passage::command_to_drive);
  drive.decision.verdict = Verdict::named;
  drive.decision.best.model.places = {{drive_lag, 0.0513}};
  drive.decision.effects = {made_effect(drive_lag, {0.0513, 0.0498, 0.0528}, 0.84)};
  drive.gap = {8.25, 1.5, 1.25, {0.964, 0.91, 0.99}, {0.85, 0.81, 0.88}};
  drive.gap_by_manoeuvre = {8.25, 1.8, 1.25, {0.87, 0.8, 0.93}, {0.82, 0.7, 0.9}};
  drive.before_si[channel("track_left_mps")] = 0.05;
  drive.after_si[channel("track_left_mps")] = 0.0123;
  drive.where = {
      {{channel("track_left_mps"), 0.05, kMadeSigma, 0.9}, {channel("track_right_mps"), 0.02, kMadeSigma, 0.1}},
      {{"up & <over>", "climb", 0.5, 2, 0.6, 0, 0.7, 1}, {"drive", "cruise", 0, 2, 0.5, 0, 0.3, 0}},
      200};
  drive.where_left = {drive.where.channels, drive.where.phases, 20};
  drive.isolability = {{drive_lag, com_forward, ground_slope},
                       (Eigen::Matrix3d() << 0, 80, 75, 80, 0, 4.2, 75, 4.2, 0).finished()};
  drive.ranking = {{drive_lag, 0.0513, 400, 0.83}, {com_forward, -0.021, 20, 0.15}, {ground_slope, 0.5, 5, 0.05}};
  drive.left_over = {made_dependence()};
  d.stages.push_back(std::move(drive));

  StageDiagnosis body = made_stage(d, Passage::drive_to_body);
  body.decision.verdict = Verdict::unknown;
  body.decision.best.model.places = {{com_forward, -0.021}};
  body.decision.effects = {made_effect(com_forward, {-0.021, -0.03, -0.01}, 0.5)};
  body.decision.effects[0].value.spread = 0.02;
  body.decision.effects[0].doubts = {Doubt::disagreement};
  body.gap = {5, 3.2, 1, {0.45, 0.3, 0.6}, {0.5, 0.35, 0.65}};
  body.gap_by_manoeuvre = body.gap;
  body.where = {{{channel("x_m"), 0.1, kMadeSigma, 0.9}}, {{"drive", "cruise", 0, 2, 0.5, 0, 1, 0}}, 80};
  body.where_left = body.where;
  body.ranking = {{com_forward, -0.021, 50, 0.5}, {track_separation, 0.5, 30, 0.3}};
  d.stages.push_back(std::move(body));
  d.verdict = whole_verdict(d.stages);
  d.largest_stage = 0;
  d.roll_outs = 321;
  return d;
}

// The same with one verdict for its first stage, and no other stage.
inline gap::diagnose::Diagnosis made_diagnosis_of_one_stage() {
  gap::diagnose::Diagnosis d = made_diagnosis();
  d.stages.resize(1);
  return d;
}

inline gap::diagnose::Diagnosis made_without_gap() {
  gap::diagnose::Diagnosis d = made_diagnosis();
  d.verdict = gap::diagnose::Verdict::none;
  d.complete = true;
  d.largest_stage.reset();
  for (gap::diagnose::StageDiagnosis& stage : d.stages) {
    stage.decision = {};
    stage.gap.after = stage.gap.before = 1;
    stage.left_over.clear();
  }
  return d;
}

inline gap::diagnose::Diagnosis made_ambiguous() {
  gap::diagnose::Diagnosis d = made_diagnosis_of_one_stage();
  gap::diagnose::StageDecision& decision = d.stages[0].decision;
  decision.verdict = d.verdict = gap::diagnose::Verdict::ambiguous;
  decision.effects = {made_effect(com_forward, {-0.02, -0.03, -0.01}, 0.84)};
  decision.effects[0].rivals = {com_forward, ground_slope};
  decision.best.model.places = {{com_forward, -0.02}};
  gap::diagnose::ProposedManoeuvre turn{
      "turn-in-place", "flat", 11, 7.4, true, true, gap::diagnose::Gentleness::flat_driving, {}};
  turn.risk.largest_tilt_rad = 0.035;
  gap::diagnose::ProposedManoeuvre straight{
      "straight", "flat", 6, 0.3, false, true, gap::diagnose::Gentleness::flat_driving, {}};
  d.next = {turn, straight};
  d.to_separate = {com_forward, ground_slope};
  return d;
}

inline gap::diagnose::Diagnosis made_unknown() {
  gap::diagnose::Diagnosis d = made_diagnosis();
  d.stages.erase(d.stages.begin());
  d.verdict = gap::diagnose::Verdict::unknown;
  d.largest_stage = 0;
  return d;
}

// A gap in which no candidate gains enough to be fitted.
inline gap::diagnose::Diagnosis made_unknown_without_model() {
  gap::diagnose::Diagnosis d = made_unknown();
  gap::diagnose::StageDiagnosis& stage = d.stages[0];
  stage.decision.best = {};
  stage.decision.effects.clear();
  stage.gap.after = stage.gap.before;
  stage.gap.explains = stage.gap.shrink = {0, 0, 0};
  return d;
}

}  // namespace kenaf::test
