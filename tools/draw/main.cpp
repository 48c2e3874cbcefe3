// kenaf-draw: a picture of a run.
//
//   kenaf-draw square.csv --out square.png
//   kenaf-draw real/run-000.csv --run sim/run-000.csv --world step-200 --out compared.svg
//
// Exit status: 0 if the picture is written, 2 for bad input, with the file and place at fault on standard error.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <string>
#include <vector>

#include "command_line/checks.hpp"
#include "command_line/parse.hpp"
#include "formats/runs/dataset.hpp"
#include "formats/runs/whole_file.hpp"
#include "formats/settings/numbers.hpp"
#include "tools/draw/picture.hpp"

namespace {

namespace fs = std::filesystem;
using namespace kenaf;

constexpr int kBadInput = 2;

struct Options {
  std::string run, robot, world, out, title, view = "auto", size = "1920x1200";
  std::vector<std::string> other_runs;
};

// If the run belongs to a dataset, robot and world default to the dataset's.
void complete_from_dataset(Options& options) {
  const fs::path folder = fs::path(options.run).parent_path();
  const bool complete = !options.robot.empty() && !options.world.empty();
  if (!complete && fs::exists(folder / "dataset.toml")) {
    const runs::Dataset dataset = runs::read_dataset(folder);
    const auto entry =
        std::ranges::find(dataset.runs, fs::path(options.run).filename().string(), &runs::DatasetRun::file);
    if (entry != dataset.runs.end()) {
      const std::string& world = entry->world.empty() ? dataset.world : entry->world;
      if (options.robot.empty()) options.robot = runs::resolve_beside(folder, dataset.robot, ".toml");
      if (options.world.empty()) options.world = runs::resolve_beside(folder, world, ".sdf");
    }
  }
  if (options.robot.empty()) options.robot = "kenaf";
  if (options.world.empty()) options.world = "flat";
}

struct Size {
  int width, height;
};

// Throws std::runtime_error if the text is not WIDTHxHEIGHT.
Size size_from(const std::string& text) {
  const std::size_t x = text.find('x');
  const auto width = settings::whole_number_from(text.substr(0, x));
  const auto height = settings::whole_number_from(x == text.npos ? "" : text.substr(x + 1));
  if (!width || !height || *width < 480 || *height < 300 || *width > 10000 || *height > 10000 ||
      *height * 5 < *width * 2) {
    throw std::runtime_error(
        "must be WIDTHxHEIGHT in pixels, such as 1920x1200, from 480x300 to 10000x10000, and no flatter than 5 : 2");
  }
  return {static_cast<int>(*width), static_cast<int>(*height)};
}

draw::Canvas make_canvas(const Options& options) {
  const std::string extension = fs::path(options.out).extension();
  if (extension != ".png" && extension != ".svg") {
    throw std::runtime_error(options.out + ": the picture's name must end in .png or .svg");
  }
  const auto [width, height] = size_from(options.size);
  return draw::Canvas(extension == ".png" ? draw::Format::png : draw::Format::svg, width, height);
}

draw::Scene load_scene(const Options& options) {
  std::vector<std::string> unsupported;  // of no interest for a picture
  draw::Scene scene{physics::load_robot(options.robot), physics::load_world(options.world, unsupported), {}};
  const auto add = [&scene](const std::string& file, const std::string& name) {
    scene.paths.push_back(draw::driven_path(runs::read_run(file), name, scene.robot));
  };
  // Runs of two datasets often have the same name; then their folders distinguish them.
  std::vector<std::string> files{options.run};
  files.insert(files.end(), options.other_runs.begin(), options.other_runs.end());
  for (const std::string& file : files) {
    const auto stem = [](const std::string& path) { return fs::path(path).stem().string(); };
    const bool shared = std::ranges::count(files, stem(file), stem) > 1;
    const std::string folder = fs::absolute(file).parent_path().filename();
    add(file, shared ? folder + "/" + stem(file) : stem(file));
  }
  return scene;
}

void draw_to_file(Options options) {
  complete_from_dataset(options);
  draw::Canvas canvas = make_canvas(options);
  const draw::Scene scene = load_scene(options);
  const draw::ViewChoice view = options.view == "top"    ? draw::ViewChoice::top
                                : options.view == "side" ? draw::ViewChoice::side
                                                         : draw::ViewChoice::automatic;
  draw::draw_picture(canvas, scene, options.title.empty() ? fs::path(options.run).stem().string() : options.title,
                     view);
  runs::write_whole_file(options.out, canvas.finish());
  for (std::size_t i = 0; i < scene.paths.size(); ++i) {
    std::printf("%s: %s\n", scene.paths[i].name.c_str(), draw::summary(scene, i).c_str());
  }
}

}  // namespace

int main(int argc, char** argv) {
  // Options, then the picture; both kinds of errors end with the same status.
  Options options;
  CLI::App app{"Draws a run of the robot from above and, if it climbs, from the side.", "kenaf-draw"};
  app.add_option("file", options.run, "the run, a CSV file in the kenaf-runs/1 format")
      ->required()
      ->type_name("RUN.csv");
  app.add_option("--run", options.other_runs, "a run to compare it with; may be given several times")
      ->type_name("OTHER.csv");
  app.add_option("--robot", options.robot,
                 "robot description: a shipped name or a TOML file [the dataset's, else kenaf]");
  app.add_option("--world", options.world, "world: a shipped name or an SDF file [the dataset's, else flat]");
  app.add_option("--out", options.out, "the picture, .png or .svg")->required()->type_name("FILE");
  app.add_option("--view", options.view, "top, side, or auto: from the side too where the robot climbs")
      ->check(command_line::one_of({"top", "side", "auto"}))
      ->capture_default_str();
  app.add_option("--size", options.size, "pixels, WIDTHxHEIGHT")
      ->check(command_line::readable_by([](const std::string& text) { (void)size_from(text); }))
      ->capture_default_str();
  app.add_option("--title", options.title, "the picture's title [the run's name]");
  if (const auto status = command_line::parse(app, argc, argv)) return *status;
  try {
    draw_to_file(std::move(options));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "kenaf-draw: %s\n", error.what());
    return kBadInput;
  }
  return 0;
}
