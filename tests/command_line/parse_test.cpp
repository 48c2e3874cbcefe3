// The convention of all command lines, at a program of this test's own: status, and the words on standard error.
#include "command_line/parse.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <catch2/catch.hpp>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "command_line/checks.hpp"

using namespace kenaf::command_line;

namespace {

// What is written to a stream of this process while it lives.
class Captured {
 public:
  explicit Captured(int stream) : stream_(stream), before_(::dup(stream)), file_(std::tmpfile()) {
    std::fflush(nullptr);
    ::dup2(::fileno(file_), stream_);
  }
  ~Captured() {
    restore();
    ::close(before_);
    std::fclose(file_);
  }
  Captured(const Captured&) = delete;
  Captured& operator=(const Captured&) = delete;

  std::string text() {
    restore();
    std::rewind(file_);
    std::string out;
    for (int c = std::fgetc(file_); c != EOF; c = std::fgetc(file_)) out += static_cast<char>(c);
    return out;
  }

 private:
  void restore() const {
    std::fflush(nullptr);
    ::dup2(before_, stream_);
  }
  int stream_, before_;
  std::FILE* file_;
};

struct Answer {
  std::optional<int> status;
  std::string error;
};

struct Values {
  double speed = 1;
  int port = 1;
  std::string world, level = "info", dialect = "udk", out, file;
  std::vector<double> pose;
  bool ideal = false, embedded = false;
};

// A program with options of all kinds, and two subcommands.
Answer run(std::vector<const char*> arguments, Values& values) {
  CLI::App app("A program", "prog");
  app.add_option("--speed", values.speed)->check(number_in(0, 10));
  app.add_option("--port", values.port)->check(whole_number(0, 65535));
  auto* world = app.add_option("--world", values.world);
  app.add_option("--log-level", values.level)->transform(log_level());
  app.add_option("--dialect", values.dialect)->check(one_of({"ut2004", "udk"}));
  app.add_option("--pose", values.pose)->delimiter(',')->expected(6)->check(number_in(-1, 1));
  auto* embedded = app.add_flag("--embedded", values.embedded);
  app.add_flag("--ideal", values.ideal)->excludes(world)->needs(embedded);
  app.add_option("--name", values.out)->check(not_empty());
  app.add_option("--size", values.file)->check(readable_by([](const std::string& text) {
    if (text != "1x1") throw std::runtime_error("must be 1x1");
  }));
  CLI::App* make = app.add_subcommand("make", "makes");
  make->add_option("FILE", values.file);
  make->add_option("--out", values.out)->required();
  app.add_subcommand("merge", "merges");
  arguments.insert(arguments.begin(), "prog");
  Captured error(STDERR_FILENO);
  const auto status = parse(app, static_cast<int>(arguments.size()), arguments.data());
  return {status, error.text()};
}

Answer run(const std::vector<const char*>& arguments) {
  Values values;
  return run(arguments, values);
}

}  // namespace

TEST_CASE("A right command line goes on, and says nothing") {
  Values values;
  const Answer answer = run({"--speed", "2.5", "--port=0", "--log-level", "warning", "--pose", "0,0,0,0,0,-0.5",
                             "--dialect", "ut2004", "--embedded", "--ideal", "--size", "1x1"},
                            values);
  CHECK_FALSE(answer.status);
  CHECK(answer.error.empty());
  CHECK(values.speed == 2.5);
  CHECK(values.port == 0);
  CHECK(values.level == "warn");
  CHECK(values.pose.back() == -0.5);
  CHECK(values.ideal);
}

