// What is wrong with a command line, in words. For parse.cpp.
//
// Thread safety: pure functions of what the parser has read.
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
class ParseError;
}  // namespace CLI

namespace kenaf::command_line {

// The command that was given: the program, or the subcommand of a subcommand.
const CLI::App& command_of(const CLI::App& program);

// An option whose value is missing because another option follows ("--out --force"), which the parser would take for
// the value; empty: none. `arguments` without the program.
std::string missing_value(const CLI::App& program, const std::vector<std::string>& arguments);

// After `program` has refused its command line with `error`. An argument that the program does not know comes before
// all else: it explains why another is missing.
std::string in_words(const CLI::App& program, const CLI::ParseError& error);

}  // namespace kenaf::command_line
