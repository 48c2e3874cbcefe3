#include "gap/diagnose/page/figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "gap/compare/world_section.hpp"
#include "gap/diagnose/channels.hpp"
#include "gap/diagnose/page/words.hpp"
#include "gap/plot/simplify.hpp"
#include "gap/plot/svg.hpp"

namespace kenaf::gap::diagnose {
namespace {

using plot::Chart;
using plot::Ink;
using plot::Line;
using plot::Point;
using plot::Stroke;

constexpr std::size_t kColumns = 450;      // of a chart of half width: more detail is invisible
constexpr std::size_t kPathPoints = 4000;  // likewise of a path
constexpr double kChannelHeight_px = 240;
constexpr double kTitle_px = 360;    // of a chart of half width, in letters of normal size: titles are larger
constexpr double kClimbs_m = 0.05;   // change of height from which it is seen from the side
constexpr double kAround_m = 0.2;    // around the body's centre: the robot is about 0.5 m long
constexpr double kSideways_m = 0.1;  // likewise, of a path seen from above
constexpr double kWholeGap_px = 50;  // radius of a disc for the whole gap
constexpr double kLabelled = 0.01;   // minimum share of the gap for a label of a phase or chart
constexpr double kApart = 0.2;       // minimum distance of labels, as a share of the path's extent

std::vector<Point> drawn_over_time(const runs::Run& run, std::size_t channel) {
  return plot::envelope(over_time(run, channel), kColumns);
}

// A place where x and at least one of y and z were measured.
struct Place {
  double t_s, x_m, y_m, z_m;
};
std::vector<Place> places_of(const runs::Run& run) {
  const auto time = run.column("t_s"), x = run.column("x_m"), y = run.column("y_m"), z = run.column("z_m");
  std::vector<Place> places;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const Place place{time[i], x[i], y.empty() ? NAN : y[i], z.empty() ? NAN : z[i]};
    if (!std::isnan(place.x_m) && (!std::isnan(place.y_m) || !std::isnan(place.z_m))) places.push_back(place);
  }
  return places;
}

bool seen_from_side(const runs::Run& run) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  bool has_y = false;
  for (const Place& place : places_of(run)) {
    if (!std::isnan(place.z_m)) low = std::min(low, place.z_m), high = std::max(high, place.z_m);
    has_y |= !std::isnan(place.y_m);
  }
  return high - low > kClimbs_m || !has_y;
}

std::vector<Point> path_of(const runs::Run& run, bool from_side) {
  const std::vector<Place> places = places_of(run);
  const std::size_t every = 1 + places.size() / kPathPoints;
  std::vector<Point> points;
  for (std::size_t i = 0; i < places.size(); i += every)
    points.emplace_back(places[i].x_m, from_side ? places[i].z_m : places[i].y_m);
  return points;
}

// Axes to scale, with the ground if it is seen from the side.
Chart place_chart(const Diagnosis& d, const Overlay& overlay, std::vector<Line> lines, bool from_side) {
  Chart chart;
  chart.x_label = "x (m)";
  chart.y_label = from_side ? "z (m)" : "y (m)";
  chart.equal_scales = true;
  chart.width_px = kHalf_px;
  Point low(1e9, 1e9), high = -low;
  for (const Line& line : lines)
    for (const Point& p : line.points)
      if (p.allFinite()) low = low.cwiseMin(p), high = high.cwiseMax(p);
  chart.lines = std::move(lines);
  if (low.x() > high.x()) return chart;
  const Point around_m(kAround_m, from_side ? kAround_m : kSideways_m);
  chart.include = {low - around_m, high + around_m};
  if (!from_side) return chart;
  const double beyond_m = 10 * (1 + (high - low).maxCoeff());
  const Observation& run = d.observations.runs[overlay.run];
  const std::vector<Place> places = places_of(run.run);
  const double y_m = places.empty() || std::isnan(places.front().y_m) ? 0 : places.front().y_m;
  if (run.world < d.observations.worlds.size())
    compare::draw_section(chart, d.observations.worlds[run.world], y_m, low.array() - beyond_m,
                          high.array() + beyond_m);
  return chart;
}

