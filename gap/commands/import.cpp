// kenaf-gap import: makes a run of a recording of another program.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "command_line/checks.hpp"
#include "formats/runs/whole_file.hpp"
#include "gap/commands/commands.hpp"
#include "gap/commands/progress_line.hpp"
#include "gap/logs/plausibility.hpp"
#include "gap/recordings/guess.hpp"
#include "gap/recordings/make_run.hpp"
#include "gap/recordings/standard_definitions.hpp"

namespace kenaf::gap::commands {
namespace {

namespace fs = std::filesystem;

constexpr double kMostSeconds = 1e9;  // of --from and --to

struct ImportOptions {
  std::string recording, mapping, robot, definitions, out;
  bool guess = false, force = false;
  std::optional<double> from_s, to_s;
};

// A recording, or else a table.
struct Opened {
  std::optional<recordings::Recording> recording;
  std::optional<recordings::Table> table;
  const std::string& form() const { return recording ? recording->form : table->form; }
};

Opened open(const std::string& path) {
  if (!fs::exists(path)) throw std::runtime_error(path + ": no such file or folder");
  Opened opened;
  if (recordings::is_recording(path))
    opened.recording = recordings::open_recording(path);
  else
    opened.table = recordings::read_table(path);
  return opened;
}

// The file that is asked for: in a folder, and where a name without an extension is given, of the recording's name.
fs::path out_file(const ImportOptions& options, const std::string& extension) {
  fs::path out = options.out;
  if (!fs::is_directory(out) && out.has_extension()) return out;
  fs::path recording = fs::path(options.recording).lexically_normal();
  if (recording.filename().empty()) recording = recording.parent_path();
  return out / (recording.stem().string() + extension);
}

void check_is_new(const fs::path& file, bool force) {
  if (!force && fs::exists(file))
    throw std::runtime_error(
        fmt::format("{}: exists already; give another file, or --force to replace it", file.string()));
  if (file.has_parent_path()) fs::create_directories(file.parent_path());
}

recordings::TellProgress teller(ProgressLine& line, const char* doing) {
  return [&line, doing](double done) { line.show(doing, done); };
}

void guess(const ImportOptions& options, const Opened& opened, const recordings::DefinitionTexts& definitions,
           const std::optional<physics::RobotDescription>& robot) {
  ProgressLine line;
  const recordings::Survey seen = opened.recording
                                      ? recordings::survey(*opened.recording, definitions, teller(line, "reading"))
                                      : recordings::survey(*opened.table);
  line.show("reading", 1);
  const recordings::Guess guessed =
      recordings::guess_mapping(seen, {options.recording, options.robot, robot ? &*robot : nullptr});
  if (options.out.empty()) {
    std::fputs(guessed.toml.c_str(), stdout);
    return;
  }
  const fs::path file = out_file(options, ".mapping.toml");
  check_is_new(file, options.force);
  runs::write_whole_file(file, guessed.toml);
  std::printf("%s: %zu entries, %zu lines to CHECK\n", file.c_str(), guessed.entries, guessed.to_check);
}

void print_topics(const char* title, const std::vector<recordings::TopicCount>& topics, bool of_table) {
  if (topics.empty()) return;
  std::printf("%s:\n", title);
  for (const recordings::TopicCount& topic : topics)
    std::printf("  %s%s: %llu %s\n", topic.name.c_str(), topic.type.empty() ? "" : (" (" + topic.type + ")").c_str(),
                static_cast<unsigned long long>(topic.count), of_table ? "numbers" : "messages");
}

void print_summary(const recordings::Collected& collected, bool of_table) {
  print_topics("used", collected.used, of_table);
  print_topics("not used", collected.unused, of_table);
  if (!collected.not_understood.empty()) std::printf("not understood:\n");
  for (const recordings::NotUnderstood& source : collected.not_understood)
    std::printf("  %s: %llu times, first: %s\n", source.from.c_str(), static_cast<unsigned long long>(source.count),
                source.first_reason.c_str());
  for (const std::string& remark : collected.remarks) std::printf("remark: %s\n", remark.c_str());
}

void check_form(const std::string& mapping_file, const recordings::Mapping& mapping, const ImportOptions& options,
                const std::string& form) {
  if (mapping.form == form) return;
  throw std::runtime_error(fmt::format("{}: is for '{}', but {} is '{}'; make another by --guess", mapping_file,
                                       mapping.form, options.recording, form));
}

void print_findings(const runs::Run& run, const fs::path& file, const std::optional<physics::RobotDescription>& robot) {
  for (const logs::Finding& finding : logs::check_run(run, file.string(), robot ? &*robot : nullptr))
    std::printf("%s: %s\n", finding.severity == logs::Finding::Severity::refuse ? "to be refused" : "warning",
                logs::in_words(finding).c_str());
}

void import(const ImportOptions& options, const Opened& opened, const recordings::DefinitionTexts& definitions,
            const std::optional<physics::RobotDescription>& robot) {
  const recordings::Mapping mapping =
      recordings::parse_mapping(runs::read_whole_file(options.mapping), options.mapping);
  check_form(options.mapping, mapping, options, opened.form());
  const fs::path file = out_file(options, ".csv");
  check_is_new(file, options.force);

  // The samples of the mapping's sources, then the rows.
  recordings::CollectOptions collecting{definitions};
  if (options.from_s) collecting.from_s = *options.from_s;
  if (options.to_s) collecting.to_s = *options.to_s;
  const std::vector<recordings::Source> sources = recordings::sources_of(mapping);
  ProgressLine line;
  const recordings::Collected collected =
      opened.recording
          ? recordings::collect(*opened.recording, sources, collecting, teller(line, "reading"))
          : recordings::collect(*opened.table, sources, mapping.time_column, mapping.time_unit_s, collecting);
  line.show("reading", 1);
  print_summary(collected, !opened.recording);
  const recordings::MadeRun made =
      recordings::make_run(mapping, collected, robot ? std::optional(robot->track_gauge_m()) : std::nullopt);
  runs::write_run(file, made.run);

  std::printf("%s: %zu rows, %zu columns, %.3f s\n", file.c_str(), made.run.row_count(), made.run.columns.size(),
              made.run.column("t_s").back());
  for (const std::string& remark : made.remarks) std::printf("  %s\n", remark.c_str());
  if (mapping.columns.empty() && mapping.drives.empty())
    std::printf("a pose alone: kenaf-gap merge adds it to a run of the robot\n");
  else
    print_findings(made.run, file, robot);
}

void check_options(const ImportOptions& options) {
  if (options.recording.empty()) throw CLI::RequiredError("RECORDING");
  if (options.mapping.empty() && !options.guess) throw CLI::RequiredError("--mapping; --guess writes one to check");
  if (!options.mapping.empty() && options.guess) throw CLI::ExcludesError("--mapping", "--guess");
  if (options.out.empty() && !options.guess) throw CLI::RequiredError("--out");
  if (options.to_s && !(*options.to_s > options.from_s.value_or(0)))
    throw std::runtime_error("--to must be after --from");
}

}  // namespace

void add_import_command(CLI::App& program) {
  // Shared with the callback, which runs after this function has returned.
  const auto options = std::make_shared<ImportOptions>();
  CLI::App* command = program.add_subcommand(
      "import", "makes a run of a recording: MCAP, rosbag2, rosbag 1, CSV of other programs, motion capture");
  command
      ->add_option("RECORDING", options->recording,
                   "an MCAP file, a bag, a folder of rosbag2, a CSV or TSV file; required")
      ->type_name("");
  command->add_option("--mapping", options->mapping, "which topic or column becomes which column of the run")
      ->type_name("FILE");
  command->add_flag("--guess", options->guess,
                    "write a mapping that is guessed by names, types and units, for you to check, instead of a run");
  command->add_option("--robot", options->robot,
                      "a shipped name or a TOML file: gauge and sprocket, and limits for the checks");
  command
      ->add_option("--definitions", options->definitions,
                   "folder with PACKAGE/msg/NAME.msg of messages that the recording does not define")
      ->type_name("DIR");
  command
      ->add_option("--out", options->out,
                   "the run, a CSV file, or a folder for it; with --guess the mapping [standard output]")
      ->type_name("FILE");
  command
      ->add_option("--from", options->from_s, "leave out what was recorded before, since the first message [the begin]")
      ->check(command_line::number_in(0, kMostSeconds))
      ->type_name("SECONDS");
  command->add_option("--to", options->to_s, "leave out what was recorded after [the end]")
      ->check(command_line::number_in(0, kMostSeconds))
      ->type_name("SECONDS");
  command->add_flag("--force", options->force, "replace the output file if it exists");

  command->callback([options] {
    check_options(*options);
    std::optional<physics::RobotDescription> robot;
    if (!options->robot.empty()) robot = physics::load_robot(options->robot);
    recordings::DefinitionTexts definitions;
    if (!options->definitions.empty()) definitions = recordings::read_definitions(options->definitions);
    const Opened opened = open(options->recording);
    options->guess ? guess(*options, opened, definitions, robot) : import(*options, opened, definitions, robot);
  });
}

}  // namespace kenaf::gap::commands
