// Any mapping is read or refused with a place; a run by it is made of the same few samples, or refused with words.
#include "gap/recordings/mapping.hpp"

#include "formats/description/description_error.hpp"
#include "gap/recordings/make_run.hpp"
#include "gap/recordings/recording_error.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace kenaf::gap::recordings;
  if (size > 8192) return 0;
  try {
    const Mapping mapping = parse_mapping({reinterpret_cast<const char*>(data), size}, "input");
    Collected collected;
    for (const Source& source : sources_of(mapping))
      collected.samples[source] = {{0, 0.5, 1, 1.5, 4}, {0.6, -0.1, 0.2, 0.5, -3}};
    const MadeRun made = make_run(mapping, collected, 0.4);
    if (made.run.columns.size() != made.run.values.size() || made.run.column("t_s").front() != 0) __builtin_trap();
  } catch (const kenaf::description::DescriptionError& error) {
    if (!std::string_view(error.what()).starts_with("input:")) __builtin_trap();
  } catch (const RecordingError& error) {
    if (std::string_view(error.what()).empty()) __builtin_trap();
  }
  return 0;
}
