// Writes a comparison as files and as text. docs/compare.md describes the method.
//
// Thread safety: pure functions, except write_report().
#pragma once

#include <filesystem>
#include <string>

#include "gap/compare/comparison.hpp"

namespace kenaf::gap::compare {

// "matched-000.csv" for the first compared run.
std::string matched_file_name(std::size_t run);

// One row for each matched pair of frames: real_frame, sim_frame (from 0), weight (one over the number of pairs with
// that real frame), real_t_s, sim_t_s, real_x_m, real_z_m, real_pitch_rad, sim_x_m, sim_z_m, sim_pitch_rad,
// position_error_m, y_error_m, roll_error_rad, pitch_error_rad, yaw_error_rad, time_difference_s (how much later the
// simulated frame is), same_time_position_error_m, same_time_pitch_error_rad, real_y_m, real_yaw_rad, sim_y_m,
// sim_yaw_rad and same_time_yaw_error_rad. SI units, radians. Differences are simulated less real; an empty cell is
// unknown.
std::string matched_csv(const ComparedRun& run);

// Returns the comparison in the format kenaf-gap-compare/1. SI units, radians; unknown values are null. Keys:
//   format        "kenaf-gap-compare/1"
//   real, sim     of the datasets: folder, source, robot, world, description
//   options       align_start, start_s, band_s (or null)
//   all           matched and same_time over all runs
//   manoeuvres[]  manoeuvre, runs (indices of runs[]), matched, same_time
//   runs[]        manoeuvre, repeat (from 0), real and sim (files), real_world, sim_world, matched_file, plane
//   (vertical
//                 or ground, in which the paths are matched), real_frames, sim_frames, pairs, cost_m (weighted mean
//                 distance of the matching), start_offset, matched, same_time, at_end
//   left_out[]    dataset (real or sim), file, manoeuvre, why
// with
//   matched, same_time  frames: the number of real frames compared; mean, rms and max of the sizes of position_m (norm
//                       in the plane), y_m, roll_rad, pitch_rad, yaw_rad; matched also of time_difference_s
//   at_end              errors between the two last frames, simulated less real
//   start_offset        x_m, y_m, yaw_rad, by which the simulated run was moved; turned: false if y or yaw of a start
//                       was not measured
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
