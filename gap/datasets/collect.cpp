#include "gap/datasets/collect.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <set>
#include <stdexcept>
#include <system_error>

#include "formats/runs/whole_file.hpp"
#include "gap/datasets/dataset_files.hpp"
#include "gap/logs/body_heading.hpp"
#include "gap/logs/other_forms.hpp"
#include "gap/logs/unknown_columns.hpp"
#include "gap/logs/wrapped_travel.hpp"
#include "physics/world_description.hpp"
#include "rollout/manoeuvre.hpp"

namespace kenaf::gap::datasets {
namespace {

namespace fs = std::filesystem;

constexpr const char* kUnfinished = ".part";  // suffix of an incomplete copy

// "run.csv", or "run-2.csv" if that is taken in the folder or among `names`.
std::string free_name(const fs::path& file, const fs::path& folder, std::set<std::string>& names) {
  std::string name = file.filename().string();
  for (int k = 2; names.contains(name) || fs::exists(folder / name) || fs::exists(folder / (name + kUnfinished)); ++k)
    name = fmt::format("{}-{}{}", file.stem().string(), k, file.extension().string());
  names.insert(name);
  return name;
}

std::string world_of(const CollectRequest& request, const RecordedRun& run,
                     const std::vector<rollout::Manoeuvre>& shipped, const std::optional<runs::Dataset>& there) {
  if (!request.world.empty()) return request.world;
  const auto found = std::ranges::find(shipped, run.manoeuvre, &rollout::Manoeuvre::name);
  if (found != shipped.end()) return found->world;
  if (there) return there->world;
  throw std::invalid_argument(
      fmt::format("{}: its world is unknown, because there is no shipped manoeuvre '{}'; give --world",
                  run.file.string(), run.manoeuvre));
}

// Whether the requested robot is that of the dataset: by the dataset's name of it, or by a path to the same
// description. An existing file of that name is compared, as it may have changed since it was copied.
bool is_robot_of(const runs::Dataset& dataset, const CollectRequest& request) {
  const fs::path asked = request.robot;
  const bool is_path = asked.extension() == ".toml";
  if (request.robot == dataset.robot && !(is_path && fs::exists(asked))) return true;
  return is_path && asked.filename() == dataset.robot &&
         runs::read_whole_file(asked) == runs::read_whole_file(request.out / dataset.robot);
}

// Copies of files that are removed again unless they are kept.
class Copies {
 public:
  ~Copies() {
    std::error_code ignored;
    for (const fs::path& file : files_) fs::remove(file, ignored);
  }
  void add(const fs::path& from, const fs::path& to) {
    const fs::path part = to.string() + kUnfinished;
    files_.insert(part);
    files_.insert(to);  // free_name() found none there
    std::error_code error;
    fs::copy_file(from, part, fs::copy_options::overwrite_existing, error);
    if (!error) fs::rename(part, to, error);
    if (error)
      throw std::runtime_error(
          fmt::format("{}: cannot be copied from {}: {}", to.string(), from.string(), error.message()));
    files_.erase(part);
  }
  void add(const runs::Run& run, const fs::path& to) {
    files_.insert(to.string() + kUnfinished);
    files_.insert(to);
    runs::write_run(to, run);
    files_.erase(to.string() + kUnfinished);
  }
  void add(const std::vector<fs::path>& made) { files_.insert(made.begin(), made.end()); }
  void keep() { files_.clear(); }

