// A recording of another program: its topics, and their messages one after the other.
//
// Thread safety: one thread at a time uses a recording.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace kenaf::gap::recordings {

struct Topic {
  std::string name;              // "/cmd_vel"
  std::string type;              // of its messages: "geometry_msgs/msg/Twist"; empty if the file does not say
  std::string message_encoding;  // "cdr", "ros1", "json" or another
  std::string schema_encoding;   // "ros2msg", "ros1msg", "jsonschema", "ros2idl" or another; empty: no schema
  std::string schema;            // the definition of the type
  std::uint64_t count = 0;       // of its messages, as far as the file's index is right
};

struct Message {
  std::size_t topic;       // in Recording::topics
  std::int64_t log_ns;     // when it was recorded, on the recorder's clock, usually since 1970
  std::string_view bytes;  // until the callback returns
};

// Takes one message; returns false to end the visit.
using TakeMessage = std::function<bool(const Message&)>;
// Told from time to time which share of the recording has been visited, 0 to 1.
using TellProgress = std::function<void(double)>;

struct Recording {
  std::string form;  // for people and mappings: "MCAP", "rosbag2 (SQLite)", "rosbag 1"
  std::vector<Topic> topics;
  std::int64_t first_ns = 0, last_ns = 0;  // log times; both 0 without messages
  // Parts of the file that are wrong or cannot be read: "3 attachments are not read".
  std::vector<std::string> remarks;
  // Visits all messages in the order of log time. Memory does not grow with the file: see time_order.hpp. Returns
  // remarks on what could not be read, each with its place and count. Throws RecordingError if the file cannot be read.
  std::function<std::vector<std::string>(const TakeMessage&, const TellProgress&)> visit;
};

// Takes the times of a part of the recording into first_ns and last_ns. Both 0: the part has no messages.
void widen_times(Recording& recording, std::int64_t first_ns, std::int64_t last_ns);

// The topic's place in `topics`, after it was added if none has its name, type and encodings. Throws RecordingError
// beyond 10000 topics.
std::size_t topic_index(std::vector<Topic>& topics, const Topic& topic);

// Opens an MCAP file, a rosbag of ROS 1, an SQLite file of rosbag2, any of them packed by zstd as a whole, or a folder
// of rosbag2. Recognises them by their content. Throws RecordingError with the file's name if it is none of them,
// its head is damaged or it is beyond the limits of the readers. A file that is cut off is read as far as it goes.
Recording open_recording(const std::filesystem::path& path);

// Whether open_recording() would take it: others are text.
bool is_recording(const std::filesystem::path& path);

}  // namespace kenaf::gap::recordings
