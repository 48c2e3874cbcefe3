#include "can/canlog/sdo_dialogue.hpp"

#include "can/canlog/object_names.hpp"
#include "can/canopen/sdo_wire.hpp"

namespace kenaf::canlog {

using canopen::Frame;
using canopen::NodeId;
namespace sdo = canopen::sdo;

namespace {

canopen::Time patience_of(const Network& network, const CheckOptions& options) {
  if (options.sdo_answer) return *options.sdo_answer;
  return std::chrono::round<canopen::Time>(std::chrono::duration<double>(network.bus().answer_s));
}

bool toggle_of(const Frame& frame) {
  return (frame.data[0] & sdo::kToggle) != 0;
}

void append(canopen::ObjectBytes& value, std::span<const std::uint8_t> bytes) {
  if (value.size() + bytes.size() <= canopen::kMaxSdoBytes) value.insert(value.end(), bytes.begin(), bytes.end());
}

}  // namespace

SdoDialogue::SdoDialogue(const Network& network, const CheckOptions& options, Findings& findings)
    : network_(network), patience_(patience_of(network, options)), findings_(findings) {}

std::optional<WrittenObject> SdoDialogue::on_frame(const LogFrame& logged, const Address& address) {
  for (auto& [node, transfer] : nodes_) check_time(logged, node);
  if (logged.frame.length != 8) return std::nullopt;
  if (address.service == Service::sdo_request) on_request(logged, address.node);
  return address.service == Service::sdo_answer ? on_answer(logged, address.node) : std::nullopt;
}

void SdoDialogue::on_end(const LogFrame& last) {
  for (auto& [node, transfer] : nodes_) check_time(last, node);
}

void SdoDialogue::check_time(const LogFrame& now, NodeId node) {
  Transfer& transfer = nodes_[node];
  if (!transfer.request || transfer.late || now.at - transfer.request->at <= patience_) return;
  transfer.late = true;
  findings_.add(*transfer.request, rule::sdo_time, "{} does not answer within {:.3f} s: {}", network_.name(node),
                std::chrono::duration<double>(patience_).count(), object_words(transfer.object));
}

// ---- requests ----

void SdoDialogue::on_request(const LogFrame& logged, NodeId node) {
  Transfer& transfer = nodes_[node];
  const std::uint8_t specifier = sdo::specifier(logged.frame);
  if (specifier == sdo::kAbort) {
    transfer = {};
    return;
  }
  // after the answer time-out the master may retry
  if (transfer.request && !transfer.late) {
    findings_.add(logged, rule::sdo_dialogue, "{} is asked again before it has answered line {}", network_.name(node),
                  transfer.request->line);
  }
  switch (specifier) {
    case sdo::kDownload:
      return begin(logged, node, Kind::write);
    case sdo::kUpload:
      return begin(logged, node, Kind::read);
    case sdo::kDownloadSegment:
      return next_segment(logged, node, Kind::write);
    case sdo::kUploadSegment:
      return next_segment(logged, node, Kind::read);
    default:
      transfer = {.kind = Kind::block};
  }
}

void SdoDialogue::begin(const LogFrame& logged, NodeId node, Kind kind) {
  Transfer& transfer = nodes_[node];
  if (transfer.segmented) {
    findings_.add(logged, rule::sdo_dialogue, "a new transfer with {} before the one of {} has ended",
                  network_.name(node), object_words(transfer.object));
  }
  transfer = {.kind = kind, .object = sdo::address(logged.frame), .request = logged};
  if (kind == Kind::write && sdo::is_expedited(logged.frame))
    append(transfer.value, sdo::expedited_value(logged.frame));
}

void SdoDialogue::next_segment(const LogFrame& logged, NodeId node, Kind kind) {
  Transfer& transfer = nodes_[node];
  if (transfer.kind == Kind::block) return;
  if (!transfer.segmented || transfer.kind != kind) {
    findings_.add(logged, rule::sdo_dialogue, "a segment for {} without a transfer that has segments",
                  network_.name(node));
    transfer = {};
    return;
  }
  if (toggle_of(logged.frame) != transfer.toggle) {
    findings_.add(logged, rule::sdo_dialogue, "the toggle bit of the request for {} has not alternated",
                  network_.name(node));
  }
  transfer.toggle = toggle_of(logged.frame);
  transfer.request = logged;
  transfer.late = false;
  if (kind == Kind::write) {
    append(transfer.value, sdo::segment_bytes(logged.frame));
    transfer.last_segment = sdo::is_last(logged.frame);
  }
}

// ---- answers ----

std::optional<WrittenObject> SdoDialogue::on_answer(const LogFrame& logged, NodeId node) {
  const bool begins_here = !nodes_.contains(node);  // the log may begin between request and answer
  Transfer& transfer = nodes_[node];
  if (transfer.kind == Kind::block) return std::nullopt;
  const Frame& answer = logged.frame;
  const std::uint8_t specifier = sdo::specifier(answer);
  if (!transfer.request) {
    // a server may abort at any time
    if (specifier != sdo::kAbort && !begins_here)
      findings_.add(logged, rule::sdo_dialogue, "{} answers without a request", network_.name(node));
    transfer = {};
    return std::nullopt;
  }
  if (specifier == sdo::kAbort) {
    transfer = {};
    return std::nullopt;
  }
  const std::uint8_t first = transfer.kind == Kind::write ? sdo::kDownloadAnswer : sdo::kUploadAnswer;
  const std::uint8_t next = transfer.kind == Kind::write ? sdo::kDownloadSegmentAnswer : sdo::kUploadSegmentAnswer;
  if (specifier != (transfer.segmented ? next : first)) {
    findings_.add(logged, rule::sdo_dialogue, "{} answers line {} with an answer to another kind of request",
                  network_.name(node), transfer.request->line);
    return std::nullopt;
  }
  if (transfer.segmented) return answered_segment(logged, node, transfer.kind);
  if (sdo::address(answer) != transfer.object) {
    findings_.add(logged, rule::sdo_dialogue, "{} answers for {}, asked for {}", network_.name(node),
                  to_string(sdo::address(answer)), to_string(transfer.object));
    return std::nullopt;
  }
  const bool expedited = sdo::is_expedited(transfer.kind == Kind::write ? transfer.request->frame : answer);
  if (!expedited) {
    transfer.segmented = true;
    transfer.request.reset();
    return std::nullopt;
  }
  const Transfer done = std::exchange(transfer, {});
  if (done.kind == Kind::read) return std::nullopt;
  return WrittenObject{node, done.object, done.value};
}

std::optional<WrittenObject> SdoDialogue::answered_segment(const LogFrame& logged, NodeId node, Kind kind) {
  Transfer& transfer = nodes_[node];
  if (toggle_of(logged.frame) != transfer.toggle) {
    findings_.add(logged, rule::sdo_dialogue, "the toggle bit of {}'s answer is not its request's",
                  network_.name(node));
    return std::nullopt;
  }
  const bool last = kind == Kind::write ? transfer.last_segment : sdo::is_last(logged.frame);
  if (!last) {
    transfer.toggle = !transfer.toggle;
    transfer.request.reset();
    return std::nullopt;
  }
  const Transfer done = std::exchange(transfer, {});
  if (kind == Kind::read) return std::nullopt;
  return WrittenObject{node, done.object, done.value};
}

}  // namespace kenaf::canlog
