// What is left by the best model, in words and pictures: a part of the page of its own.
//
// Thread safety: pure functions.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "gap/diagnose/left_over.hpp"

namespace kenaf::gap::diagnose {

// One <svg> element for the style sheet of gap/plot/chart.hpp: what is left over what it goes with, each span of time a
// dot, with the line that was fitted.
std::string left_over_plot(const Dependence& dependence);

// HTML with its heading: how much is left (`how_much`, a sentence without a full stop, or nothing), each dependence as
// a sentence with what to look at, and the plots of the largest. Without any it says that what is left goes with
// nothing that was measured.
std::string left_over_section(std::span<const Dependence> left_over, std::string_view how_much = {});

}  // namespace kenaf::gap::diagnose
