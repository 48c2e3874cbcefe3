// Runs: what is read, what is refused and where, and that what is written reads back as the same bits.
#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <limits>

#include "formats/runs/run_file.hpp"
#include "tests/formats/runs/temporary_folder.hpp"

using namespace kenaf::runs;
using kenaf::test::read_file;
using kenaf::test::TemporaryFolder;

namespace {

constexpr double kNotMeasured = std::numeric_limits<double>::quiet_NaN();

std::string refusal_of_run(std::string_view text) {
  try {
    parse_run(text, "run.csv");
  } catch (const RunFileError& error) {
    return error.what();
  }
  return "accepted";
}

std::vector<double> values(std::span<const double> column) {
  return {column.begin(), column.end()};
}

}  // namespace

TEST_CASE("Columns, empty cells and unknown columns") {
  const Run run = parse_run("t_s,x_m,battery_temperature_c\n0,0.5,21\n0.01,,21.5\n0.02,-1e-3,\n", "run.csv");
  CHECK(run.row_count() == 3);
  CHECK(values(run.column("t_s")) == std::vector<double>{0, 0.01, 0.02});
  CHECK(run.column("x_m")[0] == 0.5);
  CHECK(std::isnan(run.column("x_m")[1]));
  CHECK(run.column("x_m")[2] == -0.001);
  CHECK(run.column("battery_temperature_c")[1] == 21.5);
  CHECK(run.column("y_m").empty());
}

TEST_CASE("Blanks, line ends of Windows, a byte order mark, a plus and empty lines at the end") {
  const Run run = parse_run("\xEF\xBB\xBFt_s , x_m\r\n 0 , +1.5\r\n1,2\r\n\r\n  \n", "run.csv");
  CHECK(run.columns == std::vector<std::string>{"t_s", "x_m"});
  CHECK(values(run.column("x_m")) == std::vector<double>{1.5, 2});
}

TEST_CASE("Quotes of RFC 4180: around names and cells, doubled inside, with separators inside") {
  const Run run = parse_run("\"t_s\",\"x \"\"best\"\", m\" , y_m\n\"0\",\"1.5\",\n 0.1 ,\"\",\"-2e1\"\n", "run.csv");
  CHECK(run.columns == std::vector<std::string>{"t_s", "x \"best\", m", "y_m"});
  CHECK(values(run.column("t_s")) == std::vector<double>{0, 0.1});
  CHECK(run.values[1][0] == 1.5);
  CHECK(std::isnan(run.values[1][1]));
  CHECK(run.column("y_m")[1] == -20);
  CHECK(run.reading.empty());
  // errors count columns from the quote's content, and an open quote is part of the cell
  CHECK_THAT(refusal_of_run("t_s,x_m\n0,\"n.a.\"\n"), Catch::StartsWith("run.csv:2:4: 'n.a.' in column 'x_m'"));
  CHECK_THAT(refusal_of_run("t_s,x_m\n0,\"1\n"), Catch::StartsWith("run.csv:2:3: '\"1' in column 'x_m'"));
}

