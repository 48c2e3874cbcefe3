#include "command_line/parse.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

#include "command_line/wrong_use.hpp"
#include "formats/settings/environment.hpp"

namespace kenaf::command_line {
namespace {

std::string full_name(const CLI::App& command) {
  const CLI::App* parent = command.get_parent();
  return (parent == nullptr ? "" : full_name(*parent) + " ") + command.get_name();
}

// Not by fmt::print, which throws if standard error is closed.
int refuse(const CLI::App& program, std::string_view words, Speaks speaks) {
  if (speaks == Speaks::yes) {
    const CLI::App& command = command_of(program);
    const bool has_more = !command.get_subcommands(nullptr).empty();
    const std::string text = fmt::format("{}: {}\n{} --help lists the {}options\n", program.get_name(), words,
                                         full_name(command), has_more ? "subcommands and " : "");
    std::fputs(text.c_str(), stderr);
  }
  return kWrongUse;
}

// Whoever asks for help gets it, whatever else is wrong.
bool asks_for_help(const std::vector<std::string>& arguments) {
  return std::ranges::any_of(arguments, [](const std::string& argument) {
    return argument == "-h" || argument == "--help" || argument == "--version";
  });
}

}  // namespace

std::optional<int> parse(CLI::App& program, int argc, const char* const* argv, Speaks speaks) {
  program.set_version_flag("--version", KENAF_VERSION);
  const std::vector<std::string> arguments(argv + std::min(argc, 1), argv + argc);
  if (!asks_for_help(arguments)) {
    if (const std::string wrong = settings::wrong_variable(settings::own_environment()); !wrong.empty())
      return refuse(program, wrong, speaks);
    if (const std::string wrong = missing_value(program, arguments); !wrong.empty())
      return refuse(program, wrong, speaks);
  }
  try {
    program.parse(argc, argv);
    return std::nullopt;
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() != 0) return refuse(program, in_words(program, error), speaks);
    return speaks == Speaks::yes ? program.exit(error) : 0;
  }
}

int wrong_use(const CLI::App& program, std::string_view words) {
  return refuse(program, words, Speaks::yes);
}

}  // namespace kenaf::command_line
