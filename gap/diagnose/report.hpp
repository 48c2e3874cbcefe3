// The reports of a diagnosis: one screen of text, report.json (docs/gap-report.md), report.html, and the corrected
// robot description.
//
// Thread safety: pure functions, except reports_of(), which runs the simulator, and write_diagnosis().
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "gap/diagnose/diagnosis.hpp"
#include "gap/diagnose/run_gap.hpp"

namespace kenaf::gap::diagnose {

// At most 40 lines of about 100 columns, unless names are long; the first line is the verdict.
std::string diagnosis_text(const Diagnosis& diagnosis);
// In the format kenaf-gap-report/2. `runs`: all that were compared (compared_runs()).
std::string diagnosis_json(const Diagnosis& diagnosis, std::span<const ComparedRun> runs);

// The runs that the page draws, one of each manoeuvre, whole and with all their columns. Simulates them.
struct ShownRun {
  std::string file;  // of the measured run, in its dataset
  runs::Run real, nominal;
  std::optional<runs::Run> corrected;  // if an effect was fitted
};
std::vector<ShownRun> shown_runs(const Diagnosis& diagnosis);

// The nominal description with corrections(), preceded by comments on what it does not contain. Comments of the
// description stay as far as robot_toml_with() keeps them.
struct RobotFile {
  std::string name;  // "robot.toml" if an effect is named, else "robot.candidate.toml"; empty: no file
  std::string text;
  std::string fault;  // why there is no file in spite of corrections: together they make an invalid robot
};
RobotFile robot_file(const Diagnosis& diagnosis);

// `page`: one self-contained file.
struct Reports {
  std::string json, page;
  RobotFile robot;
};
// Simulates the runs that they describe. `folder`: where they are going to be, for the page's commands; empty: unknown.
Reports reports_of(const Diagnosis& diagnosis, const std::filesystem::path& folder);

// The runs of the page, which the caller may write beside the reports.
inline constexpr const char* kCurvesFile = "curves.mcap";

// Throws std::runtime_error if reports in `out` would overwrite their inputs, i.e. a dataset or the description, or a
// robot file that no diagnosis wrote. Call this before long calculations.
void check_keeps_inputs(const std::filesystem::path& out, const std::filesystem::path& dataset,
                        const DiagnosisOptions& options);

// Writes report.json, report.html and the robot's file, if any, atomically into `folder`; returns the path of the page.
// `reports`: of the diagnosis, for this folder.
// Removes robot files and curves (kCurvesFile) of an earlier diagnosis that this one does not write. If this one was
// interrupted, keeps them and the reports of a finished one: then writes report.partial.json and report.partial.html.
// Throws std::runtime_error on failure.
std::filesystem::path write_diagnosis(const Diagnosis& diagnosis, const Reports& reports,
                                      const std::filesystem::path& folder);
// The same with reports_of() the diagnosis.
std::filesystem::path write_diagnosis(const Diagnosis& diagnosis, const std::filesystem::path& folder);

}  // namespace kenaf::gap::diagnose
