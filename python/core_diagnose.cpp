// The diagnosis of a gap between simulation and recorded runs.
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <filesystem>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include "gap/datasets/dataset_files.hpp"
#include "gap/diagnose/report.hpp"
#include "python/core.hpp"
#include "python/interruptible.hpp"

namespace kenaf::python {
namespace py = pybind11;
namespace fs = std::filesystem;
namespace {

using gap::diagnose::Diagnosis;
using gap::diagnose::DiagnosisOptions;

// What the diagnosis is doing, handed from its thread to Python's.
class Doing {
 public:
  void set(const gap::diagnose::Progress& progress) {
    const std::lock_guard lock(mutex_);
    now_ = {std::string(progress.doing), progress.done};
  }
  std::pair<std::string, double> now() const {
    const std::lock_guard lock(mutex_);
    return now_;
  }

 private:
  mutable std::mutex mutex_;
  std::pair<std::string, double> now_{"", 0};
};

DiagnosisOptions options_of(const py::dict& asked) {
  DiagnosisOptions options;
  options.robot = asked["robot"].cast<std::string>();
  options.world = asked["world"].cast<std::string>();
  options.against = asked["against"].cast<fs::path>();
  options.effects = asked["effects"].cast<fs::path>();
  options.without = asked["without"].cast<std::vector<std::string>>();
  options.most_runs = asked["most_runs"].cast<std::size_t>();
  options.refused_runs.unchecked = asked["unchecked"].cast<bool>();
  options.refused_runs.strict = asked["strict"].cast<bool>();
  options.propose_next = asked["propose_next"].cast<bool>();
  options.jobs = asked["jobs"].cast<unsigned>();
  options.seed = asked["seed"].cast<std::uint64_t>();
  return options;
}

// `asked`: the arguments of kenaf.diagnose(). `progress`: None or a function of what is done and of the share done.
// Returns report.json, the text of the terminal, the page, and the robot's file ("" if there is none).
py::tuple diagnose(const fs::path& folder, const py::dict& asked, const fs::path& out, const py::object& progress) {
  DiagnosisOptions options = options_of(asked);
  if (!out.empty()) {  // before anything long starts
    gap::datasets::check_can_write(out);
    gap::diagnose::check_keeps_inputs(out, folder, options);
  }

  Doing doing;
  options.progress = [&doing](const gap::diagnose::Progress& now) { doing.set(now); };
  std::optional<Diagnosis> diagnosis;
  gap::diagnose::Reports reports;
  run_interruptibly(
      [&](const std::atomic<bool>& stop) {
        options.stop = &stop;
        diagnosis = gap::diagnose::diagnose_dataset(folder, options);
        reports = gap::diagnose::reports_of(*diagnosis, out);
        if (!out.empty()) gap::diagnose::write_diagnosis(*diagnosis, reports, out);
      },
      [&] {
        if (progress.is_none()) return;
        const auto [words, done] = doing.now();
        progress(words, done);
      });
  return py::make_tuple(reports.json, gap::diagnose::diagnosis_text(*diagnosis), reports.page, reports.robot.text);
}

}  // namespace

void add_diagnose(py::module_& module) {
  module.def("diagnose", &diagnose);
}

}  // namespace kenaf::python
