// Tables, runs among them, as channels of an MCAP file.
//
// Thread safety: one thread at a time uses a writer.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "gap/recordings/mcap_writer.hpp"
#include "gap/recordings/table.hpp"

namespace kenaf::gap::recordings {

struct WrittenTable {
  std::vector<std::string> topics;
  std::uint64_t messages = 0;
  std::uint64_t rows_without_time = 0;  // left out
};

// Writes a table with a channel for each group of sensors: "commands", "tracks", "flippers", "battery", "pose", "imu"
// and others of the columns in robot/columns.hpp, "other" of all else; each topic after `prefix`, which ends in '/'.
// A row is a message in each group that has values in it; empty cells are left out of it. Units are in the schemas. The
// log time is the row's time; where a table begins before 0, its first time becomes 0. Throws RecordingError if the
// table has no column of time.
WrittenTable write_table(McapWriter& writer, const Table& table, const std::string& prefix);

}  // namespace kenaf::gap::recordings
