// What a diagnosis is told by: one screen of text, report.json (docs/gap-report.md), report.html, robot.toml.
// Thread safety: pure functions, but for write_diagnosis().
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "gap/diagnose/diagnosis.hpp"

namespace kenaf::gap {

std::string_view verdict_name(Verdict verdict);
// The stage at which the gap comes in: that of the named effect; otherwise the first passage, on the way from command
// to sensor, that has a gap of its own; `body` where none stands out by itself.
std::string_view gap_stage(const Diagnosis& diagnosis);
// On what gap and shrink were measured: "runs held out"; of a single run, "the run fitted to, as there is no other".
std::string_view measured_on(const Diagnosis& diagnosis);
// "pitch_inertia", or "pitch_inertia:scale" of an effect with several parameters.
std::string name_of(const EffectCurve& curve);

// Of each doubt a clause: "manoeuvres want different values (p < 0.0001)".
std::vector<std::string> doubts_in_words(const Decision& decision);

// At most 40 lines, of at most 100 columns unless names or warnings are long; the first one is the verdict.
std::string diagnosis_text(const Diagnosis& diagnosis);
// Of the format kenaf-gap-report/1.
std::string diagnosis_json(const Diagnosis& diagnosis);
// A page without scripts or anything that is not in it.
std::string diagnosis_html(const Diagnosis& diagnosis);
// The nominal description, with the effects of the best model switched on. Comments stay, but for a description that
// has one of these effects already.
std::string corrected_robot_toml(const Diagnosis& diagnosis, const std::string& robot_name_or_path);

// Throws std::runtime_error in words where reports in `out` would replace what they are about, that is the dataset or the
// description `robot` (empty: the dataset's), or a robot.toml that no diagnosis wrote. For asking before something long is
// calculated.
void check_keeps_inputs(const std::filesystem::path& out, const std::filesystem::path& dataset, const std::string& robot);

// Writes report.json, report.html and, where an effect was named, robot.toml into `folder`, each whole or not at all; returns
// where the page is. A robot.toml of a diagnosis before is removed where nothing is named. Where this one was interrupted, it
// stays, and so do reports of a complete one: then these are report.partial.json and report.partial.html.
// Throws std::runtime_error where that cannot be done.
std::filesystem::path write_diagnosis(const Diagnosis& diagnosis, const std::filesystem::path& folder);

}  // namespace kenaf::gap