TEST_CASE("What is wrong is said on one line, where to look on the next, and the status is 2") {
  struct Case {
    std::vector<const char*> arguments;
    std::string words;
  };
  for (const Case& c : std::vector<Case>{
           // words that do not exist
           {{"--sped", "1"}, "--sped: no such option; did you mean --speed?"},
           {{"--sped=1"}, "--sped: no such option; did you mean --speed?"},
           {{"--Port", "1"}, "--Port: no such option; did you mean --port?"},
           {{"-port", "1"}, "-port: no such option; did you mean --port?"},
           {{"--xyzzy"}, "--xyzzy: no such option"},
           {{"mak"}, "mak: no such subcommand; did you mean make?"},
           {{"xyzzy"}, "xyzzy: no such subcommand; a subcommand is required: make or merge"},
           {{"merge", "a"}, "merge takes options only; not expected: a"},
           {{"make", "--out", "o", "a", "b"}, "make takes one argument beside its options; not expected: b"},
           // numbers
           {{"--speed", "fast"}, "--speed fast: must be a number from 0 to 10"},
           {{"--speed", "-1"}, "--speed -1: must be a number from 0 to 10"},
           {{"--speed", "nan"}, "--speed nan: must be a number from 0 to 10"},
           {{"--speed", "inf"}, "--speed inf: must be a number from 0 to 10"},
           {{"--speed", "-inf"}, "--speed -inf: must be a number from 0 to 10"},
           {{"--speed", "1e999"}, "--speed 1e999: must be a number from 0 to 10"},
           {{"--speed", "0x1"}, "--speed 0x1: must be a number from 0 to 10"},
           {{"--speed", ""}, "--speed '': must be a number from 0 to 10"},
           {{"--speed", "1 "}, "--speed '1 ': must be a number from 0 to 10"},
           {{"--port", "65536"}, "--port 65536: must be a whole number from 0 to 65535"},
           {{"--port", "-1"}, "--port -1: must be a whole number from 0 to 65535"},
           {{"--port", "010"}, "--port 010: must be a whole number from 0 to 65535"},
           {{"--port", "1.5"}, "--port 1.5: must be a whole number from 0 to 65535"},
           {{"--port", "99999999999999999999"}, "--port 99999999999999999999: must be a whole number from 0 to 65535"},
           {{"--pose", "0,0,0,0,0,2"}, "--pose 2: must be a number from -1 to 1"},
           {{"--pose", "0,0,0"}, "--pose: needs 6 values, not 3"},
           // words of a list
           {{"--dialect", "ukd"}, "--dialect ukd: must be ut2004 or udk; did you mean udk?"},
           {{"--dialect", "usarsim"}, "--dialect usarsim: must be ut2004 or udk"},
           {{"--log-level", "loud"}, "--log-level loud: must be trace, debug, info, warn, error or off"},
           {{"--log-level", "eror"},
            "--log-level eror: must be trace, debug, info, warn, error or off; did you mean error?"},
           // other readers
           {{"--size", "2x2"}, "--size 2x2: must be 1x1"},
           {{"--name", ""}, "--name '': must not be empty"},
           // values that are missing, and too many
           {{"--port"}, "--port: needs a value"},
           {{"--world", "--embedded"}, "--world: needs a value"},
           {{"--world=", "--embedded"}, "--world: needs a value"},
           {{"--port="}, "--port: needs a value"},
           {{"--port", "1", "--port", "2"}, "--port: given 2 times, but takes one value"},
           {{"--embedded=perhaps"}, "--embedded: takes no value"},
           // options that need or exclude others
           {{"--ideal"}, "--ideal requires --embedded"},
           {{"--ideal", "--embedded", "--world", "w"}, "--world excludes --ideal"}}) {
    CAPTURE(c.words);
    const Answer answer = run(c.arguments);
    CHECK(answer.status == 2);
    CHECK_THAT(answer.error, Catch::StartsWith("prog: " + c.words + "\nprog"));
    CHECK_THAT(answer.error, Catch::EndsWith("options\n"));
  }
}

TEST_CASE("The second line names the command that was given") {
  CHECK(run({"make", "--outt", "o"}).error ==
        "prog: --outt: no such option; did you mean --out?\nprog make --help lists the options\n");
  CHECK(run({"make"}).error == "prog: --out is required\nprog make --help lists the options\n");
  CHECK(run({"--xyzzy"}).error == "prog: --xyzzy: no such option\nprog --help lists the subcommands and options\n");
}

TEST_CASE("After -- an argument is a value, whatever it begins with") {
  Values values;
  CHECK_FALSE(run({"make", "--out", "o", "--", "--odd"}, values).status);
  CHECK(values.file == "--odd");
}

TEST_CASE("Help and version are on standard output, with status 0, even beside what is wrong") {
  for (const std::vector<const char*>& arguments : std::vector<std::vector<const char*>>{
           {"--help"}, {"-h"}, {"--version"}, {"--help", "--sped"}, {"make", "--help"}}) {
    CAPTURE(arguments.front());
    Captured out(STDOUT_FILENO);
    const Answer answer = run(arguments);
    CHECK(answer.status == 0);
    CHECK(answer.error.empty());
    CHECK_FALSE(out.text().empty());
  }
}

TEST_CASE("A variable that does not exist is wrong use, but does not keep anybody from help") {
  REQUIRE(::setenv("KENAF_RELYA", "127.0.0.1:1", 1) == 0);
  const Answer answer = run({"--speed", "1"});
  CHECK(answer.status == 2);
  CHECK_THAT(answer.error, Catch::StartsWith("prog: environment variable KENAF_RELYA is not known; did you mean "
                                             "KENAF_RELAY?\n"));
  {
    Captured out(STDOUT_FILENO);
    CHECK(run({"--help"}).status == 0);
  }
  REQUIRE(::unsetenv("KENAF_RELYA") == 0);
}