TEST_CASE("Semicolons or tabs between the cells, decimal commas, and what is said of them") {
  for (const std::string separator : {";", "\t"}) {
    const auto text = [&](std::string of_commas) {
      for (std::size_t at; (at = of_commas.find('|')) != of_commas.npos;) of_commas.replace(at, 1, separator);
      return of_commas;
    };
    const std::string words = separator == ";" ? "semicolons between the cells" : "tabs between the cells";
    const Run points = parse_run(text("x_m|t_s\n0.5|0\n|1\n"), "run.csv");
    CHECK(points.columns == std::vector<std::string>{"x_m", "t_s"});
    CHECK(points.column("x_m")[0] == 0.5);
    CHECK(std::isnan(points.column("x_m")[1]));
    CHECK(points.reading == words);
    const Run commas = parse_run(text("t_s|x_m\r\n12,345|-0,5\r\n13|1,5e-1\r\n"), "run.csv");
    CHECK(values(commas.column("t_s")) == std::vector<double>{12.345, 13});
    CHECK(values(commas.column("x_m")) == std::vector<double>{-0.5, 0.15});
    CHECK(commas.reading == words + ", decimal commas");
    CHECK_THAT(refusal_of_run(text("t_s|x_m\n0|1|2\n")),
               Catch::Contains("3 cells") && Catch::Contains(words.substr(0, 4)));
    CHECK_THAT(
        refusal_of_run(text("t_s|x_m\n0,5|1\n1,5|0.5\n")),
        Catch::StartsWith("run.csv:3:5: '0.5' in column 'x_m' has another decimal mark than the numbers before"));
    CHECK_THAT(refusal_of_run(text("t_s|x_m\n0|1.234,5\n")), Catch::Contains("is not a finite number"));
  }
  // in quotes a decimal comma is none between cells
  const Run quoted = parse_run("t_s,x_m\n\"0,5\",\"1,25\"\n", "run.csv");
  CHECK(quoted.column("x_m")[0] == 1.25);
  CHECK(quoted.reading == "decimal commas");
  // without them nobody knows which comma is which
  CHECK_THAT(refusal_of_run("t_s,x_m\n0,5,1,25\n"),
             Catch::StartsWith("run.csv:2:5: the row has 4 cells, but the first line names 2 columns; numbers with "
                               "decimal commas need semicolons between the cells, or quotes"));
}

TEST_CASE("Comments before the header are left out, and lines counted with them") {
  const Run run = parse_run("\xEF\xBB\xBF# a log of 2024; t_s in seconds\n#\nt_s,x_m\n0,1\n", "run.csv");
  CHECK(run.columns == std::vector<std::string>{"t_s", "x_m"});
  CHECK(run.row_count() == 1);
  CHECK(run.first_line == 4);
  CHECK(parse_run("t_s\n0\n", "run.csv").first_line == 2);
  CHECK_THAT(refusal_of_run("# one\nt_s,x_m\n0\n"),
             Catch::StartsWith("run.csv:3:2: the row has 1 cells, but the header in line 2 names 2 columns"));
  CHECK_THAT(refusal_of_run("t_s,x_m\n# two\n0,1\n"), Catch::StartsWith("run.csv:2:"));
  CHECK_THAT(refusal_of_run("# only\n"), Catch::Contains("the file is empty"));
}

TEST_CASE("Times in nanoseconds, microseconds or milliseconds become seconds where there is no doubt") {
  // ten rows from `first` on, `step` apart
  const auto rows = [](double first, double step) {
    std::string text = "t_s,x_m\n";
    for (int i = 0; i < 10; ++i) text += std::to_string(first + i * step) + ",1\n";
    return parse_run(text, "run.csv");
  };
  const Run since_1970 = rows(1.7e18, 1e7);
  CHECK(since_1970.column("t_s").front() == 1.7e9);
  CHECK(since_1970.column("t_s").back() == Approx(1.7e9 + 0.09).epsilon(0).margin(1e-6));
  CHECK(since_1970.reading == "t_s in nanoseconds since 1970 converted to seconds");
  CHECK(rows(1.7e15, 1e4).reading == "t_s in microseconds since 1970 converted to seconds");
  CHECK(rows(1.7e12, 10).reading == "t_s in milliseconds since 1970 converted to seconds");
  CHECK(rows(1.7e12, 10).column("t_s")[1] == 1.7e9 + 0.01);
  // since the computer was started
  CHECK(rows(5e12, 1e7).reading == "t_s in nanoseconds converted to seconds");
  CHECK(rows(5e12, 1e7).column("t_s")[1] == 5000.01);
  CHECK(rows(5e9, 2e4).reading == "t_s in microseconds converted to seconds");
  CHECK(rows(0, 50).column("t_s")[3] == 0.15);
  // seconds; a step that may be one of two units
  CHECK(rows(1.7e9, 0.01).reading.empty());
  CHECK(rows(0, 0.5).reading.empty());
  CHECK(rows(0, 10).reading.empty());
  CHECK(rows(0, 1000).reading.empty());
  CHECK(rows(0, 1000).column("t_s")[1] == 1000);
}

