// Configuration: defaults, TOML, environment, ranges, and where an error is said to be.
#include <catch2/catch.hpp>
#include <clocale>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>

#include "hrt/config.hpp"
#include "hrt/error.hpp"
#include "tests/support/process.hpp"

using namespace kenaf::hrt;

namespace {

std::string toml_error(std::string_view text) {
  hrt_config config = default_config();
  const hrt_config before = config;
  try {
    apply_toml(text, "kenaf.toml", config);
  } catch (const Error& error) {
    CHECK(error.code() == HRT_E_CONFIG);
    CHECK(std::memcmp(&config, &before, sizeof config) == 0);
    return error.what();
  }
  return "";
}

Environment environment_of(const std::map<std::string, std::string>& variables) {
  return {variables.begin(), variables.end()};
}

std::string environment_error(const std::map<std::string, std::string>& variables) {
  hrt_config config = default_config();
  try {
    apply_environment(environment_of(variables), config);
  } catch (const Error& error) {
    CHECK(error.code() == HRT_E_CONFIG);
    return error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("The defaults are the ones the header states, and valid") {
  const hrt_config config = hrt_config_default();
  CHECK_NOTHROW(check_config(config));
  CHECK(config.period_s == 0.01);
  CHECK(config.command_timeout_s == 0.1);
  CHECK(config.lockstep == 1);
  CHECK(std::string(config.relay) == "127.0.0.1:45454");
  CHECK(std::string(config.can_interface).empty());
  CHECK(std::string(config.robot) == "kenaf");
  CHECK(config.record[0] == '\0');
  CHECK(std::string(config.camera_server) == "127.0.0.1:5003");
}

TEST_CASE("A program of the first header has a shorter config, and what it lacks is as by default") {
  // Its hrt_config ended where camera_server begins now; what lies behind it is not the library's.
  alignas(hrt_config) unsigned char memory[sizeof(hrt_config)];
  std::memset(memory, 0x5a, sizeof memory);
  auto& config = reinterpret_cast<hrt_config&>(memory);
  config.size = offsetof(hrt_config, camera_server);
  REQUIRE(hrt_config_fill(&config) == HRT_OK);
  const kenaf::support::TemporaryFolder folder;
  std::ofstream(folder.path() / "mine.toml") << "period_s = 0.02\ncamera_server = \"10.0.0.2:5003\"\n";
  REQUIRE(setenv("KENAF_CONFIG", (folder.path() / "mine.toml").c_str(), 1) == 0);
  CHECK(hrt_config_load(&config) == HRT_OK);
  REQUIRE(unsetenv("KENAF_CONFIG") == 0);
  CHECK(config.size == offsetof(hrt_config, camera_server));
  CHECK(config.period_s == 0.02);
  for (std::size_t i = config.size; i < sizeof memory; ++i) REQUIRE(memory[i] == 0x5a);
  CHECK(std::string(whole_config(config).camera_server) == "127.0.0.1:5003");
  config.size = sizeof config + 8;
  CHECK_THROWS_WITH(whole_config(config), Catch::Contains("hrt_config_default()"));
}

TEST_CASE("A file sets every kind of key") {
  hrt_config config = default_config();
  apply_toml(R"(
# a comment
period_s = 0.02
max_speed_mmps = 150          # an integer is a number
lockstep = false
relay = "10.0.0.2:5000"
robot = "./my-robot.toml"
record = "recordings/run.csv"
)",
             "kenaf.toml", config);
  CHECK(config.period_s == 0.02);
  CHECK(config.max_speed_mmps == 150);
  CHECK(config.lockstep == 0);
  CHECK(config.reset_robot == 1);
  CHECK(std::string(config.relay) == "10.0.0.2:5000");
  CHECK(std::string(config.robot) == "./my-robot.toml");
  CHECK(std::string(config.record) == "recordings/run.csv");
}

TEST_CASE("What is wrong in a file is named with line and column, and nothing is changed") {
  CHECK_THAT(toml_error("\n\nperiode_s = 0.01\n"), Catch::StartsWith("kenaf.toml:3:1: unknown key 'periode_s'"));
  CHECK_THAT(toml_error("period_s = 5\n"),
             Catch::StartsWith("kenaf.toml:1:12: period_s must be from 0.001 to 1, not 5"));
  CHECK_THAT(toml_error("link_timeout_s = 1\nperiod_s = \"fast\""),
             Catch::StartsWith("kenaf.toml:2:12: period_s must be a number"));
  CHECK_THAT(toml_error("lockstep = 1"), Catch::StartsWith("kenaf.toml:1:12: lockstep must be true or false"));
  CHECK_THAT(toml_error("relay = 45454"), Catch::StartsWith("kenaf.toml:1:9: relay must be a string"));
  CHECK_THAT(toml_error("relay = \"\""), Catch::Contains("relay must not be empty"));
  CHECK_THAT(toml_error("can_interface = \"a-name-that-is-too-long\""), Catch::Contains("at most 15 bytes"));
  CHECK_THAT(toml_error("robot = \"\""), Catch::Contains("robot must not be empty"));
  CHECK_THAT(toml_error("[motion]\nmax_speed_mmps = 3"), Catch::Contains("unknown key 'motion'"));
  CHECK_THAT(toml_error("period_s = nan"), Catch::Contains("period_s must be from"));
  // 2^53 + 1, which no double is
  CHECK_THAT(toml_error("period_s = 9007199254740993"), Catch::Contains("period_s must be from 0.001 to 1, not 9"));
  CHECK_THAT(toml_error("period_s = = 3"), Catch::StartsWith("kenaf.toml:1:12: "));
  for (const std::string header : {"[!a]", "[", "[[=]]", "[\x01]"})
    CHECK_THAT(toml_error(header), Catch::StartsWith("kenaf.toml:1:"));
}

TEST_CASE("The environment overrides the file") {
  const kenaf::support::TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "mine.toml";
  std::ofstream(file) << "period_s = 0.02\ncommand_timeout_s = 1\n";
  hrt_config config = default_config();
  load_config(environment_of({{"KENAF_CONFIG", file.string()},
                              {"KENAF_PERIOD_S", "0.005"},
                              {"KENAF_LOCKSTEP", "false"},
                              {"KENAF_RESET_ROBOT", "0"},
                              {"KENAF_RELAY", "127.0.0.1:1"},
                              {"KENAF_ROBOT", "marmotte"}}),
              config);
  CHECK(config.period_s == 0.005);
  CHECK(config.command_timeout_s == 1);
  CHECK(config.lockstep == 0);
  CHECK(config.reset_robot == 0);
  CHECK(std::string(config.relay) == "127.0.0.1:1");
  CHECK(std::string(config.robot) == "marmotte");
}

TEST_CASE("The variables have the same names in every locale") {
  // a Turkish i has its dot as a capital too
  if (std::setlocale(LC_CTYPE, "tr_TR.UTF-8") == nullptr) {
    WARN("skipped: there is no locale tr_TR.UTF-8");
    return;
  }
  hrt_config config = default_config();
  apply_environment(environment_of({{"KENAF_PERIOD_S", "0.02"}}), config);
  std::setlocale(LC_CTYPE, "C");
  CHECK(config.period_s == 0.02);
}

TEST_CASE("A personal file applies where nothing else does, and a named file must be there") {
  const kenaf::support::TemporaryFolder home;
  std::filesystem::create_directories(home.path() / ".config/kenaf");
  std::ofstream(home.path() / ".config/kenaf/kenaf.toml") << "period_s = 0.04\n";
  hrt_config config = default_config();
  load_config(environment_of({{"HOME", home.path().string()}}), config);
  CHECK(config.period_s == 0.04);
  const Environment missing = environment_of({{"KENAF_CONFIG", (home.path() / "none.toml").string()}});
  CHECK_THROWS_WITH(load_config(missing, config), Catch::Contains("none.toml: cannot be read"));
  const Environment folder = environment_of({{"KENAF_CONFIG", home.path().string()}});
  try {
    load_config(folder, config);
    FAIL("a folder was taken for a file");
  } catch (const Error& error) {
    CHECK(error.code() == HRT_E_CONFIG);
    CHECK_THAT(error.what(), Catch::StartsWith(home.path().string() + ": cannot be read: Is a directory"));
  }
  std::ofstream(home.path() / "empty.toml").flush();
  load_config(environment_of({{"KENAF_CONFIG", (home.path() / "empty.toml").string()}}), config);
  CHECK(config.period_s == 0.04);
}

TEST_CASE("What is wrong in the environment is named by its variable") {
  CHECK(environment_error({{"KENAF_PERIOD_S", "1e9"}}) ==
        "environment variable KENAF_PERIOD_S: period_s must be from 0.001 to 1, not 1000000000");
  CHECK_THAT(environment_error({{"KENAF_PERIOD_S", "0.01s"}}), Catch::Contains("'0.01s' is not a number"));
  CHECK_THAT(environment_error({{"KENAF_PERIOD_S", ""}}), Catch::Contains("'' is not a number"));
  CHECK_THAT(environment_error({{"KENAF_LOCKSTEP", "maybe"}}), Catch::Contains("'maybe' is neither true nor false"));
  CHECK_THAT(environment_error({{"KENAF_ROBOT", ""}}), Catch::Contains("KENAF_ROBOT: robot must not be empty"));
  CHECK_THAT(environment_error({{"KENAF_RELAY", std::string(500, 'x')}}), Catch::Contains("at most 127 bytes"));
}

TEST_CASE("A cycle longer than the commands' timeout is refused, wherever the two come from") {
  const std::string both = "period_s, 0.2, must not be above command_timeout_s, 0.1";
  hrt_config config = default_config();
  const hrt_config before = config;
  try {
    load_config(environment_of({{"KENAF_PERIOD_S", "0.2"}}), config);
    FAIL("it was taken");
  } catch (const Error& error) {
    CHECK(error.code() == HRT_E_CONFIG);
    CHECK_THAT(error.what(), Catch::StartsWith(both));
    CHECK(std::memcmp(&config, &before, sizeof config) == 0);
  }
  load_config(environment_of({{"KENAF_PERIOD_S", "0.2"}, {"KENAF_COMMAND_TIMEOUT_S", "0.2"}}), config);
  CHECK(config.period_s == 0.2);
  config = hrt_config_default();
  config.period_s = 0.2;
  CHECK(hrt_kenaf_init_with(&config) == HRT_E_ARGUMENT);
  CHECK_THAT(hrt_last_error(), Catch::StartsWith(both));
}

TEST_CASE("A config that a program made up is refused, member by member") {
  hrt_config config = hrt_config_default();
  config.stuck_time_s = 0;
  CHECK(hrt_kenaf_init_with(&config) == HRT_E_ARGUMENT);
  CHECK_THAT(hrt_last_error(), Catch::Contains("stuck_time_s must be from 0.1 to 60"));
  config = hrt_config_default();
  std::memset(config.relay, 'x', sizeof config.relay);
  CHECK(hrt_kenaf_init_with(&config) == HRT_E_ARGUMENT);
  CHECK_THAT(hrt_last_error(), Catch::Contains("relay has no terminating zero"));
  config = hrt_config_default();
  config.robot[0] = '\0';
  CHECK(hrt_kenaf_init_with(&config) == HRT_E_ARGUMENT);
  hrt_config zero;
  std::memset(&zero, 0, sizeof zero);
  CHECK(hrt_kenaf_init_with(&zero) == HRT_E_ARGUMENT);
  CHECK_THAT(hrt_last_error(), Catch::Contains("hrt_config_default()"));
  CHECK(hrt_config_fill(&zero) == HRT_E_ARGUMENT);
  CHECK(hrt_config_fill(nullptr) == HRT_E_ARGUMENT);
  CHECK(hrt_config_load(nullptr) == HRT_E_ARGUMENT);
  CHECK(hrt_config_load(&zero) == HRT_E_ARGUMENT);
  CHECK(hrt_kenaf_init_with(nullptr) == HRT_E_ARGUMENT);
}