// All channels together over time.
Line residual_line(const RunGap& gap) {
  Line line;
  for (const RunMoment& moment : gap.moments) line.points.emplace_back(moment.at_s, moment.times_noise);
  line.points = plot::envelope(line.points, kColumns);
  return line;
}

// Where the robot was in the middle of a phase.
Point place_of(const std::vector<Place>& places, const PhaseGap& phase, bool from_side) {
  const double middle_s = (phase.from_s + phase.to_s) / 2;
  const auto after = std::ranges::lower_bound(places, middle_s, {}, &Place::t_s);
  if (after == places.end()) return {NAN, NAN};
  return {after->x_m, from_side ? after->z_m : after->y_m};
}

}  // namespace

Chart channel_figure(const Diagnosis& d, const Overlay& overlay, std::size_t index) {
  const std::size_t channel = overlay.channels[index];
  const Channel& shown = diagnosis_channels()[channel];
  Chart chart;
  chart.title = overlay.shares[index] >= kLabelled
                    ? fmt::format("{} over time ({} of the gap)", shown.column, percent(overlay.shares[index]))
                    : fmt::format("{} over time", shown.column);
  chart.x_label = "t (s)";
  chart.y_label = fmt::format("{} ({})", shown.column, shown.unit);
  chart.width_px = kHalf_px;
  chart.height_px = kChannelHeight_px;
  chart.lines = {{drawn_over_time(d.observations.runs[overlay.run].run, channel), Ink::real, Stroke::wide, "real"},
                 {drawn_over_time(overlay.nominal, channel), Ink::sim, Stroke::dashed, "nominal"}};
  if (overlay.corrected)
    chart.lines.push_back({drawn_over_time(*overlay.corrected, channel), Ink::third, Stroke::dotted, "corrected"});
  return chart;
}

Chart path_figure(const Diagnosis& d, const Overlay& overlay) {
  const runs::Run& real = d.observations.runs[overlay.run].run;
  const bool from_side = seen_from_side(real);
  std::vector<Line> lines{{path_of(real, from_side), Ink::real, Stroke::wide, "real"},
                          {path_of(overlay.nominal, from_side), Ink::sim, Stroke::dashed, "nominal"}};
  if (overlay.corrected)
    lines.push_back({path_of(*overlay.corrected, from_side), Ink::third, Stroke::dotted, "corrected"});
  Chart chart = place_chart(d, overlay, std::move(lines), from_side);
  chart.title = fmt::format("Path of the body's centre, seen from {}, to scale", from_side ? "the right" : "above");
  return chart;
}

Chart residual_figure(const Diagnosis& d, const Overlay& overlay) {
  Chart chart;
  chart.title = "Residual over time, all channels";
  chart.x_label = "t (s)";
  chart.y_label = "rms (\u00d7 noise)";
  chart.width_px = kHalf_px;
  chart.height_px = kChannelHeight_px;
  chart.include = {{0, 0}};

  // a run that was not compared has an empty chart
  const std::vector<ComparedRun> compared = drawn_runs(d, std::span(&overlay, 1));
  if (compared.empty()) return chart;

  // rms over channels per span, in times the noise: 1 is noise alone
  Line before = residual_line(compared.front().nominal);
  before.ink = Ink::sim;
  before.stroke = Stroke::dashed;
  before.legend = "before";
  if (before.points.empty()) return chart;
  const double end_s = before.points.back().x();
  chart.lines = {{{{0, 1}, {end_s, 1}}, Ink::faint, Stroke::hair, "noise: 1"}, std::move(before)};

  // the same after correction
  if (compared.front().corrected) {
    Line after = residual_line(*compared.front().corrected);
    after.ink = Ink::third;
    after.legend = "after";
    chart.lines.push_back(std::move(after));
  }
  return chart;
}

