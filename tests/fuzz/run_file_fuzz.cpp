// A run file is read or refused with a place in its text; a dataset.toml likewise.
#include <cstdint>
#include <cstdlib>
#include <string>

#include "formats/runs/dataset.hpp"
#include "formats/runs/run_file.hpp"

namespace {

template <class Read>
void read_or_refuse(Read read) {
  try {
    read();
  } catch (const kenaf::runs::RunFileError& error) {
    if (!std::string(error.what()).starts_with("input:")) std::abort();
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace kenaf::runs;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  read_or_refuse([text] {
    const Run run = parse_run(text, "input");
    if (run.column("t_s").size() != run.row_count() || run.columns.size() != run.values.size()) std::abort();
  });
  read_or_refuse([text] { parse_dataset(text, "input"); });
  return 0;
}
