#include "command_line/wrong_use.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "formats/settings/nearest_word.hpp"

namespace kenaf::command_line {
namespace {

using settings::shown;

// "--out", "-h": what the command knows, itself and as a part of other commands.
std::vector<std::string> option_names(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::App* app = &command; app != nullptr; app = app->get_parent()) {
    for (const CLI::Option* option : app->get_options()) {
      for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
      for (const std::string& name : option->get_snames()) names.push_back("-" + name);
    }
  }
  return names;
}

std::vector<std::string> subcommand_names(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::App* sub : command.get_subcommands(nullptr)) names.push_back(sub->get_name());
  return names;
}

std::size_t positional_count(const CLI::App& command) {
  const auto options = command.get_options();
  return static_cast<std::size_t>(std::ranges::count_if(options, &CLI::Option::get_positional));
}

// "-0.5" is a value, "-o" an option.
bool looks_like_option(const std::string& argument) {
  return argument.size() > 1 && argument[0] == '-' && !(argument[1] >= '0' && argument[1] <= '9') && argument != "--";
}

std::string no_such_subcommand(const std::string& argument, const std::vector<std::string>& subcommands) {
  const std::string nearest = settings::did_you_mean(argument, subcommands);
  return fmt::format("{}: no such subcommand{}", shown(argument),
                     nearest.empty() ? "; a subcommand is required: " + settings::either_of(subcommands) : nearest);
}

std::string unknown_argument(const CLI::App& command, const std::string& argument) {
  if (looks_like_option(argument)) {
    const std::string name = argument.substr(0, argument.find('='));
    return fmt::format("{}: no such option{}", shown(name), settings::did_you_mean(name, option_names(command)));
  }
  const std::vector<std::string> subcommands = subcommand_names(command);
  if (!subcommands.empty() && command.get_subcommands().empty()) return no_such_subcommand(argument, subcommands);
  const std::size_t count = positional_count(command);
  return fmt::format("{} takes {}; not expected: {}", command.get_name(),
                     count == 0   ? "options only"
                     : count == 1 ? "one argument beside its options"
                                  : fmt::format("{} arguments beside its options", count),
                     shown(argument));
}

const CLI::Option* option_named_in(const CLI::App& command, const std::string& words) {
  // the longest name, as one may be the beginning of another
  const CLI::Option* found = nullptr;
  for (const CLI::App* app = &command; app != nullptr; app = app->get_parent()) {
    for (const CLI::Option* option : app->get_options()) {
      const std::string name = option->get_name();
      const bool longer = found == nullptr || name.size() > found->get_name().size();
      if (words.find(name) != std::string::npos && longer) found = option;
    }
  }
  return found;
}

// Too few or too many values. The parser's own words count types and values in a way that depends on the option.
std::string wrong_count(const CLI::App& command, const std::string& words) {
  const CLI::Option* option = option_named_in(command, words);
  if (option == nullptr) return words;
  const std::string name = option->get_name();
  const auto given = static_cast<int>(option->results().size());
  const int most = option->get_items_expected_max(), least = option->get_items_expected_min();
  if (most == 0) return fmt::format("{}: takes no value", name);
  if (given == 0) return least > 1 ? fmt::format("{}: needs {} values", name, least) : name + ": needs a value";
  if (most == 1) return fmt::format("{}: given {} times, but takes one value", name, given);
  return least == most ? fmt::format("{}: needs {} values, not {}", name, least, given)
                       : fmt::format("{}: needs {} to {} values, not {}", name, least, most, given);
}

// "--speed: fast: must be" becomes "--speed fast: must be".
std::string wrong_value(const std::string& words) {
  const std::size_t colon = words.find(": ");
  return colon == std::string::npos ? words : words.substr(0, colon) + words.substr(colon + 1);
}

}  // namespace

const CLI::App& command_of(const CLI::App& program) {
  const CLI::App* command = &program;
  while (!command->get_subcommands().empty()) command = command->get_subcommands().back();
  return *command;
}

std::string missing_value(const CLI::App& program, const std::vector<std::string>& arguments) {
  const CLI::App* command = &program;
  const auto option_of = [&command](const std::string& argument) {
    return argument.starts_with("--") ? command->get_option_no_throw(argument) : nullptr;
  };
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    const std::string& argument = arguments[i];
    if (argument == "--") break;  // all that follows are values
    if (!argument.starts_with('-')) {
      const auto subs = command->get_subcommands(nullptr);
      const auto sub = std::ranges::find(subs, argument, [](const CLI::App* app) { return app->get_name(); });
      if (sub != subs.end()) command = *sub;
      continue;
    }
    const bool is_empty = argument.ends_with('=');
    const std::string name = is_empty ? argument.substr(0, argument.size() - 1) : argument;
    const CLI::Option* option = option_of(name);
    if (option == nullptr || option->get_items_expected_min() == 0) continue;
    const bool is_followed_by_option = i + 1 < arguments.size() && option_of(arguments[i + 1]) != nullptr;
    if (is_empty || is_followed_by_option) return fmt::format("{}: needs a value", name);
  }
  return {};
}

std::string in_words(const CLI::App& program, const CLI::ParseError& error) {
  // From the outside in: a word that is no subcommand explains all that follows.
  const CLI::App* command = &program;
  for (;;) {
    const std::vector<std::string> unknown = command->remaining();
    const auto first = std::ranges::find_if(unknown, [](const std::string& argument) { return argument != "--"; });
    if (first != unknown.end()) return unknown_argument(*command, *first);
    if (command->get_subcommands().empty()) break;
    command = command->get_subcommands().back();
  }

  const std::string words = error.what();
  if (dynamic_cast<const CLI::ArgumentMismatch*>(&error) != nullptr) return wrong_count(*command, words);
  if (dynamic_cast<const CLI::ValidationError*>(&error) != nullptr) return wrong_value(words);
  if (dynamic_cast<const CLI::ExcludesError*>(&error) != nullptr ||
      dynamic_cast<const CLI::RequiresError*>(&error) != nullptr)
    return words;  // "--world excludes --ideal", "--speed requires --embedded"
  if (dynamic_cast<const CLI::ConversionError*>(&error) != nullptr) {
    const CLI::Option* option = option_named_in(*command, words);
    if (option != nullptr && option->get_items_expected_max() == 0)
      return fmt::format("{}: takes no value", option->get_name());
  }
  return words;  // "--out is required", "A subcommand is required"
}

}  // namespace kenaf::command_line
