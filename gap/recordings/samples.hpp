// The values of a recording at the sources of a mapping, and what became of all else in it.
//
// Thread safety: pure functions; one thread at a time uses a recording.
#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "gap/recordings/mapping.hpp"
#include "gap/recordings/message_definition.hpp"
#include "gap/recordings/recording.hpp"
#include "gap/recordings/table.hpp"

namespace kenaf::gap::recordings {

// Limit of memory, chosen: 2^24 values with their times are 268 MB.
inline constexpr std::size_t kMostSamples = std::size_t{1} << 24;

struct Samples {
  std::vector<double> t_s;    // since the recording's first log time, or a table's first time; strictly increasing
  std::vector<double> value;  // finite, in the unit of the recording
};

// Messages or cells that gave no value.
struct NotUnderstood {
  std::string from;  // the source
  std::uint64_t count;
  std::string first_reason;
};

struct TopicCount {
  std::string name, type;
  std::uint64_t count;  // of messages or values that were visited
};

struct Collected {
  std::map<Source, Samples> samples;
  std::vector<TopicCount> used, unused;  // topics or columns
  std::vector<NotUnderstood> not_understood;
  std::vector<std::string> remarks;  // of the recording and its visit
};

struct CollectOptions {
  DefinitionTexts definitions;  // of messages, beside those of the recording
  // The part that counts, since the first log time.
  double from_s = -std::numeric_limits<double>::infinity(), to_s = std::numeric_limits<double>::infinity();
};

// Visits the recording once. Messages before `from_s` and after `to_s`, by log time, do not count. Throws
// RecordingError if a source names no topic of the recording, or a path that its messages cannot have; if there are
// more than kMostSamples values; if the times of a source go back by more than 1 s and three of their median steps, as
// of two drives in one file. Values that come less out of order are sorted, with a remark.
Collected collect(const Recording& recording, std::span<const Source> sources, const CollectOptions& options,
                  const TellProgress& tell);
// The same of a table, whose times are in `time_column` in units of `time_unit_s`. Throws RecordingError if a column is
// missing.
Collected collect(const Table& table, std::span<const Source> sources, const std::string& time_column,
                  double time_unit_s, const CollectOptions& options);

}  // namespace kenaf::gap::recordings
