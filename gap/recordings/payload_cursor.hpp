// Reads the serialised fields of a message one after the other: CDR as ROS 2 writes it (OMG DDS-XTypes 1.3, section
// 7.4.3, encoding version 1) or the encoding of ROS 1.
//
// Thread safety: a value.
#pragma once

#include <bit>
#include <cstdint>
#include <string_view>

#include "gap/recordings/byte_cursor.hpp"
#include "gap/recordings/message_definition.hpp"

namespace kenaf::gap::recordings {

class PayloadCursor {
 public:
  // Throws RecordingError if the head of 4 bytes is missing or names another encoding than plain CDR of version 1.
  static PayloadCursor of_cdr(std::string_view bytes);
  static PayloadCursor of_ros1(std::string_view bytes);

  // Each throws RecordingError if the message ends before. A time is returned in seconds.
  double number(FieldKind kind);
  std::int64_t time_ns();  // of ROS 1: FieldKind::time
  std::uint32_t length();  // of a sequence
  std::string_view text();
  // Skips `count` numbers or texts of a kind that is no message. Throws RecordingError for wstring, whose characters
  // have 2 bytes with some writers and 4 with others.
  void skip(FieldKind kind, std::uint64_t count);

  bool is_cdr() const { return aligned_; }
  std::size_t left() const { return cursor_.left(); }

 private:
  PayloadCursor(std::string_view bytes, std::endian order, bool aligned)
      : cursor_(bytes), order_(order), aligned_(aligned) {}
  void align(std::size_t size);
  template <class Number>
  Number read();

  ByteCursor cursor_;
  std::endian order_;
  bool aligned_;  // CDR: each number lies at a multiple of its size
};

}  // namespace kenaf::gap::recordings
