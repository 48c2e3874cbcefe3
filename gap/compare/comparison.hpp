// Compares two datasets run by run.
//
// Thread safety: values and a function without state.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "formats/runs/dataset.hpp"
#include "gap/compare/dp_matching.hpp"
#include "gap/compare/frame_errors.hpp"
#include "gap/compare/pose_frames.hpp"

namespace kenaf::gap::compare {

struct CompareOptions {
  bool align_start = true;       // move each simulated run to the start of its real one
  double start_s = 0;            // the start is the mean over this time; 0: the first frame
  std::optional<double> band_s;  // how far matched frames may be from an even course of time, in simulated time
};

struct ComparedRun {
  std::string manoeuvre;              // empty: the datasets name none
  std::size_t repeat;                 // of the manoeuvre, from 0
  std::string real_file, sim_file;    // as the datasets name them
  std::string real_world, sim_world;  // names or paths as load_world() takes them
  Plane plane;                        // in which the paths are matched
  std::vector<PoseFrame> real, sim;   // sim as aligned
  StartOffset start_offset;           // offset by which sim was moved; zero without CompareOptions::align_start
  Matching matching;
  RunErrors errors;
};

struct LeftOut {
  std::string dataset;  // "real" or "sim"
  std::string file, manoeuvre;
  std::string why;  // in words
};

struct Comparison {
  std::filesystem::path real_folder, sim_folder;
  runs::Dataset real, sim;
  CompareOptions options;
  std::vector<ComparedRun> runs;  // at least one, in the order of the real dataset
  std::vector<LeftOut> left_out;
};

// Throws runs::RunFileError with file, line and column if a dataset or one of its runs is invalid; std::runtime_error
// if nothing is left to compare or a run is too long to be matched without a band.
Comparison compare_datasets(const std::filesystem::path& real_folder, const std::filesystem::path& sim_folder,
                            const CompareOptions& options);

// The errors over all runs of one manoeuvre; every real frame counts once.
struct ManoeuvreErrors {
  std::string manoeuvre;
  std::vector<std::size_t> runs;  // indices in Comparison::runs
  ErrorSummary matched, same_time;
};

// Returns the manoeuvres in the order in which they first occur.
std::vector<ManoeuvreErrors> by_manoeuvre(const Comparison& comparison);

// Returns the errors over all runs.
ManoeuvreErrors over_all(const Comparison& comparison);

}  // namespace kenaf::gap::compare
