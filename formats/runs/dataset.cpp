#include "formats/runs/dataset.hpp"

#include <toml++/toml.h>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <set>
#include <system_error>

#include "formats/runs/whole_file.hpp"

namespace kenaf::runs {

namespace {

namespace fs = std::filesystem;

constexpr std::string_view kFileName = "dataset.toml";
constexpr std::string_view kFormat = "kenaf-runs/1";

// Reads the keys of one table; every error names the place in the file.
class TableReader {
 public:
  TableReader(const toml::table& table, std::string_view file) : table_(table), file_(file) {}

  [[noreturn]] void fail(const toml::node& node, const std::string& what) const {
    const toml::source_position at = node.source().begin;
    throw RunFileError(std::string(file_) + ":" + std::to_string(at.line) + ":" + std::to_string(at.column) + ": " +
                       what);
  }

  std::string text(std::string_view key) const {
    std::optional<std::string> found = optional_text(key);
    if (!found) fail(table_, "the key '" + std::string(key) + "' is missing");
    if (found->empty()) fail(*table_.get(key), "'" + std::string(key) + "' is empty");
    return *found;
  }

  std::optional<std::string> optional_text(std::string_view key) const {
    const toml::node* node = table_.get(key);
    if (node == nullptr) return std::nullopt;
    if (!node->is_string()) fail(*node, "'" + std::string(key) + "' is not a string in quotes");
    return node->as_string()->get();
  }

  const toml::node* find(std::string_view key) const { return table_.get(key); }

 private:
  const toml::table& table_;
  std::string_view file_;
};

std::map<std::string, double> read_noise(const TableReader& reader) {
  std::map<std::string, double> noise;
  const toml::node* node = reader.find("noise");
  if (node == nullptr) return noise;
  if (!node->is_table()) reader.fail(*node, "'noise' is not a table; write [noise] and below it x_m = 0.002");
  for (const auto& [column, value] : *node->as_table()) {
    const std::optional<double> sigma = value.is_number() ? value.value<double>() : std::nullopt;
    if (!sigma || !std::isfinite(*sigma) || *sigma <= 0) {
      reader.fail(value, "the noise of '" + std::string(column.str()) + "' is not a positive number");
    }
    noise.emplace(column.str(), *sigma);
  }
  return noise;
}

bool is_dataset_file(const fs::path& path) {
  std::error_code ignored;
  return path.filename() == kFileName && fs::is_regular_file(path, ignored);
}

bool leaves_the_folder(const fs::path& file) {
  const fs::path normal = file.lexically_normal();
  return file.is_absolute() || normal.empty() || *normal.begin() == "..";
}

DatasetRun read_run_entry(const toml::table& table, std::string_view file) {
  const TableReader reader(table, file);
  DatasetRun run{reader.text("file"), reader.optional_text("manoeuvre").value_or(""),
                 reader.optional_text("world").value_or(""), reader.optional_text("fault").value_or("")};
  if (leaves_the_folder(run.file)) reader.fail(*reader.find("file"), "'" + run.file + "' is outside of the dataset");
  return run;
}

std::vector<DatasetRun> read_runs(const TableReader& reader, const toml::table& root, std::string_view file) {
  const toml::node* node = reader.find("run");
  if (node == nullptr) reader.fail(root, "the dataset has no [[run]]");
  const toml::array* entries = node->as_array();
  if (entries == nullptr || entries->empty())
    reader.fail(*node, "'run' is not a list of tables; write [[run]] for each run");
  std::vector<DatasetRun> runs;
  std::set<std::string> files;
  for (const toml::node& entry : *entries) {
    if (!entry.is_table()) reader.fail(entry, "'run' is not a list of tables; write [[run]] for each run");
    runs.push_back(read_run_entry(*entry.as_table(), file));
    if (!files.insert(fs::path(runs.back().file).lexically_normal().string()).second)
      reader.fail(entry, "'" + runs.back().file + "' is already a run");
  }
  return runs;
}

// A basic string of TOML. (toml++'s own formatter chooses literal strings, which cannot represent every text.)
std::string as_toml(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    const auto code = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      out.append({'\\', c});
    } else if (code < 0x20 || code == 0x7f) {
      constexpr std::string_view kHexDigits = "0123456789ABCDEF";
      out.append("\\u00").append({kHexDigits[code >> 4], kHexDigits[code & 15]});
    } else {
      out += c;
    }
  }
  return out + '"';
}

// The shortest number that reads back as the same double.
std::string as_toml(double value) {
  std::array<char, 32> digits;
  return {digits.data(), std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr};
}

