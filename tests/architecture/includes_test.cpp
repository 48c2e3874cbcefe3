// Every include of every room, held against the table of docs/architecture.md.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

namespace fs = std::filesystem;

namespace {

const fs::path kRoot = KENAF_SOURCE_DIR;

using Rooms = std::map<std::string, std::set<std::string>>;  // a room, and those that it may include
struct Include {
  std::string file, header;  // both from the root
};

std::vector<std::string> lines_of(const fs::path& file) {
  std::ifstream in(file);
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

std::vector<std::string> in_backticks(const std::string& text) {
  static const std::regex kQuoted("`([^`]+)`");
  std::vector<std::string> words;
  for (std::sregex_iterator match(text.begin(), text.end(), kQuoted), end; match != end; ++match)
    words.push_back((*match)[1]);
  return words;
}

// The table below "Who may depend on whom". Words in its second column that are no rooms are of its prose.
Rooms rooms_in(const std::vector<std::string>& page) {
  std::vector<std::pair<std::vector<std::string>, std::string>> rows;
  auto line = std::ranges::find(page, "## Who may depend on whom");
  for (; line != page.end(); ++line) {
    if (line->starts_with("## ") && !rows.empty()) break;
    const auto bar = line->find(" | ");
    if (line->starts_with("| `") && bar != std::string::npos)
      rows.emplace_back(in_backticks(line->substr(0, bar)), line->substr(bar));
  }
  Rooms rooms{{"include", {}}};
  for (const auto& [names, may] : rows)
    for (const std::string& name : names) rooms[name];
  for (const auto& [names, may] : rows)
    for (const std::string& other : in_backticks(may))
      if (rooms.contains(other))
        for (const std::string& name : names) rooms[name].insert(other);
  return rooms;
}

// The longest room that a path from the root lies in; empty: none.
std::string room_of(const std::string& path, const Rooms& rooms) {
  if (path.starts_with("kenaf/")) return "include";
  std::string longest;
  for (const auto& [room, may] : rooms)
    if (path.starts_with(room + "/") && room.size() > longest.size()) longest = room;
  return longest;
}

std::vector<Include> includes_below(const fs::path& folder) {
  static const std::regex kInclude("^ *# *include *(?:\"|<(?=kenaf/))([^\">]+)[\">].*");
  static const std::set<std::string> kSources{".cpp", ".hpp", ".c", ".h"};
  std::vector<Include> includes;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder)) {
    if (!kSources.contains(entry.path().extension())) continue;
    std::smatch match;
    for (const std::string& line : lines_of(entry.path())) {
      if (!std::regex_match(line, match, kInclude)) continue;
      // beside the file that includes it, as in the examples, or from the root
      const fs::path beside = entry.path().parent_path() / match[1].str();
      const std::string header = fs::exists(beside) ? fs::relative(beside, kRoot).string() : match[1].str();
      includes.push_back({fs::relative(entry.path(), kRoot).string(), header});
    }
  }
  return includes;
}

// What is included and not listed, and what is listed and never included.
std::vector<std::string> against_the_table(const std::vector<Include>& includes, const Rooms& rooms) {
  std::vector<std::string> faults;
  Rooms used;
  for (const auto& [file, header] : includes) {
    const std::string from = room_of(file, rooms), to = room_of(header, rooms);
    if (from.empty()) {
      faults.push_back(fmt::format("{} is in no room that the table lists", file));
    } else if (from != to && !to.empty() && to != "include" && header.find('/', to.size() + 1) != std::string::npos) {
      faults.push_back(fmt::format("{} includes {}: what is in a folder of {} is for {} alone", file, header, to, to));
    } else if (to.empty() || (from != to && !rooms.at(from).contains(to))) {
      faults.push_back(fmt::format("{} includes {}: the table does not list that for {}", file, header, from));
    } else {
      used[from].insert(to);
    }
  }
  for (const auto& [room, may] : rooms)
    for (const std::string& other : may)
      if (!used[room].contains(other))
        faults.push_back(fmt::format("{} never includes {}, which the table lists", room, other));
  return faults;
}

