#include "can/canopen/sdo_client.hpp"

#include <stdexcept>
#include <string>
#include <utility>

#include "can/canopen/sdo_wire.hpp"

namespace kenaf::canopen {

Frame SdoClient::begin_read(ObjectAddress object, Time now) {
  begin(object, {}, Awaits::read_answer, now);
  return sdo::initiate(request_id(), sdo::kUpload, object_);
}

Frame SdoClient::begin_write(ObjectAddress object, ObjectBytes value, Time now) {
  if (value.empty() || value.size() > kMaxSdoBytes)
    throw std::length_error("a value of " + std::to_string(value.size()) + " bytes for object " + to_string(object) +
                            ": an SDO writes 1 to " + std::to_string(kMaxSdoBytes));
  begin(object, std::move(value), Awaits::write_answer, now);
  return sdo::initiate_with(request_id(), sdo::kDownload, object_, value_);
}

void SdoClient::begin(ObjectAddress object, ObjectBytes value, Awaits awaits, Time now) {
  object_ = object;
  value_ = std::move(value);
  awaits_ = awaits;
  deadline_ = now + patience_;
  outcome_.reset();
}

std::optional<Frame> SdoClient::on_frame(const Frame& frame, Time now) {
  if (awaits_ == Awaits::nothing || frame.id != kSdoResponseId + server_ || frame.length != 8) return std::nullopt;
  if (sdo::specifier(frame) == sdo::kAbort) {
    if (sdo::address(frame) == object_) finish(static_cast<SdoAbort>(get_unsigned(frame.data, 4, 4)), true);
    return std::nullopt;
  }
  const std::optional<Frame> next = next_after(frame);
  if (next) deadline_ = now + patience_;
  return next;
}

std::optional<Frame> SdoClient::on_time(Time now) {
  if (awaits_ == Awaits::nothing || now < deadline_) return std::nullopt;
  return give_up(SdoAbort::timed_out);
}

// An answer with an unexpected specifier belongs to an earlier transfer and came late.
std::optional<Frame> SdoClient::next_after(const Frame& answer) {
  const std::uint8_t specifier = sdo::specifier(answer);
  switch (awaits_) {
    case Awaits::nothing:
      return std::nullopt;
    case Awaits::read_answer:
      if (specifier != sdo::kUploadAnswer || sdo::address(answer) != object_) return std::nullopt;
      return read_answer(answer);
    case Awaits::read_segment:
      if (specifier != sdo::kUploadSegmentAnswer) return std::nullopt;
      return read_segment(answer);
    case Awaits::write_answer:
      if (specifier != sdo::kDownloadAnswer || sdo::address(answer) != object_) return std::nullopt;
      return write_answer();
    case Awaits::write_segment_answer:
      if (specifier != sdo::kDownloadSegmentAnswer) return std::nullopt;
      return write_segment_answer(answer);
  }
  return std::nullopt;
}

std::optional<Frame> SdoClient::read_answer(const Frame& answer) {
  if (sdo::is_expedited(answer)) {
    const std::span<const std::uint8_t> value = sdo::expedited_value(answer);
    value_.assign(value.begin(), value.end());
    finish(std::nullopt, false);
    return std::nullopt;
  }
  announced_ = sdo::announced_size(answer);
  if (announced_ > kMaxSdoBytes) return give_up(SdoAbort::out_of_memory);
  awaits_ = Awaits::read_segment;
  toggle_ = false;
  return sdo::initiate(request_id(), sdo::kUploadSegment, {});
}

std::optional<Frame> SdoClient::read_segment(const Frame& answer) {
  if (!has_toggle(answer)) return give_up(SdoAbort::toggle_bit);
  if (const std::optional<SdoAbort> abort = sdo::append(value_, announced_, answer)) return give_up(*abort);
  if (sdo::is_last(answer)) {
    finish(std::nullopt, false);
    return std::nullopt;
  }
  toggle_ = !toggle_;
  return sdo::initiate(request_id(), sdo::kUploadSegment | sdo::toggle(toggle_), {});
}

std::optional<Frame> SdoClient::write_answer() {
  if (value_.size() <= sdo::kExpeditedBytes) {
    finish(std::nullopt, false);
    return std::nullopt;
  }
  awaits_ = Awaits::write_segment_answer;
  written_ = 0;
  toggle_ = false;
  return next_write_segment();
}

std::optional<Frame> SdoClient::write_segment_answer(const Frame& answer) {
  if (!has_toggle(answer)) return give_up(SdoAbort::toggle_bit);
  if (written_ == value_.size()) {
    finish(std::nullopt, false);
    return std::nullopt;
  }
  toggle_ = !toggle_;
  return next_write_segment();
}

Frame SdoClient::next_write_segment() {
  const Frame segment =
      sdo::segment(request_id(), sdo::kDownloadSegment | sdo::toggle(toggle_), std::span(value_).subspan(written_));
  written_ += sdo::segment_bytes(segment).size();
  return segment;
}

void SdoClient::finish(std::optional<SdoAbort> abort, bool by_server) {
  const bool has_value = !abort && (awaits_ == Awaits::read_answer || awaits_ == Awaits::read_segment);
  outcome_ = SdoOutcome{object_, abort, by_server, has_value ? std::move(value_) : ObjectBytes{}};
  awaits_ = Awaits::nothing;
  value_ = {};
}

Frame SdoClient::give_up(SdoAbort abort) {
  finish(abort, false);
  return sdo::initiate(request_id(), sdo::kAbort, object_, static_cast<std::uint32_t>(abort));
}

bool SdoClient::has_toggle(const Frame& answer) const {
  return (answer.data[0] & sdo::kToggle) == sdo::toggle(toggle_);
}

std::uint16_t SdoClient::request_id() const {
  return static_cast<std::uint16_t>(kSdoRequestId + server_);
}

}  // namespace kenaf::canopen
