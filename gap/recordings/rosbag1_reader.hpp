// Reads bags of ROS 1 (wiki.ros.org/Bags/Format/2.0): with an index and without, cut off at the end, chunks packed by
// bz2 or lz4.
//
// Thread safety: as recording.hpp.
#pragma once

#include <string_view>

#include "gap/recordings/byte_source.hpp"
#include "gap/recordings/recording.hpp"

namespace kenaf::gap::recordings {

bool begins_as_rosbag1(std::string_view bytes);  // of any version

// Goes through the heads of all records. Chunks of which the index says nothing are also read once, for connections and
// counts. Chunks that cannot be unpacked are left out with a remark when they are visited. Throws RecordingError if
// `source` is no bag of version 2.0, is encrypted, or has more than 2^20 chunks.
Recording open_rosbag1(const ByteSource& source);

}  // namespace kenaf::gap::recordings
