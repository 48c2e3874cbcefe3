// Every program, as it is started: what each of its options refuses, by what --help says of it. So an option that is
// added later is tried too.
#include <fmt/format.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <optional>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "formats/settings/nearest_word.hpp"
#include "tests/support/outcome.hpp"

using namespace kenaf;
using test::Outcome;

namespace {

struct Option {
  std::string name, type;  // "--port", "UINT:0 to 65535=3000"; a flag has no type
};

struct Command {
  std::string words;  // "kenaf-gap simulate"
  std::vector<Option> options;
  std::vector<std::string> subcommands;
  bool takes_any_number = false;  // of arguments beside its options
  bool takes_arguments = false;
};

std::vector<std::string> programs() {
  std::istringstream words(KENAF_PROGRAMS);
  return {std::istream_iterator<std::string>(words), {}};
}

bool is_built(const std::string& program) {
  return std::ranges::count(programs(), program) > 0;
}

std::string program_of(const std::string& command) {
  return command.substr(0, command.find(' '));
}

Outcome run(const test::TemporaryFolder& folder, const std::string& command, const std::string& environment = "") {
  // a program that accepts what it should refuse may be a server, which never ends
  return test::outcome_in(folder, fmt::format("{} timeout 100 '{}'/{}", environment, KENAF_BIN_DIR, command));
}

// The lines of CLI11's help: "  --port UINT:0 to 65535=3000     TCP port", with the type up to two blanks.
Command described(const test::TemporaryFolder& folder, const std::string& words) {
  static const std::regex kOption(R"(^  (?:-\w,)?(--[\w-]+)(?: (\S(?:\S| \S)*))?(?:  .*)?$)");
  static const std::regex kSubcommand(R"(^  ([a-z][\w-]*) .*$)");
  const Outcome help = run(folder, words + " --help");
  INFO(words << " --help: " << help.error);
  REQUIRE(help.status == 0);
  Command command{words,
                  {},
                  {},
                  std::regex_search(help.out, std::regex(R"(\.\.\.)")),
                  help.out.find("\nPositionals:\n") != std::string::npos};
  std::istringstream lines(help.out);
  bool in_subcommands = false;
  std::smatch match;
  for (std::string line; std::getline(lines, line);) {
    in_subcommands |= line == "Subcommands:";
    if (std::regex_match(line, match, kOption))
      command.options.push_back({match[1], match[2]});
    else if (in_subcommands && std::regex_match(line, match, kSubcommand))
      command.subcommands.push_back(match[1]);
  }
  return command;
}

// A program and its subcommands.
std::vector<Command> commands_of(const test::TemporaryFolder& folder, const std::string& program) {
  std::vector<Command> commands{described(folder, program)};
  const std::vector<std::string> subcommands = commands.front().subcommands;
  for (const std::string& sub : subcommands) commands.push_back(described(folder, program + " " + sub));
  return commands;
}

void check_refused(const test::TemporaryFolder& folder, const std::string& command, const std::string& words,
                   const std::string& environment = "") {
  CAPTURE(command, environment);
  const Outcome outcome = run(folder, command, environment);
  CHECK(outcome.status == 2);
  CHECK(outcome.out.empty());
  CHECK_THAT(outcome.error,
             Catch::StartsWith(program_of(command).substr(0, 16) == "operator_control" ? "operator_control: "
                                                                                       : program_of(command) + ": "));
  CHECK_THAT(outcome.error, Catch::Contains(words));
  CHECK(std::ranges::count(outcome.error, '\n') <= 2);
  for (const auto& entry : std::filesystem::directory_iterator(folder.path())) {
    const std::string name = entry.path().filename();
    CHECK((name == "out.txt" || name == "error.txt"));
  }
}

struct Range {
  double min, max;
  bool whole;
};

// "UINT:0 to 65535=3000": of an option with a range. A word of a list stands in braces.
std::optional<Range> range_of(const Option& option) {
  static const std::regex kRange(R"(:(-?[\d.e+-]+) to ([\d.e+-]+))");
  std::smatch match;
  if (!std::regex_search(option.type, match, kRange)) return std::nullopt;
  return Range{std::stod(match[1]), std::stod(match[2]), option.type.find("INT") != std::string::npos};
}

std::vector<std::string> list_of(const Option& option) {
  static const std::regex kList(R"(\{([^}]+)\})");
  std::smatch match;
  if (!std::regex_search(option.type, match, kList)) return {};
  std::vector<std::string> words;
  std::istringstream in(match[1]);
  for (std::string word; std::getline(in, word, ',');) words.push_back(word);
  return words;
}

// Of a flag only other options follow, if it needs or excludes them.
bool takes_value(const Option& option) {
  return !option.type.empty() && !option.type.starts_with("Needs:") && !option.type.starts_with("Excludes:");
}

bool is_number(const Option& option) {
  return option.type.starts_with("FLOAT") || option.type.starts_with("INT") || option.type.starts_with("UINT");
}

}  // namespace

TEST_CASE("Every program: --help and --version are status 0, on standard output alone") {
  const test::TemporaryFolder folder;
  REQUIRE_FALSE(programs().empty());
  std::string version;
  for (const std::string& program : programs()) {
    for (const char* asked : {" --help", " -h", " --version"}) {
      CAPTURE(program, asked);
      const Outcome outcome = run(folder, program + asked);
      CHECK(outcome.status == 0);
      CHECK(outcome.error.empty());
      CHECK_FALSE(outcome.out.empty());
      version = outcome.out;
    }
    CHECK_THAT(version, Catch::StartsWith("0."));
  }
}

