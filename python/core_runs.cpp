// Recorded runs and datasets.
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <filesystem>
#include <map>
#include <string>

#include "formats/runs/dataset.hpp"
#include "formats/runs/run_file.hpp"
#include "gap/datasets/dataset_files.hpp"
#include "python/core.hpp"
#include "python/run_arrays.hpp"

namespace kenaf::python {
namespace py = pybind11;
namespace fs = std::filesystem;
namespace {

runs::Run read_run_without_gil(const fs::path& file) {
  const py::gil_scoped_release others_may_run;
  return runs::read_run(file);
}

py::tuple read_run(const fs::path& file) {
  runs::Run run = read_run_without_gil(file);
  const py::str reading(run.reading);
  return py::make_tuple(arrays_of(std::move(run)), reading);
}

// Names of files beside dataset.toml become paths, so that they hold anywhere.
py::dict read_dataset(const fs::path& folder) {
  const runs::Dataset dataset = runs::read_dataset(folder);
  const auto world_path = [&](const std::string& name) { return runs::resolve_beside(folder, name, ".sdf"); };
  py::list all;
  for (const runs::DatasetRun& run : dataset.runs) {
    py::dict entry;
    entry["file"] = run.file;
    entry["manoeuvre"] = run.manoeuvre;
    entry["world"] = world_path(run.world.empty() ? dataset.world : run.world);
    entry["fault"] = run.fault;
    entry["columns"] = arrays_of(read_run_without_gil(folder / run.file));
    all.append(entry);
  }
  py::dict result;
  result["source"] = dataset.source;
  result["robot"] = runs::resolve_beside(folder, dataset.robot, ".toml");
  result["world"] = world_path(dataset.world);
  result["description"] = dataset.description;
  result["noise"] = dataset.noise;
  result["runs"] = all;
  return result;
}

void write_run(const fs::path& file, const py::dict& columns) {
  runs::write_run(file, run_of(columns));
}

// `dataset` as read_dataset() returns it; files of runs get new names.
void write_dataset(const fs::path& folder, const py::dict& dataset, bool force) {
  const auto text = [](const py::handle& of, const char* key) { return of[key].cast<std::string>(); };
  gap::datasets::PartFolder part(folder, force, ", or force=True to write into it");
  gap::datasets::Descriptions robots(part.path(), ".toml"), worlds(part.path(), ".sdf");
  runs::Dataset written{.source = text(dataset, "source"),
                        .robot = robots.add(text(dataset, "robot")),
                        .world = worlds.add(text(dataset, "world")),
                        .description = text(dataset, "description"),
                        .noise = dataset["noise"].cast<std::map<std::string, double>>(),
                        .runs = {}};
  for (const py::handle entry : dataset["runs"]) {
    const std::string file = runs::numbered_run_file(written.runs.size());
    const std::string world = worlds.add(text(entry, "world"));
    runs::write_run(part.path() / file, run_of(entry["columns"]));
    written.runs.push_back(
        {file, text(entry, "manoeuvre"), world == written.world ? std::string() : world, text(entry, "fault")});
  }
  runs::write_dataset(part.path(), written);
  part.finish();
}

}  // namespace

void add_runs(py::module_& module) {
  module.def("read_run", &read_run);
  module.def("read_dataset", &read_dataset);
  module.def("write_run", &write_run);
  module.def("write_dataset", &write_dataset);
}

}  // namespace kenaf::python
