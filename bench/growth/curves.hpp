// The curves of `cost_growth`, each in a table's row once it is measured.
//
// Thread safety: each function by itself; they measure time, so one at a time.
#pragma once

#include <filesystem>

#include "bench/growth/growth.hpp"

namespace kenaf::bench {

// A step of the physics and a reading of a range scanner, in the thread's own time.
Growth over_contacts();
Growth over_robots();
Growth over_triangles_of_larger_ground();
Growth over_triangles_of_finer_ground();
Growth over_rays();

// A diagnosis by the programs in `bin`, in the processors' time; over cores and ranks in seconds of the wall clock.
// Throws std::runtime_error if a program fails.
Growth over_effects(const std::filesystem::path& bin);
Growth over_runs(const std::filesystem::path& bin);
Growth over_cores(const std::filesystem::path& bin);
Growth over_ranks(const std::filesystem::path& bin);

}  // namespace kenaf::bench