TEST_CASE("Every program: words that do not exist, arguments that are not expected, variables that are not known") {
  const test::TemporaryFolder folder;
  for (const std::string& program : programs()) {
    for (const Command& command : commands_of(folder, program)) {
      check_refused(folder, command.words + " --xyzzy", "--xyzzy: no such option");
      check_refused(folder, command.words + " --xyzzy=1", "--xyzzy: no such option");
      if (command.subcommands.empty() && !command.takes_any_number)
        check_refused(folder, command.words + " zz zz zz zz", "not expected: zz");
      for (const std::string& sub : command.subcommands) {
        const std::string misspelt = sub + "z";
        // where a file may stand in a subcommand's place, the word is a file that is not there
        const std::string what = command.takes_arguments ? "" : ": no such subcommand";
        check_refused(folder, command.words + " " + misspelt, what + "; did you mean " + sub + "?");
      }
    }
    const std::string variable = "KENAF_DATADIR=/tmp";
    check_refused(folder, program, "KENAF_DATADIR is not known; did you mean KENAF_DATA_DIR?", variable);
    CHECK(run(folder, program + " --help", variable).status == 0);
  }
}

TEST_CASE("Every option of every program: a misspelt name, and a value that is missing") {
  const test::TemporaryFolder folder;
  for (const std::string& program : programs()) {
    for (const Command& command : commands_of(folder, program)) {
      for (const Option& option : command.options) {
        std::string misspelt = option.name;
        std::swap(misspelt[misspelt.size() - 1], misspelt[misspelt.size() - 2]);
        if (misspelt != option.name && option.name.size() > 5)  // shorter ones may be near another too
          check_refused(folder, command.words + " " + misspelt,
                        misspelt + ": no such option; did you mean " + option.name + "?");
        if (takes_value(option)) check_refused(folder, command.words + " " + option.name, option.name + ": needs ");
      }
    }
  }
}

TEST_CASE("Every number of every program: what is no number, and what is out of range") {
  const test::TemporaryFolder folder;
  for (const std::string& program : programs()) {
    for (const Command& command : commands_of(folder, program)) {
      for (const Option& option : command.options) {
        CAPTURE(command.words, option.name, option.type);
        const std::optional<Range> range = range_of(option);
        CHECK((range || !is_number(option)));
        if (!range) continue;
        std::vector<std::string> wrong{"nan", "inf", "-inf", "1e999", "0x10", "'1 '", "x", "''", "1e400000"};
        if (range->max < 1e18) wrong.push_back(fmt::format("{}", range->max * 1.5 + 1));
        if (range->min > -1e18) wrong.push_back(fmt::format("{}", range->min - 1));
        if (range->whole) wrong.insert(wrong.end(), {"1.5", "99999999999999999999", "-1", "007"});
        const std::string must = fmt::format("from {} to {}", range->min, range->max);
        for (const std::string& value : wrong)
          check_refused(folder, fmt::format("{} {}={}", command.words, option.name, value.empty() ? "''" : value),
                        value == "''"       ? option.name + ": needs "
                        : range->max < 1e16 ? must
                                            : option.name);
      }
    }
  }
}

TEST_CASE("Every list of words of every program: a word that is not in it, and one that nearly is") {
  const test::TemporaryFolder folder;
  int lists = 0;
  for (const std::string& program : programs()) {
    for (const Command& command : commands_of(folder, program)) {
      for (const Option& option : command.options) {
        const std::vector<std::string> words = list_of(option);
        if (words.empty()) continue;
        ++lists;
        check_refused(folder, fmt::format("{} {} xyzzy", command.words, option.name),
                      fmt::format("{} xyzzy: must be {}", option.name, settings::either_of(words)));
        const std::string longest = *std::ranges::max_element(words, {}, &std::string::size);
        if (longest.size() >= 3)
          check_refused(folder, fmt::format("{} {} {}z", command.words, option.name, longest),
                        "did you mean " + longest + "?");
      }
    }
  }
  CHECK((lists > 0 || !is_built("kenaf-world")));  // the robot's side alone has no such list
}

TEST_CASE("A shipped description whose name is misspelt, and addresses that are none") {
  const test::TemporaryFolder folder;
  const auto check = [&](const std::string& command, const std::string& words) {
    if (is_built(program_of(command))) check_refused(folder, command, words);
  };
  for (const std::string program : {"kenaf-world", "kenaf-relayd --embedded", "kenaf-candrives"}) {
    if (is_built("kenaf-world")) {  // else there are drives, but no world around them
      check(program + " --world flatt",
            "--world flatt: must be the path of a file that ends in .sdf, or one of boxes, flat,");
      check(program + " --world flatt", "; did you mean flat?");
    }
    check(program + " --robot kenaff", "; did you mean kenaf?");
  }
  for (const std::string wrong : {"nowhere", "[::1", "127.0.0.1:1", "''"})
    check("kenaf-world --listen=" + wrong, wrong == "''" ? "--listen: needs a value" : "must be an address");
  for (const std::string wrong : {"::1", "[::1]", "127.0.0.1", "127.0.0.1:65536", "127.0.0.1:-1", "[127.0.0.1]:1"}) {
    check("kenaf-relayd --listen " + wrong, "must be ADDRESS:PORT");
    check("kenaf-relayd --world-server " + wrong, "must be HOST:PORT");
    check("kenaf-world --view " + wrong, "must be ADDRESS:PORT");
    check("operator_console --control " + wrong, "must be HOST:PORT");
  }
}
