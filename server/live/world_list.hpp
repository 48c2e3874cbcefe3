// The installed worlds, for a person who chooses one.
//
// Thread safety: any thread, as long as none changes the environment.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "server/live/view_options.hpp"

namespace kenaf::live {

struct InstalledWorld {
  std::string name;   // as --world takes it
  std::string words;  // the first comment of its file in one line, at most 300 bytes; empty: it has none
};

// Of all folders of data (formats/description/data_files.hpp), by name. A file that cannot be read has no words.
std::vector<InstalledWorld> installed_worlds();

// The first comment of the text of an SDF file, as in InstalledWorld.
std::string first_comment(std::string_view sdf);

// A command that starts the program of these options with another world, with "WORLD" in the name's place: "kenaf-world
// --world WORLD". It names the live view's address unless that is the usual one; other options are not known here.
std::string start_command(const ViewOptions& options, std::uint16_t port);

// {"command": start_command(), "worlds": [{"name", "words"}, ...]}.
std::string worlds_message(const std::string& command, const std::vector<InstalledWorld>& worlds);

}  // namespace kenaf::live
