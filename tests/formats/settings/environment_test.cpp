// The environment variables of Kenaf: which there are, that all that read one know it, and what is said of others.
#include "formats/settings/environment.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <set>
#include <string>

#include "hrt/config.hpp"
#include "tests/support/patience.hpp"

using namespace kenaf::settings;

namespace {

namespace fs = std::filesystem;
const fs::path kRoot = KENAF_SOURCE_DIR;

std::string text_of(const fs::path& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::set<std::string> names_of(Variable::Reader reader) {
  std::set<std::string> names;
  for (const Variable& variable : known_variables())
    if (variable.reader == reader) names.emplace(variable.name);
  return names;
}

bool is_known(const std::string& name) {
  const auto all = known_variables();
  return std::ranges::find(all, name, &Variable::name) != all.end();
}

}  // namespace

TEST_CASE("No variable is listed twice, and all have the prefix") {
  std::set<std::string_view> names;
  for (const Variable& variable : known_variables()) {
    CHECK(variable.name.starts_with("KENAF_"));
    CHECK(names.insert(variable.name).second);
    CHECK_FALSE(variable.what.empty());
  }
}

TEST_CASE("The library's variables are KENAF_CONFIG and one for each key of kenaf.toml") {
  std::set<std::string> expected{"KENAF_CONFIG"};
  for (std::string key : kenaf::hrt::config_keys()) {
    std::ranges::transform(key, key.begin(), [](char c) { return c >= 'a' && c <= 'z' ? char(c - 'a' + 'A') : c; });
    expected.insert("KENAF_" + key);
  }
  CHECK(names_of(Variable::Reader::library) == expected);
}

TEST_CASE("Whatever the source tree reads of the environment is known") {
  // as C++, Python and the shell read a variable: getenv("KENAF_X"), environ["KENAF_X"], ${KENAF_X:-...}
  static const std::regex kRead(R"((?:getenv\(|environ(?:\.get\(|\[))\"(KENAF_\w+)|\$\{?(KENAF_[A-Z_]+))");
  static const std::set<std::string> kSources{".cpp", ".hpp", ".c", ".py", ".sh", ".service"};
  std::set<std::string> read;
  for (const char* folder :
       {"can", "command_line", "examples", "formats", "gap", "hrt", "libkenaf_real", "libkenaf_sim", "physics",
        "python", "relayd", "scripts", "server", "teleop", "tests", "tools"}) {
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(kRoot / folder)) {
      if (!kSources.contains(entry.path().extension()) ||
          entry.path() == kRoot / "tests/formats/settings/environment_test.cpp")
        continue;
      const std::string text = text_of(entry.path());
      for (std::sregex_iterator match(text.begin(), text.end(), kRead), end; match != end; ++match)
        read.insert((*match)[1].matched ? (*match)[1].str() : (*match)[2].str());
    }
  }
  CHECK(read.contains("KENAF_DATA_DIR"));
  CHECK(read.contains("KENAF_VCAN_WAY"));
  for (const std::string& name : read) {
    CAPTURE(name);
    CHECK(is_known(name));
  }
}

TEST_CASE("The user guide has a row for each variable that is not for development") {
  const std::string page = text_of(kRoot / "docs/user-guide.md");
  for (const Variable& variable : known_variables()) {
    if (variable.reader == Variable::Reader::development) continue;
    // of a key the guide or the header has the key itself
    const bool is_key = variable.reader == Variable::Reader::library && variable.name != "KENAF_CONFIG";
    CAPTURE(variable.name);
    if (!is_key) CHECK(page.find("`" + std::string(variable.name)) != std::string::npos);
  }
}

TEST_CASE("A variable that does not exist is named, with the one that was probably meant") {
  CHECK(wrong_variable({}).empty());
  CHECK(wrong_variable({{"KENAF", "1"}, {"KENAFX_RELAY", "1"}, {"XKENAF_RELYA", "1"}, {"PATH", "/bin"}}).empty());
  CHECK(wrong_variable({{"KENAF_RELAY", "nonsense, which the library finds"}}).empty());
  CHECK(wrong_variable({{"KENAF_RELYA", "127.0.0.1:1"}}) ==
        "environment variable KENAF_RELYA is not known; did you mean KENAF_RELAY?");
  CHECK(wrong_variable({{"KENAF_WORLDPATH", ""}}) ==
        "environment variable KENAF_WORLDPATH is not known; did you mean KENAF_WORLD_PATH?");
  CHECK(wrong_variable({{"KENAF_relay", "x"}}) ==
        "environment variable KENAF_relay is not known; did you mean KENAF_RELAY?");
  CHECK_THAT(wrong_variable({{"KENAF_XYZZY", "1"}}),
             Catch::StartsWith("environment variable KENAF_XYZZY is not known; ") && !Catch::Contains("did you mean"));
  CHECK_THAT(wrong_variable({{"KENAF_", "1"}}), Catch::StartsWith("environment variable KENAF_ is not known"));
}

TEST_CASE("KENAF_DATA_DIR names a folder, or nothing") {
  CHECK(wrong_variable({{"KENAF_DATA_DIR", ""}}).empty());
  CHECK(wrong_variable({{"KENAF_DATA_DIR", KENAF_SOURCE_DIR "/share"}}).empty());
  CHECK(wrong_variable({{"KENAF_DATA_DIR", "/no/such folder"}}) ==
        "environment variable KENAF_DATA_DIR='/no/such folder': must be a folder");
}

TEST_CASE("The process's own variables have the values that getenv() has") {
  REQUIRE(::setenv("KENAF_HOLD_S", "a=b", 1) == 0);
  const Environment own = own_environment();
  CHECK(own.at("KENAF_HOLD_S") == "a=b");
  REQUIRE(::unsetenv("KENAF_HOLD_S") == 0);
  CHECK_FALSE(own_environment().contains("KENAF_HOLD_S"));
}

TEST_CASE("How long a test waits is a whole number of seconds up to a day") {
  using kenaf::support::patience_from;
  CHECK(patience_from("1") == std::chrono::seconds(1));
  CHECK(patience_from("86400") == std::chrono::hours(24));
  for (const char* wrong : {"", "0", "-5", "86401", "99999999999", "60s", "1.5", " 60", "nan"}) {
    INFO(wrong);
    CHECK_THROWS_WITH(patience_from(wrong), Catch::Contains("KENAF_PATIENCE_S=" + std::string(wrong) +
                                                            ": must be a whole number of seconds"));
  }
}
