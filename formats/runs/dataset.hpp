// A `kenaf-runs/1` dataset: a folder with `dataset.toml` and one CSV file per run. docs/logs.md describes it.
//
// Thread safety: values and pure functions.
#pragma once

#include <cstddef>
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
  std::string fault{};    // why a simulated run ended early, if the simulation failed; else empty
};

struct Dataset {
  std::string source;  // "real" or "sim"
  std::string robot;   // a shipped name, or a TOML file beside dataset.toml
  std::string world;   // a shipped name, or an SDF file beside dataset.toml
  std::string description;
  std::map<std::string, double> noise;  // 1 sigma by column, in its unit; unknown for missing columns
  std::vector<DatasetRun> runs;
};

// The file of a dataset's run number `index`, from 0: "run-007.csv".
std::string numbered_run_file(std::size_t index);

// The folder of a dataset that is named by its dataset.toml; any other path stays as it is.
std::filesystem::path folder_of_dataset(const std::filesystem::path& path);

// Reads `folder`/dataset.toml. Unknown keys are ignored. Throws RunFileError with file, line and column if the file is
// missing, is no TOML or has another format, or `folder` is a file, a required key is missing or of another type, a
// noise is no positive number, or there is no run, a run named twice or one outside of the folder.
Dataset read_dataset(const std::filesystem::path& folder);
Dataset parse_dataset(std::string_view toml_text, std::string_view name_for_errors);

// Writes `folder`/dataset.toml atomically and creates the folder if it is missing. Throws RunFileError.
void write_dataset(const std::filesystem::path& folder, const Dataset& dataset);

// Appends runs to `folder`/dataset.toml, whose text stays as it is. Throws RunFileError if the file is missing or could
// not be read back with them: its runs are not written as [[run]], or one is there already.
void append_runs(const std::filesystem::path& folder, std::span<const DatasetRun> runs);

// Returns `name` as a loader takes it: a file beside dataset.toml becomes its path, a shipped name stays as it is.
std::string resolve_beside(const std::filesystem::path& folder, const std::string& name, std::string_view extension);

}  // namespace kenaf::runs
