// The residual of the best model, in words and pictures: a separate part of the page.
//
// Thread safety: pure functions.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "gap/diagnose/left_over.hpp"

namespace kenaf::gap::diagnose {

// One <svg> element for the style sheet of gap/plot/chart.hpp: the residual over the quantity it depends on, one dot
// per span of time, with the fitted line.
std::string left_over_plot(const Dependence& dependence);

// HTML with its heading: how much is left (`how_much`, a sentence without a full stop, or empty), each dependence as a
// sentence with what to look at, and plots of the largest. Without any it states that the residual depends on nothing
// that was measured.
std::string left_over_section(std::span<const Dependence> left_over, std::string_view how_much = {});

}  // namespace kenaf::gap::diagnose
