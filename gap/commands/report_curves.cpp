#include "gap/commands/report_curves.hpp"

#include <fmt/format.h>

#include "gap/diagnose/page/overlays.hpp"
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
  for (const diagnose::Overlay& overlay : diagnose::simulate_overlays(diagnosis)) {
    const diagnose::Observation& measured = diagnosis.observations.runs[overlay.run];
    const auto write = [&](const runs::Run& run, const char* kind) {
      const std::string name = std::filesystem::path(measured.file).stem().string();
      recordings::write_table(writer, table_of(run), fmt::format("/{}/{}/", name, kind));
    };
    write(measured.run, "real");
    write(overlay.nominal, "nominal");
    if (overlay.corrected) write(*overlay.corrected, "corrected");
  }
  writer.finish();
}

}  // namespace kenaf::gap::commands
