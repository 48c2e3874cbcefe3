#include "can/canlog/sdo_block.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace kenaf::canlog {

using canopen::Frame;
namespace sdo = canopen::sdo;

namespace {

// Bits 7 to 5; the client's and the server's meanings are exchanged between the two directions.
constexpr std::uint8_t kFromSender = 0xc0, kFromReceiver = 0xa0;
// From the sender, bit 0: initiate or end. From the receiver, bits 1 and 0.
constexpr std::uint8_t kEndStep = 0x01, kSubMask = 0x03, kReceiverEnd = 0x01, kAcknowledgeStep = 0x02,
                       kStartStep = 0x03;
constexpr std::uint8_t kCrcSupported = 0x04, kSizeGiven = 0x02, kLastSegment = 0x80, kNumberMask = 0x7f;
constexpr std::uint8_t kMaxBlock = 127;
constexpr std::uint16_t kBlockPolynomial = 0x1021;

std::optional<std::uint32_t> size_of(const Frame& initiate) {
  if ((initiate.data[0] & kSizeGiven) == 0) return std::nullopt;
  return canopen::get_unsigned(initiate.data, 4, 4);
}

bool is_receivers(const Frame& frame, std::uint8_t command) {
  return sdo::specifier(frame) == kFromReceiver && (frame.data[0] & kSubMask) == command;
}

}  // namespace

std::uint16_t block_crc(std::span<const std::uint8_t> bytes, std::uint16_t crc) {
  for (const std::uint8_t byte : bytes) {
    crc = static_cast<std::uint16_t>(crc ^ byte << 8);
    for (int bit = 0; bit < 8; ++bit)
      crc = static_cast<std::uint16_t>((crc & 0x8000) != 0 ? crc << 1 ^ kBlockPolynomial : crc << 1);
  }
  return crc;
}

bool SdoBlock::begins(const Frame& request) {
  if (sdo::specifier(request) == kFromSender) return (request.data[0] & kEndStep) == 0;
  return is_receivers(request, 0);
}

SdoBlock::SdoBlock(const Frame& request)
    : object_(sdo::address(request)),
      download_(sdo::specifier(request) == kFromSender),
      with_crc_((request.data[0] & kCrcSupported) != 0) {
  if (download_) {
    announced_ = size_of(request);
  } else {
    set_block_size(request.data[4]);
  }
}

bool SdoBlock::waits_for_server() const {
  switch (phase_) {
    case Phase::initiate:
      return true;
    case Phase::start:
    case Phase::done:
      return false;
    case Phase::segments:
    case Phase::end:
      return !download_;
    case Phase::acknowledge:
    case Phase::end_answer:
      break;
  }
  return download_;
}

bool SdoBlock::is_segment(const Frame& frame, bool from_server) const {
  return phase_ == Phase::segments && from_server != download_ && (frame.data[0] & kNumberMask) != 0;
}

std::string SdoBlock::on_frame(const Frame& frame, bool from_server) {
  // A receiver may acknowledge before the last segment of a block, where it misses one.
  const bool early = phase_ == Phase::segments && from_server == download_ && is_receivers(frame, kAcknowledgeStep);
  if (early) return on_acknowledge(frame);
  if (from_server == waits_for_server() && phase_ != Phase::done) {
    switch (phase_) {
      case Phase::initiate:
        return on_initiated(frame);
      case Phase::start:
        if (!is_receivers(frame, kStartStep)) break;
        phase_ = Phase::segments;
        return {};
      case Phase::segments:
        if (is_segment(frame, from_server)) return on_segment(frame);
        break;
      case Phase::acknowledge:
        if (is_receivers(frame, kAcknowledgeStep)) return on_acknowledge(frame);
        break;
      case Phase::end:
        if (sdo::specifier(frame) == kFromSender && (frame.data[0] & kEndStep) != 0) return on_end(frame);
        break;
      case Phase::end_answer:
        if (!is_receivers(frame, kReceiverEnd)) break;
        phase_ = Phase::done;
        return {};
      case Phase::done:
        break;
    }
  }
  lost_ = true;
  return fmt::format("a frame {:#04x} does not continue the block transfer of {}", frame.data[0], to_string(object_));
}

