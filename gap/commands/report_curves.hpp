// The curves of a diagnosis's page as an MCAP file.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "gap/diagnose/diagnosis.hpp"

namespace kenaf::gap::commands {

// Writes the runs that the page draws, whole and with all of their columns: topics "/run-000/real/tracks",
// "/run-000/nominal/tracks" and, if an effect was fitted, "/run-000/corrected/tracks", and so for each group of
// sensors. `run-000` is the measured run's file; times are its t_s. Simulates those runs again. Throws
// recordings::RecordingError or runs::RunFileError if the file cannot be written.
void write_report_curves(const diagnose::Diagnosis& diagnosis, const std::filesystem::path& file);

}  // namespace kenaf::gap::commands
