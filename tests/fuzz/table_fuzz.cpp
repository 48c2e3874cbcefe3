// Any text as a table of another program: it is read or refused with words, and a mapping that is guessed can be used.
#include "gap/recordings/table.hpp"
#include "tests/fuzz/recording_input.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace kenaf;
  using namespace kenaf::gap::recordings;
  if (size > 65536) return 0;
  try {
    const Table table = parse_table({reinterpret_cast<const char*>(data), size}, "table");
    for (const std::vector<double>& column : table.values)
      if (column.size() != table.row_count()) __builtin_trap();
    fuzz::import_as_guessed(survey(table), [&table](const Mapping& mapping) {
      return collect(table, sources_of(mapping), mapping.time_column, mapping.time_unit_s, {});
    });
  } catch (const RecordingError& error) {
    if (!std::string_view(error.what()).starts_with("table")) __builtin_trap();
  }
  return 0;
}
