#include "formats/runs/port_file.hpp"

#include <algorithm>
#include <atomic>
#include <catch2/catch.hpp>
#include <iterator>
#include <thread>

#include "formats/runs/run_file.hpp"
#include "tests/formats/runs/temporary_folder.hpp"

using namespace kenaf::runs;
using kenaf::test::read_file;
using kenaf::test::TemporaryFolder;

TEST_CASE("A port file holds the port and a line feed, whatever it held before, and nothing lies beside it") {
  const TemporaryFolder folder;
  kenaf::test::write_file(folder / "port", "a line that is longer than a port\n");
  write_port_file(folder / "port", 45454);
  CHECK(read_file(folder / "port") == "45454\n");
  write_port_file(folder / "port", 7);
  CHECK(read_file(folder / "port") == "7\n");
  CHECK(std::distance(std::filesystem::directory_iterator(folder.path()), {}) == 1);
}

TEST_CASE("A reader of a port file never sees half of it") {
  const TemporaryFolder folder;
  write_port_file(folder / "port", 11111);
  std::atomic<bool> ended = false;
  std::thread writer([&] {
    for (int i = 0; i < 50; ++i) write_port_file(folder / "port", i % 2 == 0 ? 22222 : 11111);
    ended = true;
  });
  bool always_whole = true;
  while (!ended) {
    const std::string text = read_file(folder / "port");
    always_whole = always_whole && (text == "11111\n" || text == "22222\n");
  }
  writer.join();
  CHECK(always_whole);
}

TEST_CASE("A port file that cannot be written is named") {
  const TemporaryFolder folder;
  CHECK_THROWS_AS(write_port_file(folder / "missing" / "port", 1), RunFileError);
  CHECK_THROWS_WITH(write_port_file(folder / "missing" / "port", 1),
                    Catch::Contains("port file") && Catch::Contains("missing/port"));
}
