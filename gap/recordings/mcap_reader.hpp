// Reads MCAP files (mcap.dev/spec, version 0): with an index and without, cut off at the end, with messages in chunks
// or bare, chunks packed by lz4 or zstd.
//
// Thread safety: as recording.hpp.
#pragma once

#include <string_view>

#include "gap/recordings/byte_source.hpp"
#include "gap/recordings/recording.hpp"

namespace kenaf::gap::recordings {

bool begins_as_mcap(std::string_view bytes);

// Goes through the heads of all records. If the summary at the end is missing, wrong by its checksum or says nothing of
// the channels, it also reads all chunks once, for topics and counts. Chunks whose checksum is wrong or that cannot be
// unpacked are left out with a remark when they are visited. Throws RecordingError if `source` is no MCAP file or has
// more than 2^20 chunks.
Recording open_mcap(const ByteSource& source);

}  // namespace kenaf::gap::recordings
