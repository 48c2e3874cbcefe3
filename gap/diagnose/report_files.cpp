#include <fmt/format.h>

#include <filesystem>

#include "gap/diagnose/report.hpp"
#include "runs/whole_file.hpp"

namespace kenaf::gap {

void write_diagnosis(const Diagnosis& d, const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw std::runtime_error(fmt::format("{}: cannot be made: {}", folder.string(), error.message()));
  runs::write_whole_file(folder / "report.html", diagnosis_html(d));
  const std::filesystem::path robot = folder / "robot.toml";
  const Verdict verdict = d.decision.verdict;
  if (verdict == Verdict::named || verdict == Verdict::ambiguous)
    runs::write_whole_file(robot, corrected_robot_toml(d, d.observations.robot_name));
  else
    std::filesystem::remove(robot, error);  // of a diagnosis before, which it would belie
  runs::write_whole_file(folder / "report.json", diagnosis_json(d));
}

}  // namespace kenaf::gap