 private:
  std::set<fs::path> files_;
};

}  // namespace

CollectedDataset collect_dataset(const CollectRequest& request) {
  if (request.runs.empty()) throw std::invalid_argument("no runs; give CSV files");
  CollectedDataset result;
  std::optional<runs::Dataset> there;
  if (fs::exists(request.out / "dataset.toml")) there = runs::read_dataset(request.out);
  result.extended = there.has_value();

  // An existing dataset must have the same robot and source.
  if (there && !request.robot.empty() && !is_robot_of(*there, request))
    throw std::invalid_argument(fmt::format("{}: its robot is '{}', not '{}'; give another folder with --out",
                                            request.out.string(),
                                            runs::resolve_beside(request.out, there->robot, ".toml"), request.robot));
  if (there && there->source != request.source)
    throw std::invalid_argument(
        fmt::format("{}: its source is '{}', not '{}'", request.out.string(), there->source, request.source));

  // All runs are checked before anything is written.
  const std::string asked_robot = request.robot.empty() ? "kenaf" : request.robot;
  const physics::RobotDescription robot =
      physics::load_robot(there ? runs::resolve_beside(request.out, there->robot, ".toml") : asked_robot);
  logs::BodyHeading heading;
  logs::OtherForms forms;
  logs::UnknownColumns unknown;
  for (const RecordedRun& run : request.runs) {
    const std::string file = run.file.string();
    std::optional<runs::Run> recorded = logs::read_or_refuse(run.file, file, result.findings);
    if (!recorded) continue;
    if (request.unwrap)
      for (const std::string& done : logs::unwrap_travel(*recorded))
        result.changed.push_back(fmt::format("{}: {}", file, done));
    forms.look_at(*recorded, file);
    unknown.look_at(*recorded, file);
    const std::vector<logs::Finding> findings = logs::check_run(*recorded, file, &robot);
    result.findings.insert(result.findings.end(), findings.begin(), findings.end());
    if (!logs::any_refused(findings)) heading.look_at(*recorded);
    if (!logs::any_refused(findings) || request.refused_runs.unchecked)
      result.added.push_back(static_cast<std::size_t>(&run - request.runs.data()));
  }
  std::ranges::move(forms.findings(), std::back_inserter(result.findings));
  std::ranges::move(unknown.findings(), std::back_inserter(result.findings));
  const std::vector<logs::Finding> of_heading = heading.findings();
  result.findings.insert(result.findings.end(), of_heading.begin(), of_heading.end());
  result.refused = result.added.empty() ||
                   request.refused_runs.too_many(request.runs.size() - result.added.size(), request.runs.size()) ||
                   (logs::any_refused(of_heading) && !request.refused_runs.unchecked);
  if (result.refused) return result;

  // All worlds must load.
  const std::vector<rollout::Manoeuvre> shipped = rollout::shipped_manoeuvres();
  // The dataset's name of its world is relative to its folder, not to the working directory.
  const auto lies_there = [&](const std::string& world) {
    return there && request.world.empty() && world == there->world;
  };
  std::vector<std::string> worlds;
  for (const std::size_t i : result.added) {
    worlds.push_back(world_of(request, request.runs[i], shipped, there));
    if (lies_there(worlds.back())) continue;
    std::vector<std::string> what_is_not_simulated;
    physics::load_world(worlds.back(), what_is_not_simulated);  // throws if it does not load
  }

  // A new dataset is made in a folder of its own; an existing one gets copies that an error removes again.
  std::optional<PartFolder> whole;
  if (!there) whole.emplace(request.out, false);
  const fs::path folder = there ? request.out : whole->path();
  Descriptions robots(folder, ".toml"), world_files(folder, ".sdf");
  runs::Dataset dataset = there ? *there
                                : runs::Dataset{.source = request.source,
                                                .robot = robots.add(asked_robot),
                                                .world = world_files.add(worlds.front()),
                                                .description = request.description,
                                                .noise = {},
                                                .runs = {}};

  // Runs and worlds are copied, then dataset.toml names them.
  std::set<std::string> names;
  Copies copies;
  for (std::size_t i = 0; i < result.added.size(); ++i) {
    const RecordedRun& run = request.runs[result.added[i]];
    const std::string name = free_name(run.file, folder, names);
    // The runs were read one by one; one that changes is read again.
    std::optional<runs::Run> changed;
    if (request.unwrap) {
      changed = runs::read_run(run.file);
      if (logs::unwrap_travel(*changed).empty()) changed.reset();
    }
    changed ? copies.add(*changed, folder / name) : copies.add(run.file, folder / name);
    const std::string world = lies_there(worlds[i]) ? there->world : world_files.add(worlds[i]);
    copies.add(world_files.made());
    result.runs.push_back({name, run.manoeuvre, world == dataset.world ? std::string() : world});
  }
  if (there) {
    runs::append_runs(folder, result.runs);
  } else {
    dataset.runs = result.runs;
    runs::write_dataset(folder, dataset);
    whole->finish();
  }
  copies.keep();
  return result;
}

}  // namespace kenaf::gap::datasets
