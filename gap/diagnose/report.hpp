// What a diagnosis is told by: one screen of text, report.json (docs/gap-report.md), report.html, and the robot with
// what was found.
//
// Thread safety: pure functions, but for write_diagnosis().
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "gap/diagnose/diagnosis.hpp"

namespace kenaf::gap::diagnose {

// At most 40 lines of about 100 columns, unless names are long; the first one is the verdict.
std::string diagnosis_text(const Diagnosis& diagnosis);
// Of the format kenaf-gap-report/2.
std::string diagnosis_json(const Diagnosis& diagnosis);
// A page without scripts or anything that is not in it.
std::string diagnosis_html(const Diagnosis& diagnosis);

// The nominal description with corrections() in it, and in comments at its top what it does not contain. Comments of
// the description stay as far as robot_toml_with() keeps them.
struct RobotFile {
  std::string name;  // "robot.toml" where an effect is named, else "robot.candidate.toml"; empty: there is none
  std::string text;
  std::string fault;  // why there is none although there are corrections: together they make no robot
};
RobotFile robot_file(const Diagnosis& diagnosis);

// Throw std::runtime_error in words where reports in `out` would replace what they are about, that is a dataset or the
// description `robot` (empty: the dataset's), or a robot's file that no diagnosis wrote. For asking before something
// long is calculated.
void check_is_other_folder(const std::filesystem::path& out, const std::filesystem::path& dataset);
void check_keeps_inputs(const std::filesystem::path& out, const std::filesystem::path& dataset,
                        const std::string& robot);

// Writes report.json, report.html and the robot's file, if any, into `folder`, each whole or not at all; returns where
// the page is. Robots' files of a diagnosis before are removed where this one does not write them. Where this one was
// interrupted, they stay, and so do reports of a complete one: then these are report.partial.json and
// report.partial.html. Throws std::runtime_error where that cannot be done.
std::filesystem::path write_diagnosis(const Diagnosis& diagnosis, const std::filesystem::path& folder);

}  // namespace kenaf::gap::diagnose