// Folders at the top that hold sources, except those that may include any room.
std::vector<fs::path> folders_with_rooms() {
  static const std::set<std::string> kAny{"bench", "tests"};
  std::vector<fs::path> folders;
  for (const fs::directory_entry& entry : fs::directory_iterator(kRoot)) {
    const std::string name = entry.path().filename();
    if (entry.is_directory() && !name.starts_with(".") && !name.starts_with("build") && !kAny.contains(name))
      folders.push_back(entry.path());
  }
  return folders;
}

}  // namespace

TEST_CASE("Rooms include the rooms that the page lists, and no others") {
  const Rooms rooms = rooms_in(lines_of(kRoot / "docs/architecture.md"));
  REQUIRE(rooms.size() > 10);
  std::vector<Include> includes;
  for (const fs::path& folder : folders_with_rooms())
    std::ranges::move(includes_below(folder), std::back_inserter(includes));
  REQUIRE(includes.size() > 1000);
  const std::vector<std::string> faults = against_the_table(includes, rooms);
  INFO(fmt::format("{}", fmt::join(faults, "\n")));
  CHECK(faults.empty());
}

TEST_CASE("No room can reach itself by way of others") {
  const Rooms rooms = rooms_in(lines_of(kRoot / "docs/architecture.md"));
  for (const auto& [room, may] : rooms) {
    std::set<std::string> reached;
    std::vector<std::string> next(may.begin(), may.end());
    while (!next.empty()) {
      const std::string other = next.back();
      next.pop_back();
      if (reached.insert(other).second) next.insert(next.end(), rooms.at(other).begin(), rooms.at(other).end());
    }
    CAPTURE(room);
    CHECK_FALSE(reached.contains(room));
  }
}

TEST_CASE("An include that the table does not list is named, and so is a listed one that is never used") {
  const Rooms rooms = rooms_in({"## Who may depend on whom", "| room | includes |", "| `a`, `b` | nothing |",
                                "| `c` | `a`; for `--option` the server of `c/d` |", "| `c/d` | `b` |", "", "## Next",
                                "| `e` | `a` |"});
  REQUIRE(rooms.size() == 5);  // include is one
  CHECK(rooms.at("c") == std::set<std::string>{"a", "c/d"});
  const std::vector<Include> right{
      {"c/x.cpp", "a/y.hpp"}, {"c/x.cpp", "c/d/z.hpp"}, {"c/d/z.hpp", "b/y.hpp"}, {"a/y.cpp", "a/y.hpp"}};
  CHECK(against_the_table(right, rooms).empty());
  const auto fault_of = [&](const Include& planted) {
    std::vector<Include> includes = right;
    includes.push_back(planted);
    const std::vector<std::string> faults = against_the_table(includes, rooms);
    return faults.size() == 1 ? faults.front() : std::string("not one fault");
  };
  CHECK(fault_of({"a/y.cpp", "b/y.hpp"}) == "a/y.cpp includes b/y.hpp: the table does not list that for a");
  CHECK(fault_of({"c/d/z.cpp", "c/x.hpp"}) == "c/d/z.cpp includes c/x.hpp: the table does not list that for c/d");
  CHECK(fault_of({"a/y.cpp", "kenaf/hrt.h"}) == "a/y.cpp includes kenaf/hrt.h: the table does not list that for a");
  CHECK(fault_of({"c/x.cpp", "a/inside/y.hpp"}) ==
        "c/x.cpp includes a/inside/y.hpp: what is in a folder of a is for a alone");
  CHECK(fault_of({"e/y.cpp", "a/y.hpp"}) == "e/y.cpp is in no room that the table lists");
  CHECK(against_the_table({right.begin() + 1, right.end()}, rooms) ==
        std::vector<std::string>{"c never includes a, which the table lists"});
}
