#include "gap/diagnose/page/moments.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "gap/diagnose/channels.hpp"
#include "gap/diagnose/report_words.hpp"

namespace kenaf::gap::diagnose {
namespace {

constexpr std::size_t kMostMoments = 6;
constexpr double kWorthAMoment = 0.02;  // minimum share of the whole gap, after the first
constexpr double kAround_s = 1.5;       // shown before and after it
constexpr double kBeyondEnds_s = 0.5;   // a course is known for so long before its first value and after its last
constexpr double kNoPlace = std::numeric_limits<double>::quiet_NaN();

// The worst moment in a phase; null if nothing was compared there.
const RunMoment* worst_within(const RunGap& gap, const PhaseGap& phase) {
  const RunMoment* worst = nullptr;
  for (const RunMoment& moment : gap.moments)
    if (moment.at_s >= phase.from_s && moment.at_s <= phase.to_s && (!worst || moment.times_noise > worst->times_noise))
      worst = &moment;
  return worst;
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
  const std::vector<std::size_t> stages = stages_with_gap(d);
  const std::vector<ComparedRun> runs = drawn_runs(d, overlays);
  const ComparedRun* worst = worst_run(runs);
  if (stages.empty() || !worst) return {};

  // phases of all stages with a gap, by their share of the whole
  struct RankedPhase {
    std::size_t stage, phase;
    double share;
  };
  std::vector<RankedPhase> places;
  for (const std::size_t s : stages)
    for (std::size_t p = 0; p < d.stages[s].where.phases.size(); ++p)
      if (const double share = share_of_gap(d, s) * d.stages[s].where.phases[p].share; share > 0)
        places.push_back({s, p, share});
  std::ranges::stable_sort(places, std::ranges::greater{}, &RankedPhase::share);

  std::vector<Moment> moments;
  const auto add = [&](std::size_t s, std::optional<std::size_t> p, const ComparedRun& run, const RunMoment& at) {
    const auto overlay = std::ranges::find(overlays, run.run, &Overlay::run);
    const bool is_known = std::ranges::any_of(
        moments, [&](const Moment& other) { return overlays[other.overlay].run == run.run && other.at_s == at.at_s; });
    if (is_known) return;
    Moment moment{s,
                  p,
                  static_cast<std::size_t>(overlay - overlays.begin()),
                  overlay->group,
                  at.at_s,
                  at,
                  &at == run.nominal.worst_moment(),
                  {},
                  {},
                  0};
    if (fill_moment(d, *overlay, moment)) moments.push_back(std::move(moment));
  };

  // the worst of all, in the phase that has the largest share there
  const RunMoment& most = *worst->nominal.worst_moment();
  const auto around = std::ranges::find_if(places, [&](const RankedPhase& place) {
    const PhaseGap& phase = d.stages[place.stage].where.phases[place.phase];
    return overlays[static_cast<std::size_t>(std::ranges::find(overlays, worst->run, &Overlay::run) - overlays.begin())]
                   .group == phase.group &&
           most.at_s >= phase.from_s && most.at_s <= phase.to_s;
  });
  if (around != places.end())
    add(around->stage, around->phase, *worst, most);
  else
    add(stages.front(), std::nullopt, *worst, most);

  // those of the other phases
  const bool has_worst = !moments.empty();
  for (const RankedPhase& place : places) {
    if (moments.size() == kMostMoments || (moments.size() > (has_worst ? 1 : 0) && place.share < kWorthAMoment)) break;
    const PhaseGap& phase = d.stages[place.stage].where.phases[place.phase];
    const auto overlay = std::ranges::find(overlays, phase.group, &Overlay::group);
    if (overlay == overlays.end()) continue;
    const auto run = std::ranges::find(runs, overlay->run, &ComparedRun::run);
    if (run == runs.end()) continue;
    if (const RunMoment* at = worst_within(run->nominal, phase)) add(place.stage, place.phase, *run, *at);
  }
  std::ranges::stable_sort(moments, std::ranges::greater{},
                           [](const Moment& moment) { return moment.gap.times_noise; });
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
    return moment.stage == stage && moment.group == phase.group && moment.phase &&
           d.stages[stage].where.phases[*moment.phase].from_s == phase.from_s;
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
  const std::string at = time_in_words(at_s);
  return command + fmt::format(" --run {} --at {}", shell_word(file, false), at.substr(0, at.find(' ')));
}

}  // namespace kenaf::gap::diagnose
