// The moments that the page shows in 3D: the worst moment of all (run_gap.hpp), and the worst ones in the phases with
// most of the gap.
//
// Thread safety: pure functions.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "gap/diagnose/page/overlays.hpp"
#include "gap/diagnose/run_gap.hpp"

namespace kenaf::gap::diagnose {

inline constexpr double kPicture_s = 0.04;  // between pictures: 25 a second

struct RobotPose {
  Eigen::Vector3d p_WB_m;
  Eigen::Vector3d angles_rad;          // roll, pitch, yaw; continuous over time
  std::array<double, 4> flippers_rad;  // front left, front right, rear left, rear right; 0 if there are none
};

struct MomentBody {
  std::string_view kind;                        // "real", "nominal", "corrected"
  std::vector<std::optional<RobotPose>> poses;  // at each of Moment::times_s, where it is known
};

struct Moment {
  std::size_t stage;                 // index into Diagnosis::stages
  std::optional<std::size_t> phase;  // index into its where.phases; none: no phase with a part of the gap
  std::size_t overlay;               // index into the overlays
  std::size_t group;                 // of repeats, the overlay's
  double at_s;
  RunMoment gap;                   // how far the nominal simulation is from the run then
  bool is_worst_of_run;            // no other moment of this run is worse
  std::vector<double> times_s;     // every kPicture_s, of a few seconds around it, within the run
  std::vector<MomentBody> bodies;  // the real one first
  std::size_t now;                 // index into times_s of at_s, or next to it
};

// The worst moment of the drawn runs, and of each of the phases with the largest shares of the whole gap, most times
// the noise first, at most as many as a page has room for; of two phases with the same moment the one with the larger
// share. None of a run without a measured pose.
std::vector<Moment> moments_of(const Diagnosis& d, std::span<const Overlay> overlays);

// "moment-1", "run-1": anchors in the page, of a moment and of a manoeuvre's run.
std::string moment_id(std::size_t index);
std::string run_id(std::size_t group);

// The link of a phase of the gap of a stage, before or after correction: to its own moment, else to one of another
// stage within it, else to its run. Empty if the page does not draw that.
std::string link_to_phase(const Diagnosis& d, std::span<const Moment> moments, std::size_t stage,
                          const PhaseGap& phase);

// The command that shows the whole run, from that moment on: "kenaf-gap play real --report diagnosis --run run-000.csv
// --at 3.4". Words are quoted for a shell. `report_folder`: empty if it is not known.
std::string play_command(const Diagnosis& d, std::string_view file, double at_s, std::string_view report_folder);

}  // namespace kenaf::gap::diagnose
