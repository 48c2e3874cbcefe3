// Writes a comparison as files and as text. docs/compare.md describes them.
//
// Thread safety: pure functions, except write_report().
#pragma once

#include <filesystem>
#include <string>

#include "gap/compare/comparison.hpp"

namespace kenaf::gap::compare {

// "matched-000.csv" for the first compared run.
std::string matched_file_name(std::size_t run);

// One row for each matched pair of frames.
std::string matched_csv(const ComparedRun& run);

// Returns the comparison in the format kenaf-gap-compare/1. Unknown values are null.
std::string comparison_json(const Comparison& comparison);

// Returns one page that needs no other file and no network. Loads the worlds of the real runs to draw the ground; the
// page names a world that does not load.
std::string comparison_html(const Comparison& comparison);

// For the terminal: at most about one screen.
std::string comparison_text(const Comparison& comparison);

// Writes all files into `folder`, creating it if missing. compare.json comes last, so that the files it lists are
// complete. Throws runs::RunFileError.
void write_report(const Comparison& comparison, const std::filesystem::path& folder);

}  // namespace kenaf::gap::compare
