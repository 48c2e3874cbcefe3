// kenaf-describe: a robot's description from a URDF, and a URDF from a description.
//
//   kenaf-describe from-urdf husky.urdf --out husky.toml
//   kenaf-describe to-urdf kenaf --out kenaf.urdf
//
// Exit status: 0 if it is written, 2 for bad input, with the file, link or joint at fault on standard error.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include "command_line/checks.hpp"
#include "command_line/parse.hpp"
#include "formats/runs/whole_file.hpp"
#include "physics/robot_description.hpp"
#include "tools/describe/from_urdf.hpp"
#include "tools/describe/to_urdf.hpp"

namespace {

using namespace kenaf;

constexpr int kBadInput = 2;

struct Options {
  std::string urdf, robot, out;
  std::vector<std::string> packages;
  describe::FromUrdfOptions from;
};

void print_list(const std::string& heading, const std::vector<std::string>& lines) {
  if (lines.empty()) return;
  std::fprintf(stderr, "%s\n", heading.c_str());
  for (const std::string& line : lines) std::fprintf(stderr, "  %s\n", line.c_str());
}

void write_result(const std::string& out, const std::string& text) {
  if (!out.empty()) return runs::write_whole_file(out, text);
  if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size() || std::fflush(stdout) != 0)
    throw std::runtime_error("standard output cannot be written");
}

// Throws std::runtime_error if the text is not A=B.
void require_assignment(const std::string& text, const char* form) {
  const std::size_t equals = text.find('=');
  if (equals == 0 || equals == std::string::npos) throw std::runtime_error(std::string("must be ") + form);
}

void take_package(const std::string& text, describe::MeshFolders& folders) {
  const std::size_t equals = text.find('=');
  folders.packages[text.substr(0, equals)] = text.substr(equals + 1);
}

void run_from_urdf(Options options) {
  options.from.folders.beside = std::filesystem::path(options.urdf).parent_path();
  for (const std::string& package : options.packages) take_package(package, options.from.folders);
  const describe::MadeDescription made =
      describe::from_urdf(runs::read_whole_file(options.urdf), options.urdf, options.from);
  write_result(options.out, made.toml);
  print_list("warnings:", made.warnings);
  print_list("not in the URDF, so chosen; --set KEY=VALUE gives another value:", made.chosen);
}

void run_to_urdf(const Options& options) {
  const describe::MadeUrdf made = describe::to_urdf(physics::load_robot(options.robot));
  write_result(options.out, made.xml);
  print_list("not in the URDF:", made.left_out);
}

CLI::App* add_from_urdf(CLI::App& program, Options& options) {
  CLI::App* command = program.add_subcommand("from-urdf", "makes a robot's description of a URDF");
  command->add_option("urdf", options.urdf, "links, joints, inertias and collision shapes")
      ->required()
      ->type_name("FILE");
  command->add_option("--out", options.out, "the description, .toml [standard output]")->type_name("FILE");
  const auto several = [&](const char* name, std::vector<std::string>& values, const char* help, const char* type) {
    command->add_option(name, values, help)
        ->allow_extra_args(false)
        ->type_name(type)
        ->check(command_line::readable_by([type](const std::string& text) { require_assignment(text, type); }));
  };
  several("--set", options.from.set,
          "a key's value, such as drive.max_force_n=300, wheel.friction_along=0.7 for all wheels, or "
          "wheel.2.width_m=0.1; may be given several times",
          "KEY=VALUE");
  command->add_option("--class", options.from.usarsim_class, "USARSim's class [USARBot. and the robot's name]")
      ->type_name("USARBot.NAME");
  const auto links = [&](const char* name, std::string& value, const char* help) {
    command->add_option(name, value, help)->type_name("REGEX");
  };
  links("--wheels", options.from.choice.wheels, "links that are wheels [round ones on continuous joints about y]");
  links("--tracks", options.from.choice.tracks, "links that are tracks, or parts of them [those named so]");
  links("--flippers", options.from.choice.flippers, "links that are flippers [those named so]");
  links("--hull", options.from.choice.hull, "links whose shapes make the hull's box [all others]");
  command
      ->add_option_function<double>(
          "--tolerance", [&](double mm) { options.from.tolerance_m = mm / 1000; },
          "what left and right, and front and rear flippers, may differ by, in mm; for each, 2 mrad and 2 % of mass "
          "[0.5]")
      ->type_name("MM")
      ->check(command_line::number_in(0, 1000));
  several("--package", options.packages, "where package://NAME/ in a mesh's name is; may be given several times",
          "NAME=FOLDER");
  return command;
}

CLI::App* add_to_urdf(CLI::App& program, Options& options) {
  CLI::App* command = program.add_subcommand("to-urdf", "makes a URDF of a robot's description");
  command->add_option("robot", options.robot, "a shipped name or a TOML file")->required()->type_name("ROBOT");
  command->add_option("--out", options.out, "the URDF [standard output]")->type_name("FILE");
  return command;
}

}  // namespace

int main(int argc, char** argv) {
  // Options, then one of both ways; all errors end with the same status.
  Options options;
  CLI::App program{"Makes a robot's description of a URDF, and a URDF of a description.", "kenaf-describe"};
  program.require_subcommand(1);
  const CLI::App* from_urdf = add_from_urdf(program, options);
  add_to_urdf(program, options);
  if (const auto status = command_line::parse(program, argc, argv)) return *status;
  try {
    if (from_urdf->parsed())
      run_from_urdf(std::move(options));
    else
      run_to_urdf(options);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "kenaf-describe: %s\n", error.what());
    return kBadInput;
  }
  return 0;
}
