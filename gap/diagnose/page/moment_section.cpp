#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "gap/diagnose/page/moment_view.hpp"
#include "gap/diagnose/page/words.hpp"
#include "gap/plot/chart.hpp"
#include "physics/pose.hpp"

namespace kenaf::gap::diagnose {
namespace {

constexpr double kNear_m = 2.5;              // how much of the world is seen
constexpr std::size_t kMostMeshFaces = 800;  // some 30 kB
constexpr std::size_t kMostNamed = 3;        // named below a moment

// "42 mm and 7.2 degrees apart".
std::string apart_in_words(const RobotPose& a, const RobotPose& b) {
  const double turn_rad = physics::rotation_from(a.angles_rad).angularDistance(physics::rotation_from(b.angles_rad));
  return fmt::format("{:.0f} mm and {:.1f} degrees apart", 1000 * (a.p_WB_m - b.p_WB_m).norm(),
                     turn_rad * 180 / std::numbers::pi);
}

// How far the simulated robots are from the real one.
std::string how_far(const Moment& moment) {
  std::string words;
  const std::optional<RobotPose>& real = moment.bodies.front().poses[moment.now];
  for (std::size_t i = 1; i < moment.bodies.size(); ++i) {
    const std::optional<RobotPose>& pose = moment.bodies[i].poses[moment.now];
    if (!pose) continue;
    const std::string kind(moment.bodies[i].kind);
    words += fmt::format("{}{} and real robot: {}", words.empty() ? "" : "; ",
                         words.empty() ? with_capital(kind) : kind, apart_in_words(*real, *pose));
  }
  return words.empty() ? "The nominal robot's pose is not known here." : words + ".";
}

// The channels in which they differ most.
std::string most_off(const Moment& moment) {
  std::string items;
  for (const ChannelMoment& channel :
       std::span(moment.gap.channels).first(std::min(kMostNamed, moment.gap.channels.size())))
    items += fmt::format("<li>{}</li>\n", plot::escaped(in_words(channel)));
  return fmt::format("<ul>\n{}</ul>\n", items);
}

std::string moment_figure(const Diagnosis& d, const Moment& moment, std::size_t index, const RobotFaces& robot,
                          const Overlay& overlay, std::string_view report_folder) {
  const StageDiagnosis& stage = d.stages[moment.stage];
  const PhaseGap* phase = moment.phase ? &stage.where.phases[*moment.phase] : nullptr;
  const Observation& run = d.observations.runs[overlay.run];
  WorldFaces world;
  if (run.world < d.observations.worlds.size())
    world = faces_near(d.observations.worlds[run.world], moment.bodies.front().poses[moment.now]->p_WB_m, kNear_m,
                       kMostMeshFaces);
  const std::string title = fmt::format("{}{}, at {}", group_title(d, moment.group),
                                        phase ? fmt::format(", {}", phase->phase) : "", time_in_words(moment.at_s));

  // how large, where, the picture, in which channels, and how to see the rest
  std::string how_large =
      fmt::format("of {}: {}, rms of all channels", run.file, times_noise_in_words(moment.gap.times_noise));
  if (index == 0)
    how_large += ", the worst moment of the runs drawn here";
  else if (moment.is_worst_of_run)
    how_large += ", the worst moment of this run";
  if (phase)
    how_large += fmt::format(". The phase has {} of the gap {}", percent(phase->share), from_to(stage.passage));
  return fmt::format(
      "<figure class=\"moment\" id=\"{}\" data-moment=\"{}\">\n<figcaption><b>{}</b> {}</figcaption>\n"
      "<div class=\"scene\">{}</div>\n{}{}<p><code>{}</code></p>\n</figure>\n",
      moment_id(index), plot::escaped(moment_data(moment, robot, world)), plot::escaped(title),
      plot::escaped(how_large), moment_still(moment, robot, world, title), most_off(moment),
      paragraph(how_far(moment), "soft"), plot::escaped(play_command(d, run.file, moment.at_s, report_folder)));
}

}  // namespace

std::string moments_section(const Diagnosis& d, std::span<const Overlay> overlays, std::span<const Moment> moments,
                            std::string_view report_folder) {
  if (overlays.empty() || stages_with_gap(d).empty()) return {};
  std::string html = section_head("moments", "The worst moments");
  if (moments.empty())
    return html + paragraph(
                      "These runs have no measured pose (x_m, y_m, yaw_rad), so that none is drawn here; kenaf-gap "
                      "play draws them by dead reckoning.");
  html += paragraph(
      "The quarters of a second in which the nominal simulation is farthest from the robot: the worst moment of all, "
      "and the worst ones in the phases with most of the gap. 12 \u00d7 noise is a difference of twelve times the "
      "noise, "
      "1 is what noise alone does. All channels: root of the mean square of each; below the picture those that differ "
      "most, means of that quarter of a second, with the difference measured minus simulated. kenaf-gap play has the "
      "same worst moment. Solid: the real robot; translucent orange: the nominal simulation; green: the corrected one. "
      "The "
      "command shows the whole run, with curves, in a browser; give it in the folder in which the "
      "diagnosis ran.",
      "soft");
  const RobotFaces robot = faces_of(physics::dimensions_of(d.observations.robot));
  html += fmt::format("<div class=\"figures\" id=\"moment-figures\" data-robot=\"{}\">\n",
                      plot::escaped(robot_data(robot)));
  for (std::size_t i = 0; i < moments.size(); ++i)
    html += moment_figure(d, moments[i], i, robot, overlays[moments[i].overlay], report_folder);
  return html + "</div>\n";
}

}  // namespace kenaf::gap::diagnose
