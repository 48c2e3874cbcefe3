// What the fuzzers of recordings do with one that was opened: visit it, read its messages, guess a mapping, import by
// it.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "formats/description/description_error.hpp"
#include "gap/recordings/guess.hpp"
#include "gap/recordings/make_run.hpp"
#include "gap/recordings/message_reader.hpp"
#include "gap/recordings/recording.hpp"
#include "gap/recordings/recording_error.hpp"

namespace kenaf::fuzz {

// A mapping that was guessed can be read, up to the radius that a person has to fill in; a run by it has whole columns.
template <class Collect>
void import_as_guessed(const gap::recordings::Survey& survey, const Collect& collect) {
  using namespace gap::recordings;
  const Guess guess = guess_mapping(survey, {"recording", "", nullptr});
  if (guess.entries == 0) return;
  try {
    const Mapping mapping = parse_mapping(guess.toml, "guessed");
    const MadeRun made = make_run(mapping, collect(mapping), 0.4);
    for (const std::vector<double>& column : made.run.values)
      if (column.size() != made.run.row_count()) __builtin_trap();
  } catch (const description::DescriptionError& error) {
    if (std::string_view(error.what()).find("radius_m") == std::string_view::npos &&
        std::string_view(error.what()).find("time_column") == std::string_view::npos)
      __builtin_trap();
  } catch (const RecordingError& error) {
    if (std::string_view(error.what()).empty()) __builtin_trap();
  }
}

inline void use_recording(const gap::recordings::Recording& recording) {
  using namespace gap::recordings;
  std::uint64_t visited = 0;
  recording.visit(
      [&](const Message& message) {
        if (message.topic >= recording.topics.size()) __builtin_trap();
        // reads all bytes, so that the sanitizer sees them
        std::uint64_t sum = 0;
        for (const char c : message.bytes) sum += static_cast<unsigned char>(c);
        return sum != UINT64_MAX && ++visited < 10000;
      },
      {});
  import_as_guessed(survey(recording, {}, {}),
                    [&recording](const Mapping& mapping) { return collect(recording, sources_of(mapping), {}, {}); });
}

// Opens and uses a recording, or sees it refused with words.
template <class Open>
void use_or_refuse(const Open& open) {
  try {
    use_recording(open());
  } catch (const gap::recordings::RecordingError& error) {
    if (std::string_view(error.what()).empty()) __builtin_trap();
  }
}

}  // namespace kenaf::fuzz
