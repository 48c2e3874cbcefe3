#include <fmt/format.h>

#include "gap/diagnose/channels.hpp"
#include "gap/diagnose/page/figures.hpp"
#include "gap/diagnose/page/sections.hpp"
#include "gap/diagnose/page/words.hpp"
#include "gap/diagnose/report.hpp"

namespace kenaf::gap::diagnose {

std::string overlay_section(const Diagnosis& d, std::span<const Overlay> overlays) {
  std::string html = section_head("overlay", "Real, nominal and corrected runs");
  if (overlays.empty()) return html + paragraph("The diagnosis ended before any run was simulated.");

  // what the three lines of each figure are, and how many manoeuvres are shown
  const RobotFile robot = robot_file(d);
  const bool has_corrected = overlays.front().corrected.has_value();
  html += paragraph(fmt::format("One run of each manoeuvre, with the channels that hold most of its gap. Real: "
                                "measured; nominal: the robot simulated as described, with the same commands and the "
                                "same initial state; {}. Differences are averaged over {} s.",
                                !has_corrected       ? "there is no corrected robot, because no effect was fitted"
                                : robot.name.empty() ? "corrected is that robot with the best models of all stages"
                                                     : fmt::format("corrected is the robot of {}", robot.name),
                                d.options.span_s),
                    "soft");
  if (overlays.size() < d.repeats.size())
    html += paragraph(
        fmt::format("The page shows the {} of {} manoeuvres with the largest gap.", overlays.size(), d.repeats.size()),
        "soft");

  // per manoeuvre the path and the total residual, then each channel with its residual
  for (const Overlay& overlay : overlays) {
    html += fmt::format("<h3 id=\"{}\">{} <span class=\"soft\">{}, one of {}</span></h3>\n<div class=\"figures\">\n",
                        run_id(overlay.group), plot::escaped(group_title(d, overlay.group)),
                        plot::escaped(d.observations.runs[overlay.run].file), d.repeats[overlay.group].size());
    html += to_svg(path_figure(d, overlay)) + to_svg(residual_figure(d, overlay));
    for (std::size_t i = 0; i < overlay.channels.size(); ++i)
      html += to_svg(channel_figure(d, overlay, i)) + to_svg(channel_residual_figure(d, overlay, i));
    html += "</div>\n";
  }
  return html;
}

}  // namespace kenaf::gap::diagnose
