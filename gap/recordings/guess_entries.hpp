// Entries of a mapping, guessed by the names in a recording. For guess.cpp.
//
// Thread safety: values and pure functions.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "gap/recordings/survey.hpp"

namespace kenaf::gap::recordings {

// A source for a column of a run.
struct ColumnGuess {
  std::string column, from;
  std::string unit;        // as units.hpp has it
  std::string why, check;  // check: what a person has to look at; empty: nothing beyond the values
  bool unit_is_sure;       // the message's definition or the name says it
  const SurveyedTopic* topic;
  int rank;  // of several sources for one column the highest is taken
};

struct DriveGuess {
  bool commanded;
  std::string v, w;
  std::string why, check;
  const SurveyedTopic* topic;
  int rank;
};

struct PoseGuess {
  TablePose pose;  // with `from` of sources as columns
  std::string why, check;
  const SurveyedTopic* topic;
  int rank;              // below 0: no measurement of the body, as wheel odometry
  bool asks_up = false;  // whether the form says which axis points up
};

struct GuessedEntries {
  std::map<std::string, ColumnGuess> columns;  // by column, the best of each
  std::map<bool, DriveGuess> drives;           // by `commanded`
  std::vector<PoseGuess> poses;                // the best first
};

GuessedEntries guess_entries(const Survey& survey);

}  // namespace kenaf::gap::recordings
