// Reads the command line of a program, with one convention for all of them:
//
//   status 0   --help and --version, on standard output
//   status 2   wrong use: standard error names the option, its value, what it must be, and the right word if one is
//              near; nothing is on standard output, and nothing has been done
//
//   kenaf-world: --speed fast: must be a number from 0 to 1000000
//   kenaf-world --help lists the options
//
// Wrong use is also an environment variable that does not exist (formats/settings/environment.hpp). What fails later,
// as a file that cannot be read, has the program's own status.
//
// Thread safety: one thread, before others start: the environment is read.
#pragma once

#include <optional>
#include <string_view>

namespace CLI {
class App;
}

namespace kenaf::command_line {

constexpr int kWrongUse = 2;

enum class Speaks { yes, no };  // no: of several processes with the same command line, one speaks

// Adds --version to `program`, which must have a name. Returns the status with which it ends; nullopt: it goes on.
// Values of options must be checked by checks.hpp, whose words this prints. Callbacks of options and subcommands are
// called once all is right; what they throw passes, except CLI::ParseError, which is wrong use.
std::optional<int> parse(CLI::App& program, int argc, const char* const* argv, Speaks speaks = Speaks::yes);

// For wrong use that the parser cannot see, such as two options that contradict each other: prints `words` as parse()
// does, and returns kWrongUse.
int wrong_use(const CLI::App& program, std::string_view words);

}  // namespace kenaf::command_line
