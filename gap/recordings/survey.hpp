// A look at a recording's numbers before it is mapped: the first messages of each topic, the columns of a
// table.
//
// Thread safety: pure functions; one thread at a time uses a recording.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "gap/recordings/message_definition.hpp"
#include "gap/recordings/recording.hpp"
#include "gap/recordings/table.hpp"

namespace kenaf::gap::recordings {

// A number of the messages of a topic, or a column.
struct Signal {
  std::string from;  // as a mapping names it
  std::string path;  // behind the topic; of a column its name
  double least = 0, most = 0;
};

struct SurveyedTopic {
  Topic topic;
  std::string not_understood;  // why its messages cannot be read; empty: they can
  std::vector<Signal> signals;
  double rate_hz = 0;  // messages over the time of the recording
  // How long after their stamps messages are recorded, the median in seconds; empty: they have none, or zeros.
  std::optional<double> log_after_stamp_s{};
};

struct Survey {
  std::string form;
  double duration_s = 0;
  std::vector<SurveyedTopic> topics;  // of a table one without a name, whose signals are all columns
  // The rest is a table's alone.
  std::string time_column, time_unit;
  std::vector<TablePose> poses;
  std::vector<std::string> remarks;
};

// Reads the first messages of each topic (200, chosen) and ends when it has them all.
Survey survey(const Recording& recording, const DefinitionTexts& definitions, const TellProgress& tell);
Survey survey(const Table& table);

}  // namespace kenaf::gap::recordings
