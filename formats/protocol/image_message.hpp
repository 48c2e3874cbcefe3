// The wire format of camera pictures: USARSim's image server (UPIS) with Kenaf's additions. For both ends: libkenaf_sim
// reads answers with it, the world server may write them with it. docs/cameras.md has the page.
//
//   request   'O' 'K'                  the picture, as the server's option says (USARSim)
//             'J'                      the picture, as JPEG
//             'V' u8 n, n bytes UTF-8  selects what the following requests show: "ROBOT/CAMERA", "CAMERA", or "" for
//                                      the default; has no answer
//   answer    u8 type, u32 big-endian size, `size` bytes
//             type 0                   raw: u16 big-endian width, height; rows from the top, blue green red, each row
//                                      padded to 4 bytes
//             type 1 to 5              JPEG
//             type 255                 refused: UTF-8 text that says what there is instead
//
// A JPEG of a Kenaf server has one COM segment (FF FE) directly after SOI, the frame note:
//   kenaf-frame/1 number=%llu robot_time_s=%.6f age_ms=%.3f robot=%s camera=%s
//
// Thread safety: values and pure functions; one AnswerReader for each connection.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace kenaf::protocol::image {

inline constexpr std::size_t kHeaderBytes = 5;
inline constexpr std::size_t kMaxAnswerBytes = std::size_t{64} << 20;  // of data; anything larger is no picture
inline constexpr std::uint8_t kRaw = 0, kMaxJpegType = 5, kRefused = 255;
inline constexpr std::size_t kMaxNameBytes = 255;  // of the name in 'V'

// ---- Requests ----

inline constexpr std::string_view kOldRequest = "OK", kJpegRequest = "J";
// 'V'. Throws std::invalid_argument if `name` has more than kMaxNameBytes bytes.
std::string select_request(std::string_view name);

// ---- Answers ----

struct Answer {
  std::uint8_t type = 0;
  std::vector<std::uint8_t> data;
};

std::array<std::uint8_t, kHeaderBytes> answer_header(std::uint8_t type, std::uint32_t size);

// Splits the byte stream of a connection into answers. Memory grows with the bytes received, not with those that a
// header announces.
class AnswerReader {
 public:
  // Takes bytes up to the end of an answer and removes them from `bytes`. Returns true if `answer` is complete; take it
  // before the next call. Throws std::runtime_error for an invalid type or size; the connection is unusable then.
  bool take(std::span<const std::uint8_t>& bytes);
  Answer answer;                                          // the last complete one, or the beginning of the next
  bool is_between() const { return header_count_ == 0; }  // no byte of the next answer has come

 private:
  std::array<std::uint8_t, kHeaderBytes> header_{};
  std::size_t header_count_ = 0;
  std::size_t size_ = 0;
};

// ---- Frame notes ----

struct FrameNote {
  std::uint64_t number = 0;  // from 1; a gap stands for pictures that were not made in time
  double robot_time_s = 0;   // of the exposure
  double age_ms = 0;         // from the exposure to the sending, wall clock
  std::string robot, camera;
};

// Returns the note of a JPEG, or nullopt if it has no well-formed one: keys in their order, numbers finite and not
// negative. A robot's name may contain blanks; the bytes of names are not checked.
std::optional<FrameNote> read_frame_note(std::span<const std::uint8_t> jpeg);

// The whole COM segment, to be put directly after SOI.
std::string frame_note_segment(const FrameNote& note);

// Whether the data looks like a complete JPEG: SOI at its begin, EOI at its end. Zeros may follow, as video devices
// append them.
bool is_whole_jpeg(std::span<const std::uint8_t> jpeg);

// ---- Raw pictures ----

struct RawPicture {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;  // without padding
};
// Decodes the data of an answer of type 0. Returns nullopt if its size does not match width and height, or one of these
// is 0.
std::optional<RawPicture> read_raw_picture(std::span<const std::uint8_t> data);

}  // namespace kenaf::protocol::image
