// Definitions of the messages of ROS that robots record most. SQLite files of rosbag2 before ROS 2 Iron hold none.
//
// Thread safety: any thread.
#pragma once

#include <filesystem>

#include "gap/recordings/message_definition.hpp"

namespace kenaf::gap::recordings {

// ROS 2 definitions, with the fields in the order of common_interfaces of 2022 (Humble).
const DefinitionTexts& standard_definitions();

// Reads all files PACKAGE/msg/NAME.msg or PACKAGE/NAME.msg below `folder`, as packages of ROS have them. Throws
// RecordingError if there are none.
DefinitionTexts read_definitions(const std::filesystem::path& folder);

}  // namespace kenaf::gap::recordings
