#include <fmt/format.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "formats/description/data_files.hpp"
#include "formats/runs/dataset.hpp"
#include "formats/runs/whole_file.hpp"
#include "gap/diagnose/page/sections.hpp"
#include "gap/diagnose/report.hpp"

namespace kenaf::gap::diagnose {

namespace fs = std::filesystem;

namespace {

constexpr const char *kPage = "report.html", *kReport = "report.json";
constexpr const char* kRobotFiles[] = {"robot.toml", "robot.candidate.toml"};
// Reports of an interrupted diagnosis in a folder with those of a finished one.
constexpr const char *kPartialPage = "report.partial.html", *kPartialReport = "report.partial.json";

bool has_finished_report(const fs::path& folder) {
  if (!fs::exists(folder / kReport)) return false;
  const auto report = nlohmann::json::parse(runs::read_whole_file(folder / kReport), nullptr, false);
  return report.is_object() && report.contains("verdict") && !report.contains("interrupted");
}

bool same(const fs::path& a, const fs::path& b) {
  std::error_code neither_is_there;
  return fs::equivalent(a, b, neither_is_there);
}

void check_is_other_folder(const fs::path& out, const fs::path& dataset) {
  if (same(out, dataset))
    throw std::runtime_error(
        fmt::format("{}: is the folder of the dataset; give another folder for the reports", out.string()));
}

}  // namespace

void check_keeps_inputs(const fs::path& out, const fs::path& dataset, const DiagnosisOptions& options) {
  check_is_other_folder(out, dataset);
  if (!options.against.empty()) check_is_other_folder(out, options.against);
  const bool has_report = fs::exists(out / kPage) || fs::exists(out / kReport);
  for (const char* robot_file : kRobotFiles) {
    const fs::path replaced = out / robot_file;
    if (!fs::exists(replaced)) continue;
    const std::string name = options.robot.empty()
                                 ? runs::resolve_beside(dataset, runs::read_dataset(dataset).robot, ".toml")
                                 : options.robot;
    if (same(replaced, description::find_data_file("robots", name, ".toml")))
      throw std::runtime_error(fmt::format(
          "{}: is the description to diagnose, which the report would replace; give another folder for the reports",
          replaced.string()));
    if (!has_report)
      throw std::runtime_error(
          fmt::format("{}: does not come from a diagnosis (there is no report in its folder) and would be replaced; "
                      "give another folder for the reports",
                      replaced.string()));
  }
}

Reports reports_of(const Diagnosis& d, const fs::path& folder) {
  const std::vector<Overlay> overlays = simulate_overlays(d);
  const std::vector<ComparedRun> compared = compared_runs(d, overlays);
  return {diagnosis_json(d, compared), diagnosis_page(d, overlays, folder.string(), compared), robot_file(d)};
}

fs::path write_diagnosis(const Diagnosis& d, const Reports& reports, const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw std::runtime_error(fmt::format("{}: cannot be created: {}", folder.string(), error.message()));
  if (!d.interrupted.empty() && has_finished_report(folder)) {
    runs::write_whole_file(folder / kPartialPage, reports.page);
    runs::write_whole_file(folder / kPartialReport, reports.json);
    return folder / kPartialPage;
  }
  const bool was_of_a_diagnosis = fs::exists(folder / kReport);
  runs::write_whole_file(folder / kPage, reports.page);
  const RobotFile& robot = reports.robot;
  if (!robot.name.empty()) runs::write_whole_file(folder / robot.name, robot.text);
  for (const char* other : kRobotFiles)  // of an earlier diagnosis, which would contradict this one
    if (d.interrupted.empty() && other != robot.name) fs::remove(folder / other, error);
  if (d.interrupted.empty() && was_of_a_diagnosis) fs::remove(folder / kCurvesFile, error);
  runs::write_whole_file(folder / kReport, reports.json);
  for (const char* partial : {kPartialPage, kPartialReport}) fs::remove(folder / partial, error);
  return folder / kPage;
}

fs::path write_diagnosis(const Diagnosis& d, const fs::path& folder) {
  return write_diagnosis(d, reports_of(d, folder), folder);
}

}  // namespace kenaf::gap::diagnose