Chart channel_residual_figure(const Diagnosis& d, const Overlay& overlay, std::size_t index) {
  const std::size_t channel = overlay.channels[index];
  const Channel& shown = diagnosis_channels()[channel];
  Chart chart;
  chart.title = fmt::format("{}: measured minus simulated", shown.column);
  chart.x_label = "t (s)";
  chart.y_label = fmt::format("difference ({})", shown.unit);
  chart.width_px = kHalf_px;
  chart.height_px = kChannelHeight_px;
  chart.include = {{0, 0}};

  // a run that was not compared has an empty chart
  if (overlay.run >= d.features.maps.size()) return chart;
  const FeatureMap& map = d.features.maps[overlay.run];

  // values of this channel's bins, at the middle of each
  const auto line_of = [&](const Eigen::VectorXd& values, Ink ink, Stroke stroke, std::string_view legend) {
    Line line{{}, ink, stroke, std::string(legend)};
    for (std::size_t b = 0; b < map.bins().size(); ++b)
      if (map.bins()[b].channel == channel)
        line.points.emplace_back((static_cast<double>(map.bins()[b].span) + 0.5) * map.span_s(),
                                 values[static_cast<Eigen::Index>(b)]);
    line.points = plot::envelope(line.points, kColumns);
    return line;
  };

  // the band of noise, then the residual before and after correction
  const Eigen::VectorXd sigma = noise_of_bins(map, floors_of(d));
  chart.lines = {line_of(sigma, Ink::faint, Stroke::hair, "noise, 1 sigma"),
                 line_of(-sigma, Ink::faint, Stroke::hair, ""),
                 line_of(map.measured() - map.of(overlay.nominal), Ink::sim, Stroke::dashed, "before")};
  if (overlay.corrected)
    chart.lines.push_back(line_of(map.measured() - map.of(*overlay.corrected), Ink::third, Stroke::solid, "after"));
  return chart;
}

Chart places_figure(const Diagnosis& d, const Overlay& overlay, std::span<const Moment> moments, std::size_t s) {
  // the real path as background
  const StageDiagnosis& stage = d.stages[s];
  const runs::Run& real = d.observations.runs[overlay.run].run;
  const bool from_side = seen_from_side(real);
  const std::vector<Place> places = places_of(real);
  Chart chart =
      place_chart(d, overlay, {{path_of(real, from_side), Ink::faint, Stroke::solid, "real path"}}, from_side);
  if (places.empty()) return chart;

  // the manoeuvre's name is shortened so that the title fits
  const std::string_view what = from_side ? ": gap by place, from the right" : ": gap by place, from above";
  chart.title = plot::end_of(group_title(d, overlay.group), kTitle_px - plot::text_width_px(what));
  chart.title += what;

  // discs after correction are scaled to the gap before: both kinds show shares of the same total
  const double left = stage.where.beyond_chance > 0 ? stage.where_left.beyond_chance / stage.where.beyond_chance : 0;

  // labels are at least a part of the path's width apart
  const auto [west, east] = std::ranges::minmax(places, {}, &Place::x_m);
  const double width_m = east.x_m - west.x_m;
  std::vector<Point> labelled;

  // one disc per phase, with area proportional to its share; the larger ones before correction have labels
  const auto add = [&](const GapPlaces& where, double scale, bool before) {
    bool first = true;
    for (const PhaseGap& phase : where.phases) {
      if (phase.group != overlay.group || phase.share * scale <= 0) continue;
      plot::Disc disc{.at = place_of(places, phase, from_side),
                      .radius_px = kWholeGap_px * std::sqrt(phase.share * scale),
                      .ink = before ? Ink::sim : Ink::third,
                      .filled = !before,
                      .legend = std::exchange(first, false) ? (before ? "before" : "after") : "",
                      .hint = fmt::format("{} {}, {:.1f} to {:.1f} s", phase.phase, percent(phase.share * scale),
                                          phase.from_s, phase.to_s),
                      .link = link_to_phase(d, moments, s, phase)};
      const bool has_room = std::ranges::none_of(
          labelled, [&](const Point& other) { return std::abs(other.x() - disc.at.x()) < kApart * width_m; });
      if (before && phase.share >= kLabelled && disc.at.allFinite() && has_room) {
        disc.label = fmt::format("{} {}", phase.phase, percent(phase.share));
        labelled.push_back(disc.at);
      }
      chart.discs.push_back(std::move(disc));
    }
  };

  // rings before, discs after
  add(stage.where, 1, true);
  if (!stage.decision.best.model.places.empty()) add(stage.where_left, left, false);
  return chart;
}

}  // namespace kenaf::gap::diagnose