std::string SdoBlock::on_initiated(const Frame& answer) {
  const bool fits =
      download_ ? is_receivers(answer, 0) : sdo::specifier(answer) == kFromSender && (answer.data[0] & kEndStep) == 0;
  if (!fits) return fmt::format("an answer {:#04x} to the beginning of a block transfer", answer.data[0]);
  if (sdo::address(answer) != object_)
    return fmt::format("an answer for {}, asked for {}", to_string(sdo::address(answer)), to_string(object_));
  with_crc_ = with_crc_ && (answer.data[0] & kCrcSupported) != 0;
  phase_ = download_ ? Phase::segments : Phase::start;
  if (download_) return set_block_size(answer.data[4]);
  announced_ = size_of(answer);
  return {};
}

std::string SdoBlock::set_block_size(std::uint8_t size) {
  block_size_ = std::clamp<std::uint8_t>(size, 1, kMaxBlock);
  return size == block_size_ ? "" : fmt::format("a block size of {}: 1 to {} are allowed", size, kMaxBlock);
}

std::string SdoBlock::on_segment(const Frame& frame) {
  const auto number = static_cast<std::uint8_t>(frame.data[0] & kNumberMask);
  const std::uint8_t due = static_cast<std::uint8_t>(last_number_ + 1);
  last_number_ = number;
  last_sent_ = (frame.data[0] & kLastSegment) != 0;
  if (last_sent_ || number >= block_size_) phase_ = Phase::acknowledge;
  if (number != due) return fmt::format("segment {} comes where {} is due", number, due);

  // Only while none is missing: the receiver drops what comes after a gap.
  if (unacknowledged_.size() == sdo::kSegmentBytes * (number - 1u))
    unacknowledged_.insert(unacknowledged_.end(), frame.data.begin() + 1, frame.data.end());
  return number > block_size_ ? fmt::format("segment {} of a block of {}", number, block_size_) : "";
}

std::string SdoBlock::on_acknowledge(const Frame& frame) {
  const std::uint8_t acknowledged = frame.data[1], sent = last_number_;
  std::string wrong;
  if (acknowledged > sent) wrong = fmt::format("segment {} is acknowledged, the last one was {}", acknowledged, sent);

  // Segments after the acknowledged one are sent again, numbered from 1.
  const std::size_t bytes = std::min(unacknowledged_.size(), sdo::kSegmentBytes * acknowledged);
  take(std::span(unacknowledged_).first(bytes));
  unacknowledged_.clear();
  phase_ = last_sent_ && acknowledged >= sent ? Phase::end : Phase::segments;
  last_number_ = 0;
  last_sent_ = false;
  const std::string wrong_size = phase_ == Phase::end ? "" : set_block_size(frame.data[2]);
  return wrong.empty() ? wrong_size : wrong;
}

void SdoBlock::keep(std::span<const std::uint8_t> bytes) {
  crc_ = block_crc(bytes, crc_);
  bytes_ += bytes.size();
  const std::span room = bytes.first(std::min(canopen::kMaxSdoBytes - value_.size(), bytes.size()));
  value_.insert(value_.end(), room.begin(), room.end());
}

void SdoBlock::take(std::span<const std::uint8_t> segments) {
  if (segments.empty()) return;
  keep(held_);
  const std::span last = segments.last(sdo::kSegmentBytes);
  keep(segments.first(segments.size() - last.size()));
  held_.assign(last.begin(), last.end());
}

std::string SdoBlock::on_end(const Frame& frame) {
  phase_ = Phase::end_answer;
  const std::size_t unused = frame.data[0] >> 2 & 7;
  keep(std::span(held_).first(held_.size() - std::min(unused, held_.size())));
  held_.clear();

  if (announced_ && bytes_ != *announced_)
    return fmt::format("{} has {} bytes, {} were announced", to_string(object_), bytes_, *announced_);
  const std::uint32_t given = canopen::get_unsigned(frame.data, 1, 2);
  if (with_crc_ && given != crc_)
    return fmt::format("{} has the CRC {:#06x}, {:#06x} is given", to_string(object_), crc_, given);
  return {};
}

}  // namespace kenaf::canlog
