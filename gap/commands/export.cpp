// kenaf-gap export: writes runs as an MCAP file for PlotJuggler and Foxglove.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "formats/runs/dataset.hpp"
#include "gap/commands/commands.hpp"
#include "gap/commands/progress_line.hpp"
#include "gap/recordings/recording_error.hpp"
#include "gap/recordings/table_channels.hpp"

namespace kenaf::gap::commands {
namespace {

namespace fs = std::filesystem;

// The files of the arguments: of a dataset its runs, of a comparison's folder its matched frames.
std::vector<fs::path> exported_files(const std::vector<std::string>& arguments) {
  std::vector<fs::path> files;
  for (const fs::path argument : arguments) {
    if (!fs::is_directory(argument)) {
      files.push_back(argument);
      continue;
    }
    if (fs::exists(argument / "dataset.toml")) {
      for (const runs::DatasetRun& run : runs::read_dataset(argument).runs) files.push_back(argument / run.file);
      continue;
    }
    const std::size_t before = files.size();
    for (const fs::directory_entry& entry : fs::directory_iterator(argument))
      if (entry.path().filename().string().starts_with("matched-")) files.push_back(entry.path());
    std::sort(files.begin() + static_cast<std::ptrdiff_t>(before), files.end());
    if (files.size() == before)
      throw std::runtime_error(argument.string() + ": a folder without dataset.toml and without matched-NNN.csv");
  }
  return files;
}

recordings::Table exported_table(const fs::path& file) {
  recordings::Table table = recordings::read_table(file);
  // The matched frames of a comparison have two times; the real one is that of its figures.
  if (table.time_column.empty() && !table.column("real_t_s").empty()) table.time_column = "real_t_s";
  return table;
}

// The begin of a file's topics: of one file "/", of several each with its name, which no other one has.
std::string prefix_of(const fs::path& file, bool is_only, std::set<std::string>& taken) {
  if (is_only) return "/";
  const std::string name = file.stem().string();
  std::string prefix = "/" + name + "/";
  for (int i = 2; !taken.insert(prefix).second; ++i) prefix = fmt::format("/{}-{}/", name, i);
  return prefix;
}

void write_all(const std::vector<fs::path>& files, const fs::path& out) {
  recordings::McapWriter writer(out);
  std::set<std::string> taken;
  ProgressLine line;
  std::uint64_t messages = 0;
  for (std::size_t i = 0; i < files.size(); ++i) try {
      line.show("writing", static_cast<double>(i) / static_cast<double>(files.size()));
      const recordings::WrittenTable written =
          recordings::write_table(writer, exported_table(files[i]), prefix_of(files[i], files.size() == 1, taken));
      clear_progress_line();
      std::printf("%s:", files[i].c_str());
      for (const std::string& topic : written.topics) std::printf(" %s", topic.c_str());
      if (written.rows_without_time > 0)
        std::printf("; %llu rows without a time are left out",
                    static_cast<unsigned long long>(written.rows_without_time));
      std::printf("\n");
      messages += written.messages;
    } catch (const recordings::RecordingError& error) {
      const std::string what = error.what();
      throw std::runtime_error(what.starts_with(files[i].string()) ? what : files[i].string() + ": " + what);
    }
  writer.finish();
  std::printf("%s: %llu messages\n", out.c_str(), static_cast<unsigned long long>(messages));
}

}  // namespace

void add_export_command(CLI::App& program) {
  struct Options {
    std::vector<std::string> files;
    std::string out;
    bool force = false;
  };
  // Shared with the callback, which runs after this function has returned.
  const auto options = std::make_shared<Options>();
  CLI::App* command = program.add_subcommand("export", "writes runs as an MCAP file, for PlotJuggler and Foxglove");
  command
      ->add_option("FILE", options->files,
                   "runs, other CSV files, datasets, or folders that compare wrote; each file's topics begin with its "
                   "name if there are several; required")
      ->type_name("...");
  command->add_option("--out", options->out, "the MCAP file to write; required")->type_name("FILE");
  command->add_flag("--force", options->force, "replace the output file if it exists");

  command->callback([options] {
    if (options->files.empty()) throw CLI::RequiredError("FILE");
    if (options->out.empty()) throw CLI::RequiredError("--out");
    if (!options->force && fs::exists(options->out))
      throw std::runtime_error(
          fmt::format("{}: exists already; give another file, or --force to replace it", options->out));
    write_all(exported_files(options->files), options->out);
  });
}

}  // namespace kenaf::gap::commands