TEST_CASE("A file that is cut off in the middle of a row is read without that row, whose line is named") {
  for (const std::string rest : {"1", "1,", "1,2", "1,2,-", "1,2,1e-"}) {
    const Run run = parse_run("t_s,x_m,y_m\n0,1,2\n" + rest, "run.csv");
    INFO(rest);
    CHECK(values(run.column("t_s")) == std::vector<double>{0});
    CHECK(run.reading == "line 3 left out, where the file is cut off within cell " +
                             std::to_string(1 + std::ranges::count(rest, ',')) + " of 3");
  }
  CHECK(parse_run("t_s,x_m,y_m\n0,1,2\n1,2,", "run.csv").row_count() == 2);
  CHECK(parse_run("t_s;x_m\n0,5;1\n1", "run.csv").reading ==
        "semicolons between the cells, decimal commas, line 3 left out, where the file is cut off within cell 1 of 2");
  // with its line's end a short row is an error of whoever wrote it; so are too many cells, and words in the middle
  CHECK_THAT(refusal_of_run("t_s,x_m,y_m\n0,1,2\n1,2\n"), Catch::StartsWith("run.csv:3:4: the row has 2 cells"));
  CHECK_THAT(refusal_of_run("t_s,x_m\n0,1\n1,2,3"), Catch::StartsWith("run.csv:3:5: the row has 3 cells"));
  CHECK_THAT(refusal_of_run("t_s,x_m,y_m\n0,1,2\n1,n.a.,3"), Catch::StartsWith("run.csv:3:3: 'n.a.'"));
}

TEST_CASE("A last line without its end is a row, a header alone is a run without rows") {
  CHECK(parse_run("t_s\n0\n1", "run.csv").row_count() == 2);
  CHECK(parse_run("t_s,x_m", "run.csv").row_count() == 0);
}

TEST_CASE("What is refused of a run, with its line and column") {
  CHECK_THAT(refusal_of_run(""), Catch::StartsWith("run.csv:1:1: the file is empty"));
  CHECK_THAT(refusal_of_run("x_m,y_m\n"), Catch::StartsWith("run.csv:1:1: no column t_s"));
  CHECK_THAT(refusal_of_run("t_s,x_m,x_m\n"), Catch::StartsWith("run.csv:1:9: the column 'x_m' is named twice"));
  CHECK_THAT(refusal_of_run("t_s,,x_m\n"), Catch::StartsWith("run.csv:1:5: a column without a name"));
  CHECK_THAT(refusal_of_run("t_s,x_m\n0,1\n0.1,n.a.\n"), Catch::StartsWith("run.csv:3:5: 'n.a.' in column 'x_m'"));
  CHECK_THAT(refusal_of_run("t_s,x_m\n0, nan\n"), Catch::StartsWith("run.csv:2:4: 'nan'"));
  CHECK_THAT(refusal_of_run("t_s,x_m\n0,inf\n"), Catch::StartsWith("run.csv:2:3: 'inf'"));
  CHECK_THAT(refusal_of_run("t_s,x_m\n0,1e999\n"), Catch::StartsWith("run.csv:2:3:"));
  CHECK_THAT(refusal_of_run("t_s,x_m\n0,1,2\n"), Catch::StartsWith("run.csv:2:5: the row has 3 cells"));
  CHECK_THAT(refusal_of_run("t_s,x_m\n0\n"), Catch::StartsWith("run.csv:2:2: the row has 1 cells"));
  CHECK_THAT(refusal_of_run("t_s,x_m\n0,1\n\n1,2\n"), Catch::StartsWith("run.csv:3:1: the row has 1 cells"));
  CHECK_THAT(refusal_of_run("x_m,t_s\n1,\n"), Catch::StartsWith("run.csv:2:3: the row has no time"));
  CHECK_THAT(refusal_of_run("x_m,t_s\n1,0.5\n1,0.5\n"), Catch::StartsWith("run.csv:3:3: t_s does not increase"));
  CHECK_THAT(refusal_of_run("t_s\n2\n1\n"), Catch::StartsWith("run.csv:3:1: t_s does not increase"));
  CHECK_THAT(refusal_of_run("t_s,a\rb\n"), Catch::StartsWith("run.csv:1:5: a column name contains a line end"));
  // A decimal comma makes one cell too many, and that is what is said.
  CHECK_THAT(refusal_of_run("t_s,x_m\n0,0,5\n"), Catch::Contains("3 cells"));
}

