#include "gap/diagnose/page/moments.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>

#include "gap/diagnose/channels.hpp"
#include "gap/diagnose/report_words.hpp"

namespace kenaf::gap::diagnose {
namespace {

constexpr std::size_t kMostMoments = 6;
constexpr double kWorthAMoment = 0.02;  // minimum share of the whole gap, after the first
constexpr double kAround_s = 1.5;       // shown before and after it
constexpr double kBeyondEnds_s = 0.5;   // a course is known for so long before its first value and after its last
constexpr double kNoPlace = std::numeric_limits<double>::quiet_NaN();

// The rms over a stage's channels in each span of a run, in noise units.
std::map<std::size_t, double> stage_residual(const Diagnosis& d, const StageDiagnosis& stage, std::size_t run) {
  struct Sum {
    double squares = 0;
    int bins = 0;
  };
  std::map<std::size_t, Sum> sums;
  const std::vector<Bin>& bins = d.features.of(stage.passage)[run].bins;
  for (std::size_t b = 0; b < bins.size(); ++b) {
    const auto i = static_cast<Eigen::Index>(b);
    const double sigma = stage.nominal_floor.sigma_of_bin[run][i];
    if (sigma <= 0) continue;
    Sum& sum = sums[bins[b].span];
    sum.squares += std::pow(stage.residuals[run][i] / sigma, 2);
    ++sum.bins;
  }
  std::map<std::size_t, double> rms;
  for (const auto& [span, sum] : sums) rms[span] = std::sqrt(sum.squares / sum.bins);
  return rms;
}

// The middle of the span of a phase in which the stage differs most; the phase's middle if nothing is known there.
double worst_time_s(const Diagnosis& d, const StageDiagnosis& stage, std::size_t run, const PhaseGap& phase) {
  double worst_s = (phase.from_s + phase.to_s) / 2, most = -1;
  const bool is_known =
      run < stage.residuals.size() && stage.residuals[run].size() > 0 && run < stage.nominal_floor.sigma_of_bin.size();
  if (!is_known) return worst_s;
  for (const auto& [span, rms] : stage_residual(d, stage, run)) {
    const double middle_s = (static_cast<double>(span) + 0.5) * d.options.span_s;
    if (middle_s >= phase.from_s && middle_s <= phase.to_s && rms > most) most = rms, worst_s = middle_s;
  }
  return worst_s;
}

// A column at any time: linear between measured values, NaN in long gaps; constant shortly beyond the ends.
class Course {
 public:
  Course(const runs::Run& run, std::string_view column) {
    const std::span<const Channel> channels = diagnosis_channels();
    const auto channel = std::ranges::find(channels, column, &Channel::column);
    if (channel != channels.end()) points_ = over_time(run, static_cast<std::size_t>(channel - channels.begin()));
  }
  bool empty() const { return points_.empty(); }
  double at(double t_s) const {
    const auto after = std::ranges::lower_bound(points_, t_s, {}, [](const plot::Point& p) { return p.x(); });
    if (points_.empty() || t_s < points_.front().x() - kBeyondEnds_s || t_s > points_.back().x() + kBeyondEnds_s)
      return kNoPlace;
    if (after == points_.begin()) return points_.front().y();
    if (after == points_.end()) return points_.back().y();
    const plot::Point &before = *(after - 1), &next = *after;
    if (next.x() == before.x()) return next.y();
    return before.y() + (next.y() - before.y()) * (t_s - before.x()) / (next.x() - before.x());
  }