std::string run_entry(const DatasetRun& run) {
  std::string text = "\n[[run]]\nfile = " + as_toml(run.file) + "\n";
  if (!run.manoeuvre.empty()) text += "manoeuvre = " + as_toml(run.manoeuvre) + "\n";
  if (!run.world.empty()) text += "world = " + as_toml(run.world) + "\n";
  if (!run.fault.empty()) text += "fault = " + as_toml(run.fault) + "\n";
  return text;
}

std::string as_toml_key(const std::string& key) {
  constexpr std::string_view kBare = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-";
  return !key.empty() && key.find_first_not_of(kBare) == std::string::npos ? key : as_toml(key);
}

}  // namespace

fs::path folder_of_dataset(const fs::path& path) {
  if (!is_dataset_file(path)) return path;
  return path.has_parent_path() ? path.parent_path() : fs::path(".");
}

Dataset read_dataset(const fs::path& folder) {
  if (is_dataset_file(folder))
    throw RunFileError(folder.string() + ": is the file of a dataset; give its folder, " +
                       folder_of_dataset(folder).string());
  if (fs::is_regular_file(folder))
    throw RunFileError(folder.string() + ": is a file, not the folder of a dataset; `kenaf-gap dataset " +
                       folder.filename().string() + " --manoeuvre NAME --out FOLDER` makes a dataset of a run");
  const fs::path file = folder / kFileName;
  return parse_dataset(read_whole_file(file), file.string());
}

Dataset parse_dataset(std::string_view toml_text, std::string_view name_for_errors) {
  // Syntax errors get the same form as all others: file:line:column.
  toml::table root;
  try {
    root = toml::parse(toml_text, name_for_errors);
  } catch (const toml::parse_error& error) {
    const toml::source_position at = error.source().begin;
    throw RunFileError(std::string(name_for_errors) + ":" + std::to_string(at.line) + ":" + std::to_string(at.column) +
                       ": " + std::string(error.description()));
  }

  // The format first: the keys of another one mean nothing here.
  const TableReader reader(root, name_for_errors);
  if (const std::string format = reader.text("format"); format != kFormat) {
    reader.fail(*reader.find("format"),
                "format is '" + format + "', this program reads '" + std::string(kFormat) + "'");
  }

  // Keys of the dataset, then its tables.
  Dataset dataset;
  dataset.source = reader.text("source");
  if (dataset.source != "real" && dataset.source != "sim") {
    reader.fail(*reader.find("source"), "source is neither 'real' nor 'sim'");
  }
  dataset.robot = reader.text("robot");
  dataset.world = reader.text("world");
  dataset.description = reader.optional_text("description").value_or("");
  dataset.noise = read_noise(reader);
  dataset.runs = read_runs(reader, root, name_for_errors);
  return dataset;
}

void write_dataset(const fs::path& folder, const Dataset& dataset) {
  std::string text;
  const auto line = [&text](std::string_view key, const std::string& value) {
    text.append(key).append(" = ").append(value).append("\n");
  };
  line("format", as_toml(kFormat));
  line("source", as_toml(dataset.source));
  line("robot", as_toml(dataset.robot));
  line("world", as_toml(dataset.world));
  if (!dataset.description.empty()) line("description", as_toml(dataset.description));
  if (!dataset.noise.empty()) text += "\n[noise]\n";
  for (const auto& [column, sigma] : dataset.noise) line(as_toml_key(column), as_toml(sigma));
  for (const DatasetRun& run : dataset.runs) text += run_entry(run);
  const fs::path file = folder / kFileName;
  parse_dataset(text, file.string());  // throws if it could not be read back

  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw RunFileError(folder.string() + ": cannot be created: " + error.message());
  write_whole_file(file, text);
}

std::string numbered_run_file(std::size_t index) {
  constexpr std::size_t kDigits = 3;
  std::string number = std::to_string(index);
  if (number.size() < kDigits) number.insert(0, kDigits - number.size(), '0');
  return "run-" + number + ".csv";
}

void append_runs(const fs::path& folder, std::span<const DatasetRun> runs) {
  const fs::path file = folder / kFileName;
  std::string text = read_whole_file(file);
  const std::size_t before = parse_dataset(text, file.string()).runs.size();
  if (!text.ends_with('\n')) text += '\n';
  for (const DatasetRun& run : runs) text += run_entry(run);
  if (parse_dataset(text, file.string()).runs.size() != before + runs.size())
    throw RunFileError(file.string() +
                       ": its runs are not [[run]] tables at the end of the file, so none can be added");
  write_whole_file(file, text);
}

std::string resolve_beside(const fs::path& folder, const std::string& name, std::string_view extension) {
  return name.ends_with(extension) ? (folder / name).string() : name;
}

}  // namespace kenaf::runs
