// Reads the SQLite files of rosbag2: tables `topics` and `messages`, and `message_definitions` where the recorder wrote
// them (from ROS 2 Iron on).
//
// Thread safety: as recording.hpp.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "gap/recordings/recording.hpp"

namespace kenaf::gap::recordings {

bool begins_as_sqlite(std::string_view bytes);

// Opens the file for reading alone; nothing in it is run: its schema is not trusted, and tables that are views or
// virtual are refused. Messages that are packed by zstd one by one are unpacked. Throws RecordingError with SQLite's
// words.
Recording open_sqlite_bag(const std::filesystem::path& file);
Recording open_sqlite_bag_in_memory(std::string bytes);

}  // namespace kenaf::gap::recordings