TEST_CASE("A file that is not there or cannot be read is named") {
  const TemporaryFolder folder;
  CHECK_THROWS_WITH(read_run(folder / "none.csv"), Catch::Contains("none.csv: cannot be opened: No such file"));
  CHECK_THROWS_WITH(read_run(folder.path()), Catch::Contains("cannot be read: Is a directory"));
}

TEST_CASE("What is written reads back as the same bits, and empty cells stay empty") {
  const TemporaryFolder folder;
  const std::vector<std::vector<double>> rows{{0, 0.1, -0.0},
                                              {0.01, 1.0 / 3, kNotMeasured},
                                              {0.02, 5e-324, 1.7976931348623157e308},
                                              {1e9, -2.5e-7, 123456789.123}};
  RunWriter writer(folder / "run.csv", {"t_s", "x_m", "y_m"});
  for (const auto& row : rows) writer.add_row(row);
  writer.finish();
  const Run run = read_run(folder / "run.csv");
  REQUIRE(run.row_count() == rows.size());
  for (std::size_t row = 0; row < rows.size(); ++row) {
    for (std::size_t column = 0; column < 3; ++column) {
      if (std::isnan(rows[row][column])) {
        CHECK(std::isnan(run.values[column][row]));
      } else {
        CHECK(std::memcmp(&run.values[column][row], &rows[row][column], sizeof(double)) == 0);
      }
    }
  }
  CHECK(read_file(folder / "run.csv").starts_with("t_s,x_m,y_m\n0,0.1,-0\n0.01,0.3333333333333333,\n"));
}

TEST_CASE("Names of columns that the reader takes are written as they are") {
  const TemporaryFolder folder;
  const std::string text = "t_s,\"speed of 1\" track\",it's,caf\xC3\xA9 (m/s)\n0,1,2,3\n";
  write_run(folder / "run.csv", parse_run(text, "run.csv"));
  CHECK(read_file(folder / "run.csv") == text);
}

TEST_CASE("Names with commas, quotes around them or a first # are written in quotes and read back") {
  const TemporaryFolder folder;
  const std::vector<std::string> names{"#", "t_s", "x, m", "\"x\"", "a\"b"};
  RunWriter writer(folder / "run.csv", names);
  const double row[] = {1, 2, 3, 4, 5};
  writer.add_row(row);
  writer.finish();
  CHECK(read_file(folder / "run.csv") == "\"#\",t_s,\"x, m\",\"\"\"x\"\"\",a\"b\n1,2,3,4,5\n");
  CHECK(read_run(folder / "run.csv").columns == names);
}

TEST_CASE("The file is whole or absent, an interrupted run leaves its rows in the part file") {
  const TemporaryFolder folder;
  {
    RunWriter writer(folder / "run.csv", {"t_s"});
    const double row[] = {1};
    writer.add_row(row);
    CHECK_FALSE(std::filesystem::exists(folder / "run.csv"));
    CHECK(read_file(folder / "run.csv.part") == "t_s\n1\n");
  }
  CHECK_FALSE(std::filesystem::exists(folder / "run.csv"));
  CHECK(std::filesystem::exists(folder / "run.csv.part"));

  RunWriter again(folder / "run.csv", {"t_s"});
  again.finish();
  again.finish();
  CHECK(read_file(folder / "run.csv") == "t_s\n");
  CHECK_FALSE(std::filesystem::exists(folder / "run.csv.part"));
  const double row[] = {2};
  CHECK_THROWS_AS(again.add_row(row), RunFileError);
}

