// dataset.toml: what is read, what is refused and where, and that what is written reads back.
#include <catch2/catch.hpp>
#include <fstream>

#include "formats/runs/dataset.hpp"
#include "tests/formats/runs/temporary_folder.hpp"

using namespace kenaf::runs;
using kenaf::test::read_file;
using kenaf::test::TemporaryFolder;

namespace {

// The example of docs/logs.md.
const std::string kExample = R"(format = "kenaf-runs/1"
source = "real"
robot  = "kenaf"
world  = "flat"
description = "Step of 200 mm, dry concrete"
operator_shift = 3

[noise]
x_m = 0.002
y_m = 1

[[run]]
file = "run-000.csv"
manoeuvre = "step-200-flippers"
world = "step-200"

[[run]]
file = "more/run-001.csv"
)";

std::string refusal_of(const std::string& text) {
  try {
    parse_dataset(text, "dataset.toml");
  } catch (const RunFileError& error) {
    return error.what();
  }
  return "accepted";
}

// The example with one text replaced by another.
std::string changed(const std::string& from, const std::string& to) {
  std::string text = kExample;
  return text.replace(text.find(from), from.size(), to);
}

}  // namespace

TEST_CASE("The example is read, keys it does not know are ignored") {
  const Dataset dataset = parse_dataset(kExample, "dataset.toml");
  CHECK(dataset.source == "real");
  CHECK(dataset.robot == "kenaf");
  CHECK(dataset.world == "flat");
  CHECK(dataset.description == "Step of 200 mm, dry concrete");
  CHECK(dataset.noise == std::map<std::string, double>{{"x_m", 0.002}, {"y_m", 1.0}});
  REQUIRE(dataset.runs.size() == 2);
  CHECK(dataset.runs[0].file == "run-000.csv");
  CHECK(dataset.runs[0].manoeuvre == "step-200-flippers");
  CHECK(dataset.runs[0].world == "step-200");
  CHECK(dataset.runs[1].manoeuvre.empty());
  CHECK(dataset.runs[1].world.empty());
}

TEST_CASE("What is refused of dataset.toml, with its line and column") {
  CHECK_THAT(refusal_of("format = \n"), Catch::StartsWith("dataset.toml:1:10: "));
  CHECK_THAT(refusal_of(changed("kenaf-runs/1", "kenaf-runs/9")),
             Catch::StartsWith("dataset.toml:1:10: format is 'kenaf-runs/9'"));
  CHECK_THAT(refusal_of(changed("\"real\"", "\"guess\"")), Catch::StartsWith("dataset.toml:2:10: source is neither"));
  CHECK_THAT(refusal_of(changed("robot  =", "robots =")), Catch::Contains("the key 'robot' is missing"));
  CHECK_THAT(refusal_of(changed("\"flat\"", "7")), Catch::StartsWith("dataset.toml:4:10: 'world' is not a string"));
  CHECK_THAT(refusal_of(changed("\"flat\"", "\"\"")), Catch::StartsWith("dataset.toml:4:10: 'world' is empty"));
  CHECK_THAT(refusal_of(changed("0.002", "-0.002")), Catch::StartsWith("dataset.toml:9:7: the noise of 'x_m'"));
  CHECK_THAT(refusal_of(changed("0.002", "nan")), Catch::StartsWith("dataset.toml:9:7: the noise of 'x_m'"));
  CHECK_THAT(refusal_of(changed("0.002", "\"little\"")), Catch::StartsWith("dataset.toml:9:7: the noise of 'x_m'"));
  CHECK_THAT(refusal_of(changed("more/run-001.csv", "run-000.csv")), Catch::Contains("is already a run"));
  CHECK_THAT(refusal_of(changed("more/run-001.csv", "./run-000.csv")), Catch::Contains("is already a run"));
  CHECK_THAT(refusal_of(changed("more/run-001.csv", "../run.csv")),
             Catch::StartsWith("dataset.toml:18:8: '../run.csv' is outside"));
  CHECK_THAT(refusal_of(changed("more/run-001.csv", "/run.csv")), Catch::Contains("is outside"));
  CHECK_THAT(refusal_of(kExample.substr(0, kExample.find("[[run]]"))), Catch::Contains("no [[run]]"));
  CHECK_THAT(refusal_of(changed("[noise]", "[[noise]]")), Catch::Contains("'noise' is not a table"));
  CHECK_THAT(refusal_of("run = 3\n" + kExample.substr(0, kExample.find("[[run]]"))),
             Catch::StartsWith("dataset.toml:1:7: 'run'"));
  CHECK_THROWS_WITH(read_dataset("/no/such/folder"), Catch::Contains("/no/such/folder/dataset.toml: cannot be opened"));
}

