// The parts of the page, each as HTML with its heading. One that has nothing to show says why, or is empty.
// Thread safety: pure functions.
#pragma once

#include <span>
#include <string>

#include "gap/diagnose/page/overlays.hpp"

namespace kenaf::gap {

std::string verdict_section(const Diagnosis& d);  // with the page's headline
std::string overlay_section(const Diagnosis& d, std::span<const Overlay> overlays);
std::string residual_section(const Diagnosis& d);
std::string where_section(const Diagnosis& d, std::span<const Overlay> overlays);
std::string ranking_section(const Diagnosis& d);
std::string confusability_section(const Diagnosis& d);
std::string next_section(const Diagnosis& d);
std::string used_section(const Diagnosis& d, std::span<const Overlay> overlays);
std::string method_section(const Diagnosis& d);

// Curves' places in Isolability, so that look-alikes are neighbours: clusters are joined by their mean angle, each with
// its more alike end towards the other.
std::vector<std::size_t> look_alikes_together(const Eigen::MatrixXd& angle_deg);

// The whole page.
std::string diagnosis_page(const Diagnosis& d, std::span<const Overlay> overlays);

}  // namespace kenaf::gap
