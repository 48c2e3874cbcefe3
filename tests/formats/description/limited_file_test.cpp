// A path that names anything but a file of moderate size is refused at once. A reader that waited for a pipe or read a
// device to its end would hang here.
#include <sys/stat.h>

#include <catch2/catch.hpp>

#include "formats/description/description_error.hpp"
#include "formats/description/description_file.hpp"
#include "formats/description/limited_file.hpp"
#include "tests/formats/runs/temporary_folder.hpp"

using namespace kenaf::description;
using Catch::Contains;
using kenaf::test::TemporaryFolder;
using kenaf::test::write_file;
namespace fs = std::filesystem;

TEST_CASE("A file is read whole, up to the limit and not beyond") {
  const TemporaryFolder folder;
  write_file(folder / "a", std::string(10000, 'x'));
  CHECK(read_limited_file(folder / "a", 10000) == std::string(10000, 'x'));
  CHECK_THROWS_WITH(read_limited_file(folder / "a", 9999), "is larger than 9999 bytes");
  write_file(folder / "empty", "");
  CHECK(read_limited_file(folder / "empty", 0).empty());
  fs::create_symlink(folder / "a", folder / "link");
  CHECK(read_limited_file(folder / "link", 10000).size() == 10000);
}

TEST_CASE("A file that states no size is read to its end, up to the limit") {
  CHECK_THAT(read_limited_file("/proc/self/status", 1U << 20U), Contains("Pid:"));
  CHECK_THROWS_AS(read_limited_file("/proc/self/status", 10), DescriptionError);
}

TEST_CASE("Devices, pipes and folders are no files") {
  const TemporaryFolder folder;
  REQUIRE(::mkfifo((folder / "pipe").c_str(), 0600) == 0);
  fs::create_symlink("/dev/zero", folder / "endless");
  for (const fs::path& path : {folder / "pipe", folder / "endless", folder.path()})
    CHECK_THROWS_WITH(read_limited_file(path, 1U << 20U), Contains("is a folder, device, pipe or socket, not a file"));
}

TEST_CASE("What is not there or loops is said so") {
  const TemporaryFolder folder;
  CHECK_THROWS_WITH(read_limited_file(folder / "none", 10), "cannot be read: No such file or directory");
  fs::create_symlink(folder / "loop", folder / "loop");
  CHECK_THROWS_WITH(read_limited_file(folder / "loop", 10), Contains("cannot be read: "));
}

TEST_CASE("A description of 1 GB is refused with its path") {
  const TemporaryFolder folder;
  write_file(folder / "huge.sdf", "");
  fs::resize_file(folder / "huge.sdf", std::uintmax_t{1} << 30U);  // sparse: takes no disk
  CHECK_THROWS_WITH(read_description_file("world", (folder / "huge.sdf").string(), ".sdf"),
                    Contains("huge.sdf: is larger than 16 MiB"));
}
