// Answers of a server of camera pictures: any bytes give answers within the limits, or one error; what a note says is
// as its header promises, and is written as it was read.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <stdexcept>
#include <string>

#include "formats/protocol/image_message.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace kenaf::protocol::image;
  if (size == 0) return 0;
  // The first byte says in which pieces the rest arrives.
  const std::size_t piece = std::size_t{data[0]} + 1;
  const std::span<const std::uint8_t> stream(data + 1, size - 1);
  AnswerReader reader;
  try {
    for (std::size_t at = 0; at < stream.size(); at += piece) {
      std::span<const std::uint8_t> bytes = stream.subspan(at, std::min(piece, stream.size() - at));
      while (reader.take(bytes)) {
        const Answer& answer = reader.answer;
        if (answer.data.size() > stream.size() || (answer.type > kMaxJpegType && answer.type != kRefused)) std::abort();
        if (const auto raw = read_raw_picture(answer.data)) {
          if (raw->rgb.size() != std::size_t{3} * static_cast<std::size_t>(raw->width * raw->height)) std::abort();
        }
        (void)is_whole_jpeg(answer.data);
        if (const auto note = read_frame_note(answer.data)) {
          if (!std::isfinite(note->robot_time_s) || note->robot_time_s < 0 || !(note->age_ms >= 0)) std::abort();
        }
      }
      if (!bytes.empty()) std::abort();
    }
  } catch (const std::runtime_error&) {
  }
  if (const auto note = read_frame_note(stream); note && note->robot_time_s < 1e15 && note->age_ms < 1e15) {
    std::string again = "\xff\xd8" + frame_note_segment(*note);
    const auto second = read_frame_note({reinterpret_cast<const std::uint8_t*>(again.data()), again.size()});
    if (!second || second->number != note->number || second->camera != note->camera || second->robot != note->robot)
      std::abort();
  }
  return 0;
}
