// A block transfer of a node, followed frame by frame. CiA 301, 7.2.4.3.8 to 7.2.4.3.16.
//
//   initiate (client) and its answer, start (client, upload only),
//   segments of 7 bytes, numbered from 1 (up to 127 at once), acknowledged by the receiver, and so on,
//   end (sender) with the number of unused bytes and a CRC, and its answer
//
// A download goes to the node, the server; the client sends. Segments have no command specifier: only their place in
// the transfer tells what they are.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "can/canopen/sdo.hpp"
#include "can/canopen/sdo_wire.hpp"

namespace kenaf::canlog {

// CRC-CCITT without inversion, polynomial x^16 + x^12 + x^5 + 1, beginning with 0 (7.2.4.3.16); "123456789" has 0x31c3.
std::uint16_t block_crc(std::span<const std::uint8_t> bytes, std::uint16_t crc = 0);

class SdoBlock {
 public:
  // `request` begins a block transfer.
  static bool begins(const canopen::Frame& request);
  explicit SdoBlock(const canopen::Frame& request);

  canopen::ObjectAddress object() const { return object_; }
  bool is_download() const { return download_; }
  bool is_done() const { return phase_ == Phase::done; }
  // The sender has ended it; the receiver has not confirmed yet.
  bool is_ended() const { return phase_ == Phase::end_answer; }
  // A frame came that is none of a block transfer: it is not known what follows.
  bool is_lost() const { return lost_; }
  bool is_initiating() const { return phase_ == Phase::initiate; }
  // The node, not the client, has to send next.
  bool waits_for_server() const;
  // True if this frame of the server or the client would be a segment of data: an abort is none.
  bool is_segment(const canopen::Frame& frame, bool from_server) const;

  // Takes the next frame of either side that is no abort, and returns what is wrong with it; empty: nothing.
  std::string on_frame(const canopen::Frame& frame, bool from_server);

  // What has been acknowledged; complete after the end. The first canopen::kMaxSdoBytes of it.
  const canopen::ObjectBytes& value() const { return value_; }
  std::uint64_t size() const { return bytes_; }
  bool has_crc() const { return with_crc_; }  // both sides compute it
  std::uint16_t crc() const { return crc_; }

 private:
  enum class Phase : std::uint8_t { initiate, start, segments, acknowledge, end, end_answer, done };
  std::string on_initiated(const canopen::Frame& answer);
  std::string on_segment(const canopen::Frame& frame);
  std::string on_acknowledge(const canopen::Frame& frame);
  std::string on_end(const canopen::Frame& frame);
  std::string set_block_size(std::uint8_t size);
  void take(std::span<const std::uint8_t> segments);
  void keep(std::span<const std::uint8_t> bytes);

  canopen::ObjectAddress object_;
  bool download_, with_crc_;
  std::optional<std::uint32_t> announced_{};
  Phase phase_ = Phase::initiate;
  std::uint8_t block_size_ = 127, last_number_ = 0;
  bool last_sent_ = false, lost_ = false;
  canopen::ObjectBytes unacknowledged_{};  // the segments of this block that came in order
  canopen::ObjectBytes held_{};            // the last acknowledged segment: the end may shorten it
  canopen::ObjectBytes value_{};
  std::uint64_t bytes_ = 0;
  std::uint16_t crc_ = 0;
};

}  // namespace kenaf::canlog