 private:
  std::vector<plot::Point> points_;
};

struct Courses {
  std::array<Course, 3> position, angles;
  std::array<Course, 4> flippers;
  explicit Courses(const runs::Run& run)
      : position{Course(run, "x_m"), Course(run, "y_m"), Course(run, "z_m")},
        angles{Course(run, "roll_rad"), Course(run, "pitch_rad"), Course(run, "yaw_rad")},
        flippers{Course(run, "flipper_fl_rad"), Course(run, "flipper_fr_rad"), Course(run, "flipper_rl_rad"),
                 Course(run, "flipper_rr_rad")} {}
  bool has_pose() const { return !position[0].empty() && !position[1].empty() && !angles[2].empty(); }
};

// As in a playback: a height that was not measured is that of `other`, tilts are level.
std::vector<std::optional<RobotPose>> poses_of(const Courses& own, const Courses& other,
                                               std::span<const double> times_s) {
  std::vector<std::optional<RobotPose>> poses;
  for (const double t_s : times_s) {
    RobotPose pose;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto k = static_cast<Eigen::Index>(i);
      pose.p_WB_m[k] = own.position[i].empty() ? other.position[i].at(t_s) : own.position[i].at(t_s);
      pose.angles_rad[k] = own.angles[i].empty() ? 0 : own.angles[i].at(t_s);
    }
    for (std::size_t i = 0; i < 4; ++i) {
      const Course& flipper = own.flippers[i].empty() ? other.flippers[i] : own.flippers[i];
      pose.flippers_rad[i] = flipper.empty() ? 0 : flipper.at(t_s);
      if (std::isnan(pose.flippers_rad[i])) pose.flippers_rad[i] = 0;
    }
    const bool known = pose.p_WB_m.allFinite() && pose.angles_rad.allFinite();
    poses.push_back(known ? std::optional(pose) : std::nullopt);
  }
  return poses;
}

// Fills times and bodies; false if there is no real robot to be seen at the moment.
bool fill_moment(const Diagnosis& d, const Overlay& overlay, Moment& moment) {
  const runs::Run& real = d.observations.runs[overlay.run].run;
  const double end_s = real.column("t_s").back();
  const double from_s = std::max(0.0, moment.at_s - kAround_s), to_s = std::min(end_s, moment.at_s + kAround_s);
  const auto steps = static_cast<std::size_t>(std::max(0.0, std::floor((to_s - from_s) / kPicture_s + 1e-6)));
  for (std::size_t i = 0; i <= steps; ++i) moment.times_s.push_back(from_s + kPicture_s * static_cast<double>(i));
  moment.now = std::min(steps, static_cast<std::size_t>(std::lround((moment.at_s - from_s) / kPicture_s)));

  const Courses of_real(real), of_nominal(overlay.nominal);
  if (!of_real.has_pose() || !of_nominal.has_pose()) return false;
  moment.bodies.push_back({"real", poses_of(of_real, of_nominal, moment.times_s)});
  moment.bodies.push_back({"nominal", poses_of(of_nominal, of_nominal, moment.times_s)});
  if (overlay.corrected)
    moment.bodies.push_back({"corrected", poses_of(Courses(*overlay.corrected), of_nominal, moment.times_s)});
  return moment.bodies.front().poses[moment.now].has_value();
}

// A word of a shell's command line; a path that begins with a dash is no option.
std::string shell_word(std::string_view text, bool is_path) {
  constexpr std::string_view kPlain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-./:@%+=,";
  std::string word = (is_path && text.starts_with('-') ? "./" : "") + std::string(text);
  if (!word.empty() && word.find_first_not_of(kPlain) == std::string::npos) return word;
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

}  // namespace

std::vector<Moment> moments_of(const Diagnosis& d, std::span<const Overlay> overlays) {
  // phases of all stages with a gap, by their share of the whole
  struct RankedPhase {
    std::size_t stage, phase;
    double share;
  };
  std::vector<RankedPhase> places;
  for (const std::size_t s : stages_with_gap(d))
    for (std::size_t p = 0; p < d.stages[s].where.phases.size(); ++p)
      if (const double share = share_of_gap(d, s) * d.stages[s].where.phases[p].share; share > 0)
        places.push_back({s, p, share});
  std::ranges::stable_sort(places, std::ranges::greater{}, &RankedPhase::share);

  std::vector<Moment> moments;
  for (const RankedPhase& place : places) {
    if (moments.size() == kMostMoments || (!moments.empty() && place.share < kWorthAMoment)) break;
    const StageDiagnosis& stage = d.stages[place.stage];
    const PhaseGap& phase = stage.where.phases[place.phase];
    const auto overlay = std::ranges::find(overlays, phase.group, &Overlay::group);
    if (overlay == overlays.end() || d.observations.runs[overlay->run].run.row_count() == 0) continue;
    Moment moment{
        place.stage, place.phase, static_cast<std::size_t>(overlay - overlays.begin()), phase.group, 0, {}, {}, 0};
    moment.at_s = worst_time_s(d, stage, overlay->run, phase);
    const bool is_known = std::ranges::any_of(moments, [&](const Moment& other) {
      return other.overlay == moment.overlay && std::abs(other.at_s - moment.at_s) < d.options.span_s / 2;
    });
    if (!is_known && fill_moment(d, *overlay, moment)) moments.push_back(std::move(moment));
  }
  return moments;
}

std::string moment_id(std::size_t index) {
  return fmt::format("moment-{}", index + 1);
}

std::string run_id(std::size_t group) {
  return fmt::format("run-{}", group + 1);
}

std::string link_to_phase(const Diagnosis& d, std::span<const Moment> moments, std::size_t stage,
                          const PhaseGap& phase) {
  // phases before and after correction begin alike
  auto found = std::ranges::find_if(moments, [&](const Moment& moment) {
    return moment.stage == stage && moment.group == phase.group &&
           d.stages[stage].where.phases[moment.phase].from_s == phase.from_s;
  });
  if (found == moments.end())
    found = std::ranges::find_if(moments, [&](const Moment& moment) {
      return moment.group == phase.group && moment.at_s >= phase.from_s && moment.at_s <= phase.to_s;
    });
  const std::vector<std::size_t> drawn = shown_groups(d);
  if (found == moments.end() && std::ranges::find(drawn, phase.group) == drawn.end()) return {};
  return "#" +
         (found == moments.end() ? run_id(phase.group) : moment_id(static_cast<std::size_t>(found - moments.begin())));
}

std::string play_command(const Diagnosis& d, std::string_view file, double at_s, std::string_view report_folder) {
  std::string command = "kenaf-gap play " + shell_word(d.folder, true);
  if (!report_folder.empty()) command += " --report " + shell_word(report_folder, true);
  if (!d.options.robot.empty()) command += " --robot " + shell_word(d.options.robot, true);
  if (!d.options.world.empty()) command += " --world " + shell_word(d.options.world, true);
  return command + fmt::format(" --run {} --at {:.2f}", shell_word(file, false), at_s);
}

}  // namespace kenaf::gap::diagnose