TEST_CASE("The writer refuses what the reader would refuse, and goes on") {
  const TemporaryFolder folder;
  CHECK_THROWS_AS(RunWriter(folder / "a.csv", {"x_m"}), RunFileError);
  CHECK_THROWS_AS(RunWriter(folder / "a.csv", {"t_s", "t_s"}), RunFileError);
  CHECK_THROWS_AS(RunWriter(folder / "a.csv", {"t_s", "x\nm"}), RunFileError);
  CHECK_THROWS_AS(RunWriter(folder / "a.csv", {"t_s", "x\rm"}), RunFileError);
  CHECK_THROWS_AS(RunWriter(folder / "a.csv", {"t_s", " x_m"}), RunFileError);
  CHECK_THROWS_AS(RunWriter(folder / "no/such/folder/a.csv", {"t_s"}), RunFileError);

  RunWriter writer(folder / "run.csv", {"t_s", "x_m"});
  const auto add = [&writer](std::vector<double> row) { writer.add_row(row); };
  add({0, 1});
  CHECK_THROWS_AS(add({1}), RunFileError);
  CHECK_THROWS_AS(add({0, 1}), RunFileError);
  CHECK_THROWS_AS(add({kNotMeasured, 1}), RunFileError);
  CHECK_THROWS_AS(add({1, std::numeric_limits<double>::infinity()}), RunFileError);
  add({1, 2});
  writer.finish();
  CHECK(read_file(folder / "run.csv") == "t_s,x_m\n0,1\n1,2\n");
}

TEST_CASE("A full disk is an error, and the file does not appear") {
  if (!std::filesystem::exists("/dev/full")) return;
  const TemporaryFolder folder;
  std::filesystem::create_symlink("/dev/full", folder / "run.csv.part");
  CHECK_THROWS_WITH(RunWriter(folder / "run.csv", {"t_s"}), Catch::Contains("No space left"));
  CHECK_FALSE(std::filesystem::exists(folder / "run.csv"));
}

TEST_CASE("A run is read the same in pieces as at once, wherever a piece ends") {
  // More than one piece of 64 KiB: the rows get longer, so that ends fall everywhere in them.
  std::string text = "t_s,x_m\r\n";
  for (int i = 0; i < 20000; ++i)
    text +=
        std::to_string(i) + "," + std::string(static_cast<std::size_t>(i % 7), ' ') + std::to_string(i * i) + "\r\n";
  const TemporaryFolder folder;
  kenaf::test::write_file(folder / "run.csv", text);
  const Run whole = parse_run(text, "run.csv"), pieces = read_run(folder / "run.csv");
  CHECK(pieces.columns == whole.columns);
  CHECK(pieces.values == whole.values);
  kenaf::test::write_file(folder / "run.csv", text + "20000,wrong\n");
  CHECK_THROWS_WITH(read_run(folder / "run.csv"), Catch::Contains("run.csv:20002:7: 'wrong' in column 'x_m'"));
}

TEST_CASE("What is too large for memory is refused before it fills it") {
  // A thousand columns in 16778 rows are 2^24 values and more.
  std::string header = "t_s", cells;
  for (int i = 1; i < 1000; ++i) header += ",c" + std::to_string(i), cells += ',';
  std::string text = header + "\n";
  for (int i = 0; i < 16778; ++i) text += std::to_string(i) + cells + "\n";
  CHECK_THROWS_WITH(parse_run(text, "long.csv"), Catch::Contains("long.csv:16779:1: more than 16777216 values"));
  // No line end at all, as in a file that is none.
  CHECK_THROWS_WITH(parse_run(std::string(2 << 20, '7'), "none.csv"),
                    Catch::Contains("none.csv:1:") && Catch::Contains("too long"));
}