TEST_CASE("A run in place of a dataset's folder is named, with the command that makes a dataset of it") {
  const TemporaryFolder folder;
  std::ofstream(folder / "run.csv") << "t_s\n0\n";
  CHECK_THROWS_WITH(read_dataset(folder / "run.csv"),
                    Catch::Contains("run.csv: is a file") && Catch::Contains("kenaf-gap dataset run.csv --manoeuvre"));
}

TEST_CASE("What is written reads back, whatever its texts hold") {
  const TemporaryFolder folder;
  const Dataset dataset{"sim",
                        "my \"robot\".toml",
                        "C:\\worlds\\a.sdf",
                        "two\nlines, a tab\t, ''' and \"\"\", ü, \x01",
                        {{"x_m", 0.1}, {"odd column", 1e-9}, {"yaw_rad", 3}},
                        {{"run-000.csv", "square", ""}, {"run-001.csv", "", "boxes", "it left the \"world\""}}};
  write_dataset(folder / "new/dataset", dataset);
  const Dataset again = read_dataset(folder / "new/dataset");
  CHECK(again.source == dataset.source);
  CHECK(again.robot == dataset.robot);
  CHECK(again.world == dataset.world);
  CHECK(again.description == dataset.description);
  CHECK(again.noise == dataset.noise);
  REQUIRE(again.runs.size() == 2);
  CHECK(again.runs[0].manoeuvre == "square");
  CHECK(again.runs[1].world == "boxes");
  CHECK(again.runs[0].fault.empty());
  CHECK(again.runs[1].fault == dataset.runs[1].fault);
  CHECK_FALSE(std::filesystem::exists(folder / "new/dataset/dataset.toml.part"));
}

TEST_CASE("A dataset that could not be read back is not written") {
  const TemporaryFolder folder;
  CHECK_THROWS_AS(write_dataset(folder.path(), Dataset{"sim", "kenaf", "flat", "", {}, {}}), RunFileError);
  CHECK_FALSE(std::filesystem::exists(folder / "dataset.toml"));
}

TEST_CASE("A dataset that a full disk does not take leaves nothing behind") {
  if (!std::filesystem::exists("/dev/full")) return;
  const TemporaryFolder folder;
  kenaf::test::write_file(folder / "dataset.toml", "of before");
  std::filesystem::create_symlink("/dev/full", folder / "dataset.toml.part");
  const Dataset dataset{"sim", "kenaf", "flat", "", {}, {{"run-000.csv", "square", ""}}};
  CHECK_THROWS_WITH(write_dataset(folder.path(), dataset), Catch::Contains("No space left"));
  CHECK_FALSE(std::filesystem::is_symlink(folder / "dataset.toml.part"));
  CHECK(kenaf::test::read_file(folder / "dataset.toml") == "of before");
}

TEST_CASE("A file beside dataset.toml becomes its path, a shipped name stays") {
  CHECK(resolve_beside("data/real", "mine.toml", ".toml") == "data/real/mine.toml");
  CHECK(resolve_beside("data/real", "/etc/mine.toml", ".toml") == "/etc/mine.toml");
  CHECK(resolve_beside("data/real", "kenaf", ".toml") == "kenaf");
}

TEST_CASE("The file dataset.toml in place of its folder is named with the folder") {
  const TemporaryFolder folder;
  std::ofstream(folder / "dataset.toml") << kExample;
  CHECK_THROWS_WITH(read_dataset(folder / "dataset.toml"),
                    Catch::EndsWith("is the file of a dataset; give its folder, " + folder.path().string()));
  CHECK(folder_of_dataset(folder / "dataset.toml") == folder.path());
  CHECK(folder_of_dataset(folder.path()) == folder.path());
  CHECK(folder_of_dataset("no/such/dataset.toml") == "no/such/dataset.toml");
}
