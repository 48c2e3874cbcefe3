// The parts of the page, as HTML. A part with nothing to show says why, or is empty.
//
// Thread safety: pure functions.
#pragma once

#include <span>
#include <string>

#include "gap/diagnose/page/moments.hpp"
#include "gap/diagnose/page/overlays.hpp"

namespace kenaf::gap::diagnose {

// The first screen, with the page's headline: where the gap is, which effects cause it, how much they explain, what is
// left and what to do next.
// `runs`: those that were compared.
std::string answer_section(const Diagnosis& d, std::span<const ComparedRun> runs, std::span<const Moment> moments,
                           std::span<const Overlay> overlays);
// Everything about one stage; its parts, each with its own heading, are below.
std::string stage_section(const Diagnosis& d, std::size_t stage);
std::string residual_part(const Diagnosis& d, const StageDiagnosis& stage);
std::string ranking_part(const Diagnosis& d, const StageDiagnosis& stage);
std::string confusability_part(const Diagnosis& d, const StageDiagnosis& stage);

// `moments`: where its phases link to.
std::string where_section(const Diagnosis& d, std::span<const Overlay> overlays, std::span<const Moment> moments);
std::string overlay_section(const Diagnosis& d, std::span<const Overlay> overlays);
std::string next_section(const Diagnosis& d);
std::string used_section(const Diagnosis& d, std::span<const Overlay> overlays, std::span<const ComparedRun> runs);
std::string method_section(const Diagnosis& d);

// "stage-drive-to-body": the anchor of a stage in the page.
std::string stage_id(Passage passage);

// Orders the rows of a matrix of angles so that look-alikes are neighbours: clusters are joined by their mean angle,
// with their most similar ends adjacent.
std::vector<std::size_t> look_alikes_together(const Eigen::MatrixXd& angle_deg);

// "The corrected simulation is farther than the nominal one from run-000.csv (step-100): ...", of each run that the
// correction worsens, worst first; at most as many as a page has room for.
std::vector<std::string> worsened_in_words(const Diagnosis& d, std::span<const ComparedRun> runs);

// The whole page. `report_folder`: where it is going to be, for the commands in it; empty: not known. `runs`: those
// that were compared (compared_runs()).
std::string diagnosis_page(const Diagnosis& d, std::span<const Overlay> overlays, std::string_view report_folder,
                           std::span<const ComparedRun> runs);
// The same with the runs of the overlays alone.
std::string diagnosis_page(const Diagnosis& d, std::span<const Overlay> overlays, std::string_view report_folder = {});

}  // namespace kenaf::gap::diagnose
