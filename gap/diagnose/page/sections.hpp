// The parts of the page, as HTML. One that has nothing to show says why, or is empty.
//
// Thread safety: pure functions.
#pragma once

#include <span>
#include <string>

#include "gap/diagnose/page/overlays.hpp"

namespace kenaf::gap::diagnose {

// The first screen, with the page's headline: where the gap is, which effects cause it, how much they explain, what is
// left and what to do next.
std::string answer_section(const Diagnosis& d);
// All about one stage; parts of it, each with a heading of its own, are below.
std::string stage_section(const Diagnosis& d, std::size_t stage);
std::string residual_part(const Diagnosis& d, const StageDiagnosis& stage);
std::string ranking_part(const Diagnosis& d, const StageDiagnosis& stage);
std::string confusability_part(const Diagnosis& d, const StageDiagnosis& stage);

std::string where_section(const Diagnosis& d, std::span<const Overlay> overlays);
std::string overlay_section(const Diagnosis& d, std::span<const Overlay> overlays);
std::string next_section(const Diagnosis& d);
std::string used_section(const Diagnosis& d, std::span<const Overlay> overlays);
std::string method_section(const Diagnosis& d);

// "stage-drive-to-body": where the page has a stage.
std::string stage_id(Passage passage);

// Numbers of rows of a matrix of angles, so that look-alikes are neighbours: clusters are joined by their mean angle,
// each with its more alike end towards the other.
std::vector<std::size_t> look_alikes_together(const Eigen::MatrixXd& angle_deg);

// The whole page.
std::string diagnosis_page(const Diagnosis& d, std::span<const Overlay> overlays);

}  // namespace kenaf::gap::diagnose
