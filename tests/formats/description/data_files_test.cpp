// Where shipped files are found: $KENAF_DATA_DIR, then the build tree, which links to the source tree.
#include <unistd.h>

#include <catch2/catch.hpp>
#include <cstdlib>
#include <fstream>

#include "formats/description/data_files.hpp"

namespace fs = std::filesystem;
using namespace kenaf;

namespace {

const fs::path kShipped = fs::path(KENAF_SOURCE_DIR) / "share/robots" / "kenaf.toml";

struct DataDir {
  DataDir() {
    fs::create_directories(path / "robots");
    std::ofstream(path / "robots" / "mine.toml") << "name = 'mine'\n";
    ::setenv("KENAF_DATA_DIR", path.c_str(), 1);
  }
  ~DataDir() {
    ::unsetenv("KENAF_DATA_DIR");
    fs::remove_all(path);
  }
  fs::path path = fs::temp_directory_path() / ("kenaf-data-" + std::to_string(::getpid()));
};

}  // namespace

TEST_CASE("A path is taken as it is, whether it exists or not") {
  CHECK(description::find_data_file("robots", "some/where", ".toml") == "some/where");
  CHECK(description::find_data_file("robots", "here.toml", ".toml") == "here.toml");
  CHECK(description::find_data_file("robots", "/no/such/file.toml", ".toml") == "/no/such/file.toml");
}

TEST_CASE("A name is found in the build tree, unless there is none") {
  CHECK(fs::equivalent(description::find_data_file("robots", "kenaf", ".toml"), kShipped));
  CHECK(description::find_data_file("robots", "no-such-robot", ".toml").empty());
  CHECK(description::find_data_file("robots", "", ".toml").empty());
}

TEST_CASE("KENAF_DATA_DIR comes first, and what it lacks is found behind it") {
  const DataDir dir;
  CHECK(description::find_data_file("robots", "mine", ".toml") == dir.path / "robots" / "mine.toml");
  CHECK(fs::equivalent(description::find_data_file("robots", "kenaf", ".toml"), kShipped));
}
