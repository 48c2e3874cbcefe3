#include "gap/simulate.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <map>
#include <stdexcept>
#include <system_error>

#include "gap/parallel.hpp"
#include "gap/physics_settings.hpp"
#include "physics/world_description.hpp"
#include "rollout/roll_out.hpp"
#include "runs/dataset.hpp"
#include "runs/whole_file.hpp"

namespace kenaf::gap {
namespace {

namespace fs = std::filesystem;

// Chosen: how well a robot is put on a mark by hand.
constexpr double kStartScatter_m = 0.005, kStartScatter_rad = 0.01;
constexpr double kLargestScale = 1000;
constexpr int kMostRuns = 100000;

// FNV-1a, http://www.isthe.com/chongo/tech/comp/fnv/, of everything that a run's noise depends on.
std::uint64_t seed_of(std::uint64_t seed, const std::string& manoeuvre, int repeat) {
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (const char c : fmt::format("{} {} {}", seed, repeat, manoeuvre))
    hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
  return hash;
}

// A folder beside `out` that becomes `out` when it is whole, and goes away when it never gets so.
class PartFolder {
 public:
  PartFolder(const fs::path& out, bool force) : out_(out) {
    if (out.empty()) throw std::invalid_argument("no folder to write to; give one with --out");
    std::error_code error;
    const fs::file_status status = fs::status(out, error);
    if (fs::exists(status) && !fs::is_directory(status))
      throw std::runtime_error(fmt::format("{}: is no folder", out.string()));
    if (!fs::status_known(status)) fail(out, "cannot be reached", error.value());
    if (fs::exists(status)) {
      const bool empty = fs::is_empty(out, error);
      if (error) fail(out, "cannot be read", error.value());
      if (!empty && !force)
        throw std::runtime_error(
            fmt::format("{}: is not empty; give another folder, or --force to write into it", out.string()));
    }
    fs::path whole = fs::absolute(out).lexically_normal();
    if (!whole.has_filename()) whole = whole.parent_path();  // "runs/" is "runs"
    out_ = whole;
    fs::create_directories(out_.parent_path(), error);
    if (error) fail(out, "cannot be made", error.value());
    std::string name = out_.string() + ".part-XXXXXX";
    if (::mkdtemp(name.data()) == nullptr) fail(out, "cannot be made", errno);
    part_ = name;
    fs::permissions(part_,
                    fs::perms::group_read | fs::perms::group_exec | fs::perms::others_read | fs::perms::others_exec,
                    fs::perm_options::add);
  }
  ~PartFolder() {
    std::error_code ignored;
    fs::remove_all(part_, ignored);
  }
  PartFolder(const PartFolder&) = delete;
  PartFolder& operator=(const PartFolder&) = delete;

  const fs::path& path() const { return part_; }

  // dataset.toml comes last, so that it never names a run that is not there.
  void finish() {
    if (!fs::exists(out_) || fs::is_empty(out_)) {
      fs::rename(part_, out_);
      return;
    }
    const auto move = [this](const fs::path& file) { fs::rename(file, out_ / file.filename()); };
    std::vector<fs::path> files;
    for (const fs::directory_entry& entry : fs::directory_iterator(part_)) files.push_back(entry.path());
    for (const fs::path& file : files)
      if (file.filename() != "dataset.toml") move(file);
    move(part_ / "dataset.toml");
  }

 private:
  [[noreturn]] static void fail(const fs::path& folder, std::string_view what, int error) {
    throw std::runtime_error(fmt::format("{}: {}: {}", folder.string(), what, std::generic_category().message(error)));
  }

  fs::path out_, part_;
};

// What a dataset calls a description: a shipped name, or the copy of a file that it keeps beside dataset.toml. A world
// of meshes or height maps stays where they are, under its full path.
class Descriptions {
 public:
  Descriptions(fs::path folder, std::string extension) : folder_(std::move(folder)), extension_(std::move(extension)) {}

  std::string add(const std::string& name_or_path) {
    const bool path = name_or_path.find('/') != name_or_path.npos || name_or_path.ends_with(extension_);
    if (!path) return name_or_path;
    const auto [known, is_new] = names_.try_emplace(name_or_path, fs::path(name_or_path).stem().string() + extension_);
    if (is_new) {
      const std::string text = runs::read_whole_file(name_or_path);
      if (text.find("<uri>") != text.npos) return known->second = fs::absolute(name_or_path).lexically_normal();
      const std::string& copy = known->second;
      if (copy == "dataset.toml" || fs::exists(folder_ / copy))
        throw std::runtime_error(fmt::format("{}: another file of the dataset has that name; rename it", name_or_path));
      runs::write_whole_file(folder_ / copy, text);
    }
    return known->second;
  }

