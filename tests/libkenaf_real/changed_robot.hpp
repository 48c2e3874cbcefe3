// The shipped description with some of it changed, in a file of its own.
#pragma once

#include <catch2/catch.hpp>

#include <fstream>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/process.hpp"

namespace kenaf::real {

class ChangedRobot {
 public:
  // Each first text, which must be there, becomes the second: the first one from [can] on or, if there is none, of all.
  explicit ChangedRobot(const std::vector<std::pair<std::string, std::string>>& changes) {
    std::ifstream file(std::string(KENAF_SOURCE_DIR) + "/share/robots/kenaf.toml");
    std::string text{std::istreambuf_iterator<char>(file), {}};
    for (const auto& [from, to] : changes) {
      std::size_t at = text.find(from, text.find("[can]"));
      if (at == std::string::npos) at = text.find(from);
      REQUIRE(at != std::string::npos);
      text.replace(at, from.size(), to);
    }
    std::ofstream(path()) << text;
  }
  std::string path() const { return (folder_.path() / "changed.toml").string(); }

 private:
  support::TemporaryFolder folder_;
};

// To be put before [can.inclinometer]: flippers that are home where they stand, at 0.7 rad. A constant expression: the
// compilers do not agree on whether an inline std::string is there before what a test's file makes of it.
inline constexpr const char* kHomeHere =
    "\n[can.flipper.homing]\nmethod = 37\nhome_rad = 0.7\nspeed_radps = 0.5\nacceleration_radps2 = 5.0\n"
    "patience_s = 20.0\n";

}  // namespace kenaf::real
