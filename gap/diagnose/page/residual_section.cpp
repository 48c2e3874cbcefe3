#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "gap/diagnose/channels.hpp"
#include "gap/diagnose/page/figures.hpp"
#include "gap/diagnose/page/sections.hpp"
#include "gap/diagnose/page/words.hpp"
#include "gap/plot/row_chart.hpp"

namespace kenaf::gap::diagnose {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

constexpr double kLeastShown = 0.1;  // of noise: smaller values are drawn at this edge

struct ChannelResidual {
  const Channel* channel;
  double share, before, after, floor;  // the last three in the channel's unit; after: NaN without a model
};

std::vector<ChannelResidual> channel_residuals(const StageDiagnosis& stage) {
  std::vector<ChannelResidual> result;
  const bool has_model = !stage.decision.best.model.places.empty();
  for (const ChannelGap& gap : stage.where.channels) {
    const bool has_after = has_model && gap.channel < stage.after_si.size();
    result.push_back({&diagnosis_channels()[gap.channel], gap.share, gap.rms,
                      has_after ? stage.after_si[gap.channel] : kNaN, gap.floor});
  }
  return result;
}

std::string channel_figure(const Diagnosis& d, const std::vector<ChannelResidual>& residuals) {
  plot::RowChart chart;
  chart.title = "Residual of each channel in times the noise, largest share of the gap first";
  chart.x_label = "rms of measured minus simulated, over rms of noise (1: noise alone)";
  chart.legend = {{plot::Shape::ring, plot::Ink::sim, "before"}};
  // one row per channel: a ring before, a disc after, both over the noise
  for (const ChannelResidual& r : residuals) {
    plot::Row row{std::string(r.channel->column), {{r.before / r.floor, plot::Shape::ring, plot::Ink::sim}}, {}};
    if (!std::isnan(r.after)) row.marks.push_back({r.after / r.floor, plot::Shape::disc, plot::Ink::third});
    row.note = std::isnan(r.after) ? figure(r.before / r.floor)
                                   : fmt::format("{} to {}", figure(r.before / r.floor), figure(r.after / r.floor));
    chart.rows.push_back(std::move(row));
  }

  // the legend has discs only where there are some
  if (std::ranges::any_of(residuals, [](const ChannelResidual& r) { return !std::isnan(r.after); }))
    chart.legend.push_back({plot::Shape::disc, plot::Ink::third, fmt::format("after, on {}", measured_on(d))});

  // logarithmic from a tenth of the noise, with the noise as a guide and room for the largest
  chart.guides = {{1, "noise"}};
  chart.logarithmic = true;
  double most = 1;
  for (const ChannelResidual& r : residuals)
    most = std::max({most, r.before / r.floor, std::isnan(r.after) ? 0 : r.after / r.floor});
  chart.view = plot::Range{kLeastShown, 1.2 * most};
  chart.label_px = 140;
  chart.note_px = 130;
  chart.width_px = kWide_px;
  return to_svg(chart);
}

std::string table_of(const std::vector<ChannelResidual>& residuals) {
  Table table{{"channel", "unit", "before", "after", "noise", "before / noise", "after / noise", "share of the gap"},
              {},
              {0, 1}};
  for (const ChannelResidual& r : residuals)
    table.rows.push_back({std::string(r.channel->column), std::string(r.channel->unit), figure(r.before),
                          figure(r.after), figure(r.floor), figure(r.before / r.floor), figure(r.after / r.floor),
                          percent(r.share)});
  return to_html(table);
}

}  // namespace

std::string residual_part(const Diagnosis& d, const StageDiagnosis& stage) {
  const std::vector<ChannelResidual> residuals = channel_residuals(stage);
  if (residuals.empty()) return {};
  std::string html = "<h3>Residuals of each channel</h3>\n";
  html += paragraph(
      fmt::format("Measured minus simulated, averaged over {} s. Noise: spread of repeated runs, sensor noise and the "
                  "uncertainty of the simulation. Before: nominal. After: with the best model, fitted to other runs "
                  "than the one shown.{}",
                  d.options.span_s,
                  stage.passage == Passage::body_to_sensor
                      ? " In this stage, the residual of a gyro is its rate minus the rate of the measured angles."
                      : ""),
      "soft");
  return html + channel_figure(d, residuals) + table_of(residuals);
}

}  // namespace kenaf::gap::diagnose
