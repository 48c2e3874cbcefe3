#include "gap/compare/figures.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "gap/compare/report_numbers.hpp"
#include "gap/compare/world_section.hpp"
#include "gap/plot/simplify.hpp"

namespace kenaf::gap::compare {

namespace {

using plot::Chart;
using plot::Ink;
using plot::Line;
using plot::Point;
using plot::Stroke;

constexpr std::size_t kJoinedPairs = 60;
// Margins around the paths of the body's centre: the robot is about 0.5 m long, its centre 0.1 m above ground.
constexpr double kAround_m = 0.2, kBelow_m = 0.2;
constexpr double kAside_m = 0.1;  // smaller deviations from a line along x are clearer as numbers
constexpr double kTimeHeight_px = 270;
constexpr std::size_t kColumns = 900;  // of a line over time: no more detail can be seen
const Point kBreak{std::numeric_limits<double>::quiet_NaN(), 0};

// Lines that join about kJoinedPairs of the matched pairs, evenly over the real run, at `x_m` and `height`.
Line joined_pairs(const ComparedRun& run, double PoseFrame::*height) {
  Line line{{}, Ink::faint, Stroke::hair, "matched frames"};
  const std::size_t every = std::max<std::size_t>(1, run.real.size() / kJoinedPairs);
  for (std::size_t next = 0; const FramePair& pair : run.matching.pairs) {
    if (pair.real < next) continue;
    next = pair.real + every;
    const PoseFrame &real = run.real[pair.real], &sim = run.sim[pair.sim];
    line.points.insert(line.points.end(), {{real.x_m, real.*height}, {sim.x_m, sim.*height}, kBreak});
  }
  return line;
}

double degrees(double rad) {
  return kDegrees * rad;
}

// A line of one quantity of each real frame's error over the real run's time.
Line error_line(const ComparedRun& run, const std::vector<FrameError>& errors, double FrameError::*quantity,
                double scale, Ink ink, Stroke stroke, std::string legend) {
  Line line{{}, ink, stroke, std::move(legend)};
  for (std::size_t i = 0; i < errors.size(); ++i) {
    line.points.emplace_back(run.real[i].t_s, scale * std::abs(errors[i].*quantity));
  }
  line.points = plot::envelope(line.points, kColumns);
  return line;
}

Line mean_line(const ComparedRun& run, double value, Ink ink) {
  return {{{run.real.front().t_s, value}, {run.real.back().t_s, value}}, ink, Stroke::dashed, ""};
}

Chart over_time(const ComparedRun& run, std::string title, std::string y_label, double width_px) {
  Chart chart;
  chart.title = std::move(title);
  chart.x_label = "time of the real run (s)";
  chart.y_label = std::move(y_label);
  chart.width_px = width_px;
  chart.height_px = kTimeHeight_px;
  chart.include = {{run.real.front().t_s, 0}};
  return chart;
}

Line path_line(const std::vector<PoseFrame>& frames, double PoseFrame::*height, Ink ink, Stroke stroke,
               std::string legend) {
  Line line{{}, ink, stroke, std::move(legend)};
  for (const PoseFrame& frame : frames) line.points.emplace_back(frame.x_m, frame.*height);
  return line;
}

struct PathsChart {
  Chart chart;
  Eigen::AlignedBox2d bounds;  // of both paths
};

PathsChart paths_to_scale(const ComparedRun& run, double PoseFrame::*height, double width_px) {
  PathsChart paths;
  paths.chart.x_label = "x (m)";
  paths.chart.equal_scales = true;
  paths.chart.width_px = width_px;
  paths.chart.lines = {joined_pairs(run, height), path_line(run.real, height, Ink::real, Stroke::solid, "real"),
                       path_line(run.sim, height, Ink::sim, Stroke::dashed, "simulated")};
  for (const std::size_t line : {1u, 2u})
    for (const Point& p : paths.chart.lines[line].points) paths.bounds.extend(p);
  return paths;
}

PathsChart from_above(const ComparedRun& run, double width_px) {
  PathsChart paths = paths_to_scale(run, &PoseFrame::y_m, width_px);
  paths.chart.title = "Paths of the body's centre from above, to scale";
  paths.chart.y_label = "y (m)";
  paths.chart.include = {paths.bounds.min().array() - kAround_m, paths.bounds.max().array() + kAround_m};
  return paths;
}

bool has_y(const std::vector<PoseFrame>& frames) {
  return std::ranges::none_of(frames, [](const PoseFrame& frame) { return std::isnan(frame.y_m); });
}

}  // namespace

Chart path_figure(const ComparedRun& run, const physics::WorldDescription* world, double width_px) {
  if (run.plane == Plane::ground) return from_above(run, width_px).chart;
  auto [chart, bounds] = paths_to_scale(run, &PoseFrame::z_m, width_px);
  chart.title = "Paths of the body's centre in the vertical plane, to scale";
  chart.y_label = "z (m)";
  chart.include = {bounds.min() - Point(kAround_m, kBelow_m), bounds.max() + Point(kAround_m, kAround_m / 2)};
  // The view may grow to keep its scale; the section reaches beyond it in any case.
  const double beyond_m = 10 * (1 + bounds.sizes().maxCoeff());
  const double y_m = std::isnan(run.real.front().y_m) ? 0 : run.real.front().y_m;
  if (world != nullptr)
    draw_section(chart, *world, y_m, bounds.min().array() - beyond_m, bounds.max().array() + beyond_m);
  return chart;
}

std::optional<Chart> plan_figure(const ComparedRun& run, double width_px) {
  if (run.plane == Plane::ground || !has_y(run.real) || !has_y(run.sim)) return std::nullopt;
  PathsChart paths = from_above(run, width_px);
  if (paths.bounds.sizes().y() < kAside_m) return std::nullopt;
  return std::move(paths.chart);
}

Chart angle_figure(const ComparedRun& run, double width_px) {
  const bool of_pitch = run.plane == Plane::vertical;
  Chart chart = of_pitch ? over_time(run, "Pitch, matched frames", "pitch, nose down (deg)", width_px)
                         : over_time(run, "Yaw, matched frames", "yaw, to the left (deg)", width_px);
  double PoseFrame::*const angle = of_pitch ? &PoseFrame::pitch_rad : &PoseFrame::yaw_rad;
  Line real{{}, Ink::real, Stroke::solid, "real"}, sim{{}, Ink::sim, Stroke::dashed, "simulated"};
  for (const PoseFrame& frame : run.real) real.points.emplace_back(frame.t_s, degrees(frame.*angle));
  for (const FramePair& pair : run.matching.pairs) {
    sim.points.emplace_back(run.real[pair.real].t_s, degrees(run.sim[pair.sim].*angle));
  }
  for (Line* line : {&real, &sim}) line->points = plot::envelope(line->points, kColumns);
  chart.lines = {std::move(real), std::move(sim)};
  return chart;
}

Chart position_error_figure(const ComparedRun& run, double width_px) {
  Chart chart =
      over_time(run, fmt::format("Position error per frame, norm of {}; means dashed", coordinates(run.plane)),
                "error (mm)", width_px);
  const double matched_mm = kMillimetres * run.errors.matched_summary.position_m.mean();
  const double same_time_mm = kMillimetres * run.errors.same_time_summary.position_m.mean();
  chart.lines = {error_line(run, run.errors.same_time, &FrameError::position_m, kMillimetres, Ink::faint, Stroke::solid,
                            fmt::format("same time, mean {} mm", number(same_time_mm, 1))),
                 mean_line(run, same_time_mm, Ink::faint),
                 error_line(run, run.errors.matched, &FrameError::position_m, kMillimetres, Ink::real, Stroke::solid,
                            fmt::format("matched, mean {} mm", number(matched_mm, 1))),
                 mean_line(run, matched_mm, Ink::real)};
  return chart;
}

Chart angle_error_figure(const ComparedRun& run, double width_px) {
  Chart chart = over_time(run, "Angle errors per matched frame; mean of pitch dashed", "error (deg)", width_px);
  const ErrorSummary& summary = run.errors.matched_summary;
  const auto add = [&](double FrameError::*quantity, const Summary& mean, Ink ink, std::string_view name) {
    if (mean.weight() == 0) return;
    chart.lines.push_back(error_line(run, run.errors.matched, quantity, kDegrees, ink, Stroke::solid,
                                     fmt::format("{}, mean {}", name, number(degrees(mean.mean()), 2))));
  };
  add(&FrameError::roll_rad, summary.roll_rad, Ink::third, "roll");
  add(&FrameError::yaw_rad, summary.yaw_rad, Ink::fourth, "yaw");
  add(&FrameError::pitch_rad, summary.pitch_rad, Ink::real, "pitch");
  if (summary.pitch_rad.weight() > 0)
    chart.lines.push_back(mean_line(run, degrees(summary.pitch_rad.mean()), Ink::real));
  return chart;
}

}  // namespace kenaf::gap::compare
