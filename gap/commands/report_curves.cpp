#include "gap/commands/report_curves.hpp"

#include <fmt/format.h>

#include "gap/diagnose/report.hpp"
#include "gap/recordings/table_channels.hpp"

namespace kenaf::gap::commands {
namespace {

recordings::Table table_of(const runs::Run& run) {
  recordings::Table table;
  table.columns = run.columns;
  table.values = run.values;
  table.time_column = "t_s";
  return table;
}

}  // namespace

void write_report_curves(const diagnose::Diagnosis& diagnosis, const std::filesystem::path& file) {
  recordings::McapWriter writer(file);
  for (const diagnose::ShownRun& shown : diagnose::shown_runs(diagnosis)) {
    const std::string name = std::filesystem::path(shown.file).stem().string();
    const auto write = [&](const runs::Run& run, const char* kind) {
      recordings::write_table(writer, table_of(run), fmt::format("/{}/{}/", name, kind));
    };
    write(shown.real, "real");
    write(shown.nominal, "nominal");
    if (shown.corrected) write(*shown.corrected, "corrected");
  }
  writer.finish();
}

}  // namespace kenaf::gap::commands
