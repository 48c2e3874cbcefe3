#include "gap/logs/plausibility.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "gap/logs/body_heading.hpp"
#include "gap/logs/lifted_robot.hpp"
#include "gap/logs/other_forms.hpp"
#include "gap/logs/run_checks.hpp"
#include "gap/logs/unknown_columns.hpp"

namespace kenaf::gap::logs {

std::string in_words(const Finding& finding) {
  std::string words = finding.file;
  if (finding.line > 0) words += fmt::format(":{}", finding.line);
  if (!finding.column.empty()) words += ": " + finding.column;
  return words + ": " + finding.text;
}

bool any_refused(std::span<const Finding> findings) {
  return std::ranges::find(findings, Finding::Severity::refuse, &Finding::severity) != findings.end();
}

bool RefusedRuns::too_many(std::size_t refused, std::size_t all) const {
  constexpr std::size_t kOneIn = 10;
  return !unchecked && refused > 0 && (strict || refused * kOneIn > all);
}

void HeldInRuns::take_off(std::vector<Finding>& found) {
  for (const Finding& finding : found) {
    if (finding.severity != Finding::Severity::held) continue;
    const auto known = std::ranges::find(columns_, finding.column, [](const OfColumn& of) { return of.first.column; });
    if (known == columns_.end())
      columns_.push_back({finding, 1});
    else
      ++known->runs;
  }
  std::erase_if(found, [](const Finding& finding) { return finding.severity == Finding::Severity::held; });
}

std::vector<Finding> HeldInRuns::findings() const {
  std::vector<Finding> findings;
  for (const OfColumn& of : columns_) {
    findings.push_back(of.first);
    if (of.runs > 1) findings.back().text += fmt::format(" (as in {} more)", of.runs - 1);
  }
  return findings;
}

std::optional<runs::Run> read_or_refuse(const std::filesystem::path& path, const std::string& file,
                                        std::vector<Finding>& findings) {
  try {
    return runs::read_run(path);
  } catch (const runs::RunFileError& error) {
    findings.push_back({Finding::Severity::refuse, file, 0, "", fmt::format("cannot be read: {}", error.what())});
    return std::nullopt;
  }
}

std::vector<Finding> check_run(const runs::Run& run, const std::string& file, const physics::RobotDescription* robot) {
  constexpr std::size_t kFewestRows = 10;
  if (run.row_count() < kFewestRows)
    return {{Finding::Severity::refuse, file, 0, "",
             fmt::format("has {} rows; a run needs at least {}", run.row_count(), kFewestRows)}};
  RunChecks checks(run, file, robot);
  checks.check_clock();
  std::vector<Finding> findings = checks.take();
  if (any_refused(findings)) return findings;  // with false times all rates are false
  checks.check_wraps();
  checks.check_ranges();
  checks.check_scales();
  checks.check_factors();
  checks.check_commands();
  checks.check_constants();
  checks.check_held();
  checks.check_pose();
  checks.check_drift();
  checks.check_replay();
  std::ranges::move(checks.take(), std::back_inserter(findings));
  return findings;
}

std::vector<Finding> check_units(const runs::Run& run, const std::string& file) {
  RunChecks checks(run, file, nullptr);
  checks.check_clock();
  if (std::vector<Finding> of_clock = checks.take(); any_refused(of_clock)) return of_clock;
  checks.check_ranges();
  checks.check_scales();
  return checks.take();
}

std::vector<Finding> check_noise(const runs::Dataset& dataset,
                                 std::span<const std::vector<std::string>> columns_of_runs) {
  std::set<std::string> known;
  for (const auto& columns : columns_of_runs) known.insert(columns.begin(), columns.end());
  std::vector<Finding> findings;
  for (const auto& [name, sigma] : dataset.noise)
    if (!known.contains(name))
      findings.push_back({Finding::Severity::warn, "dataset.toml", 0, name,
                          "has a [noise], but no run has such a column; is its name right?"});
  return findings;
}

std::vector<Finding> check_plausibility(const runs::Dataset& dataset, std::span<const runs::Run> runs,
                                        const physics::RobotDescription* robot) {
  // Each run by itself; then the findings that concern all runs.
  std::vector<std::vector<std::string>> columns;
  std::vector<Finding> findings;
  HeldInRuns held;
  LiftedRobot lifted;
  BodyHeading heading;
  OtherForms forms;
  UnknownColumns unknown;
  for (std::size_t i = 0; i < std::min(runs.size(), dataset.runs.size()); ++i) {
    columns.push_back(runs[i].columns);
    forms.look_at(runs[i], dataset.runs[i].file);
    unknown.look_at(runs[i], dataset.runs[i].file);
    if (!dataset.runs[i].fault.empty()) continue;
    std::vector<Finding> found = check_run(runs[i], dataset.runs[i].file, robot);
    held.take_off(found);
    if (!any_refused(found)) heading.look_at(runs[i]);
    std::ranges::move(found, std::back_inserter(findings));
    if (robot != nullptr) lifted.look_at(runs[i], robot->track_gauge_m());
  }
  std::ranges::move(forms.findings(), std::back_inserter(findings));
  std::ranges::move(unknown.findings(), std::back_inserter(findings));
  std::ranges::move(held.findings(), std::back_inserter(findings));
  std::ranges::move(heading.findings(), std::back_inserter(findings));
  if (const auto finding = lifted.finding()) findings.push_back(*finding);
  std::ranges::move(check_noise(dataset, columns), std::back_inserter(findings));
  return findings;
}

}  // namespace kenaf::gap::logs
