#include "can/canopen/sdo_server.hpp"

#include <utility>

#include "can/canopen/sdo_wire.hpp"

namespace kenaf::canopen {

std::optional<Frame> SdoServer::on_frame(const Frame& frame) {
  if (frame.id != kSdoRequestId + node_ || frame.length != 8) return std::nullopt;
  switch (sdo::specifier(frame)) {
    case sdo::kDownload:
      return begin_write(frame);
    case sdo::kUpload:
      return begin_read(frame);
    case sdo::kDownloadSegment:
      return write_segment(frame);
    case sdo::kUploadSegment:
      return read_segment(frame);
    case sdo::kAbort:
      transfer_ = Transfer::none;
      value_ = {};
      return std::nullopt;
    default:  // block transfers
      object_ = sdo::address(frame);
      return refuse(SdoAbort::bad_command);
  }
}

Frame SdoServer::begin_write(const Frame& frame) {
  begin(frame);
  if (sdo::is_expedited(frame)) {
    if (const std::optional<SdoAbort> abort = objects_.write(object_, sdo::expedited_value(frame)))
      return refuse(*abort);
  } else {
    announced_ = sdo::announced_size(frame);
    if (announced_ > kMaxSdoBytes) return refuse(SdoAbort::out_of_memory);
    transfer_ = Transfer::writing;
  }
  return sdo::initiate(answer_id(), sdo::kDownloadAnswer, object_);
}

Frame SdoServer::write_segment(const Frame& frame) {
  if (transfer_ != Transfer::writing) return refuse(SdoAbort::bad_command);
  if (!has_toggle(frame)) return refuse(SdoAbort::toggle_bit);
  if (const std::optional<SdoAbort> abort = sdo::append(value_, announced_, frame)) return refuse(*abort);
  if (sdo::is_last(frame)) {
    if (const std::optional<SdoAbort> abort = objects_.write(object_, value_)) return refuse(*abort);
    transfer_ = Transfer::none;
    value_ = {};
  }
  const std::uint8_t command = sdo::kDownloadSegmentAnswer | sdo::toggle(toggle_);
  toggle_ = !toggle_;
  return sdo::initiate(answer_id(), command, {});
}

Frame SdoServer::begin_read(const Frame& frame) {
  begin(frame);
  std::variant<ObjectBytes, SdoAbort> value = objects_.read(object_);
  if (const SdoAbort* abort = std::get_if<SdoAbort>(&value)) return refuse(*abort);
  value_ = std::move(std::get<ObjectBytes>(value));
  if (value_.size() > kMaxSdoBytes) return refuse(SdoAbort::out_of_memory);
  const Frame first = sdo::initiate_with(answer_id(), sdo::kUploadAnswer, object_, value_);
  if (!sdo::is_expedited(first)) transfer_ = Transfer::reading;
  return first;
}

Frame SdoServer::read_segment(const Frame& frame) {
  if (transfer_ != Transfer::reading) return refuse(SdoAbort::bad_command);
  if (!has_toggle(frame)) return refuse(SdoAbort::toggle_bit);
  const Frame segment =
      sdo::segment(answer_id(), sdo::kUploadSegmentAnswer | sdo::toggle(toggle_), std::span(value_).subspan(read_));
  read_ += sdo::segment_bytes(segment).size();
  toggle_ = !toggle_;
  if (sdo::is_last(segment)) {
    transfer_ = Transfer::none;
    value_ = {};
  }
  return segment;
}

void SdoServer::begin(const Frame& frame) {
  transfer_ = Transfer::none;
  object_ = sdo::address(frame);
  value_ = {};
  read_ = 0;
  toggle_ = false;
}

Frame SdoServer::refuse(SdoAbort abort) {
  transfer_ = Transfer::none;
  value_ = {};
  return sdo::initiate(answer_id(), sdo::kAbort, object_, static_cast<std::uint32_t>(abort));
}

bool SdoServer::has_toggle(const Frame& frame) const {
  return (frame.data[0] & sdo::kToggle) == sdo::toggle(toggle_);
}

std::uint16_t SdoServer::answer_id() const {
  return static_cast<std::uint16_t>(kSdoResponseId + node_);
}

}  // namespace kenaf::canopen
