// A `kenaf-runs/1` dataset: a folder with `dataset.toml` and one CSV file per run. docs/run-format.md describes it.
//
// Thread safety: values and pure functions.
#pragma once

#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "formats/runs/run_file.hpp"

namespace kenaf::runs {

struct DatasetRun {
  std::string file;       // relative to the folder
  std::string manoeuvre;  // runs that share it repeat one manoeuvre
  std::string world;      // as Dataset::world; empty: the dataset's
  std::string fault{};    // why a simulated run ended early: its simulation went wrong; empty: it did not
};

struct Dataset {
  std::string source;  // "real" or "sim"
  std::string robot;   // a shipped name, or a TOML file beside dataset.toml
  std::string world;   // a shipped name, or an SDF file beside dataset.toml
  std::string description;
  std::map<std::string, double> noise;  // 1 sigma by column, in its unit; a column that is missing is not known
  std::vector<DatasetRun> runs;
};

// Reads `folder`/dataset.toml. Keys it does not know are ignored. Throws RunFileError with file, line and column: no
// such file, no TOML, another format, a required key missing or of another type, a noise that is no positive number, no
// run, a run named twice or outside of the folder.
Dataset read_dataset(const std::filesystem::path& folder);
Dataset parse_dataset(std::string_view toml_text, std::string_view name_for_errors);

// Writes `folder`/dataset.toml, whole or not at all; makes the folder where it is missing. Throws RunFileError.
void write_dataset(const std::filesystem::path& folder, const Dataset& dataset);

// Adds runs at the end of `folder`/dataset.toml, whose text stays as it is. Throws RunFileError: the file is not there,
// or could not be read back with them, as its runs stand in another form than [[run]] or one is there already.
void append_runs(const std::filesystem::path& folder, std::span<const DatasetRun> runs);

// `name` as a loader takes it: a file beside dataset.toml becomes its path, a shipped name stays as it is.
std::string resolve_beside(const std::filesystem::path& folder, const std::string& name, std::string_view extension);

}  // namespace kenaf::runs