 private:
  fs::path folder_;
  std::string extension_;
  std::map<std::string, std::string> names_;
};

void write_run(const fs::path& file, const runs::Run& run) {
  runs::RunWriter writer(file, run.columns);
  std::vector<double> row(run.columns.size());
  for (std::size_t i = 0; i < run.row_count(); ++i) {
    for (std::size_t c = 0; c < row.size(); ++c) row[c] = run.values[c][i];
    writer.add_row(row);
  }
  writer.finish();
}

std::string description_of(const SimulationRequest& request) {
  std::string text = "Simulated.";
  if (!request.effects.empty()) text += fmt::format(" Effects: {}.", fmt::join(request.effects, " "));
  return text + fmt::format(" Physics: {}. Noise {}, start scatter {}, seed {}.", physics_text(request.physics),
                            request.noise_scale, request.scatter_scale, request.seed);
}

struct Asked {
  std::string argument;
  rollout::Manoeuvre manoeuvre;
  const physics::WorldDescription* world;
};

}  // namespace

SimulatedDataset simulate_dataset(const SimulationRequest& request) {
  if (request.manoeuvres.empty()) throw std::invalid_argument("no manoeuvre; kenaf-gap manoeuvres lists them");
  if (request.repeats < 1 || std::ssize(request.manoeuvres) > kMostRuns / request.repeats)
    throw std::invalid_argument(fmt::format("repeats must be at least 1, and all runs together at most {}", kMostRuns));
  for (const double scale : {request.noise_scale, request.scatter_scale})
    if (!(scale >= 0 && scale <= kLargestScale))
      throw std::invalid_argument(fmt::format("noise and scatter must be from 0 to {}", kLargestScale));
  const physics::RobotDescription nominal = physics::load_robot(request.robot);
  physics::RobotDescription robot = nominal;
  for (const std::string& effect : request.effects) physics::set_effect(robot.effects, effect);

  rollout::RollOutOptions options;
  options.physics = request.physics;
  options.noise_scale = request.noise_scale;
  options.start_scatter_m = kStartScatter_m * request.scatter_scale;
  options.start_scatter_rad = kStartScatter_rad * request.scatter_scale;

  SimulatedDataset result;
  std::map<std::string, physics::WorldDescription> worlds;
  std::vector<Asked> asked;
  for (const std::string& name : request.manoeuvres) {
    rollout::Manoeuvre manoeuvre = rollout::load_manoeuvre(name);
    if (!request.world.empty()) manoeuvre.world = request.world;
    if (manoeuvre.world.empty())
      throw std::invalid_argument(fmt::format("{}: does not say in which world it is; give --world", name));
    const auto [world, is_new] = worlds.try_emplace(manoeuvre.world);
    if (is_new) world->second = physics::load_world(manoeuvre.world, result.warnings);
    asked.push_back({name, std::move(manoeuvre), &world->second});
  }

  PartFolder folder(request.out, request.force);
  Descriptions robots(folder.path(), ".toml"), world_files(folder.path(), ".sdf");
  runs::Dataset dataset{.source = "sim",
                        .robot = robots.add(request.robot),
                        .world = world_files.add(asked.front().manoeuvre.world),
                        .description = description_of(request),
                        .noise = rollout::column_noise(nominal, options),
                        .runs = {}};
  const auto repeats = static_cast<std::size_t>(request.repeats);
  for (std::size_t i = 0; i < asked.size() * repeats; ++i) {
    const rollout::Manoeuvre& manoeuvre = asked[i / repeats].manoeuvre;
    const std::string world = world_files.add(manoeuvre.world);
    dataset.runs.push_back(
        {fmt::format("run-{:03}.csv", i), manoeuvre.name, world == dataset.world ? std::string() : world});
  }
  result.runs.resize(dataset.runs.size());
  for_each_job(dataset.runs.size(), request.jobs, [&](std::size_t i) {
    const Asked& of = asked[i / repeats];
    rollout::RollOutOptions own = options;
    own.seed = seed_of(request.seed, of.argument, static_cast<int>(i % repeats));
    const rollout::RollOut out = rollout::roll_out(robot, *of.world, of.manoeuvre, own);
    write_run(folder.path() / dataset.runs[i].file, out.run);
    SimulatedRun& run = result.runs[i];
    run = {.file = dataset.runs[i].file,
           .manoeuvre = of.manoeuvre.name,
           .duration_s = out.run.column("t_s").back(),
           .succeeded = of.manoeuvre.success ? std::optional(out.succeeded) : std::nullopt,
           .fault = out.fault};
    dataset.runs[i].fault = out.fault;
  });
  runs::write_dataset(folder.path(), dataset);
  folder.finish();
  return result;
}

}  // namespace kenaf::gap
