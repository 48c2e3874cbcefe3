#include "can/canlog/sdo_dialogue.hpp"

#include "can/canlog/object_names.hpp"
#include "can/canopen/sdo_wire.hpp"

namespace kenaf::canlog {

using canopen::Frame;
using canopen::NodeId;
namespace sdo = canopen::sdo;

namespace {

constexpr std::uint8_t kBlockAnswer = 0xa0, kBlockStep = 0x03;

// The last segment of a block may look like an abort; an abort's other bits are 0.
bool is_abort(const Frame& frame, bool followed) {
  return followed ? sdo::specifier(frame) == sdo::kAbort : frame.data[0] == sdo::kAbort;
}

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
  if (transfer.kind == Kind::unknown || !transfer.request || transfer.late ||
      now.at - transfer.request->at <= patience_)
    return;
  transfer.late = true;
  findings_.add(*transfer.request, rule::sdo_time, "{} does not answer within {:.3f} s: {}", network_.name(node),
                std::chrono::duration<double>(patience_).count(), object_words(transfer.object));
}

const SdoBlock* SdoDialogue::block(NodeId node) const {
  const auto found = nodes_.find(node);
  return found == nodes_.end() || !found->second.block ? nullptr : &*found->second.block;
}

// ---- requests ----

// The segments of a block have consecutive numbers in their first bytes, and no answers between them.
bool SdoDialogue::continues_unseen_block(const LogFrame& logged, const Transfer& transfer) const {
  if (transfer.followed || !transfer.request) return false;
  const auto number = [](const Frame& frame) { return frame.data[0] & 0x7f; };
  return number(logged.frame) == number(transfer.request->frame) + 1;
}

void SdoDialogue::on_request(const LogFrame& logged, NodeId node) {
  Transfer& transfer = nodes_[node];
  const std::uint8_t specifier = sdo::specifier(logged.frame);
  if (transfer.block && transfer.block->is_segment(logged.frame, false)) return check_block(logged, node, false);
  if (is_abort(logged.frame, transfer.followed)) return end_transfer(node);
  if (continues_unseen_block(logged, transfer)) {
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
      break;
  }
  if (SdoBlock::begins(logged.frame)) return begin(logged, node, Kind::block);
  if (transfer.block) return check_block(logged, node, false);
  if (transfer.kind != Kind::unknown) {
    findings_.add(logged, rule::sdo_dialogue, "a frame of a block transfer for {} without a block transfer",
                  network_.name(node));
  }
}

void SdoDialogue::check_block(const LogFrame& logged, NodeId node, bool from_server) {
  Transfer& transfer = nodes_[node];
  const std::string wrong = transfer.block->on_frame(logged.frame, from_server);
  if (!wrong.empty()) findings_.add(logged, rule::sdo_block, "{}: {}", network_.name(node), wrong);

  if (transfer.block->is_lost()) {
    transfer = {};
    return;
  }

  // A frame of the client asks for the next one of the server, if the server is to send.
  transfer.request.reset();
  transfer.late = false;
  if (!from_server && transfer.block->waits_for_server()) transfer.request = logged;
  if (!transfer.block->is_done() || from_server) return;
  end_transfer(node);
}

void SdoDialogue::begin(const LogFrame& logged, NodeId node, Kind kind) {
  Transfer& transfer = nodes_[node];
  if (transfer.segmented || (transfer.block && !transfer.block->is_initiating())) {
    findings_.add(logged, rule::sdo_dialogue, "a new transfer with {} before the one of {} has ended",
                  network_.name(node), object_words(transfer.object));
  }
  transfer = {.kind = kind, .followed = transfer.followed, .object = sdo::address(logged.frame), .request = logged};
  if (kind == Kind::block) transfer.block.emplace(logged.frame);
  if (kind == Kind::write && sdo::is_expedited(logged.frame))
    append(transfer.value, sdo::expedited_value(logged.frame));
}

void SdoDialogue::next_segment(const LogFrame& logged, NodeId node, Kind kind) {
  Transfer& transfer = nodes_[node];
  if (transfer.kind == Kind::unknown) {
    transfer.request = logged;
    return;
  }
  if (!transfer.segmented || transfer.kind != kind) {
    findings_.add(logged, rule::sdo_dialogue, "a segment for {} without a transfer that has segments",
                  network_.name(node));
    end_transfer(node);
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
  Transfer& transfer = nodes_[node];
  const Frame& answer = logged.frame;
  const std::uint8_t specifier = sdo::specifier(answer);

  // A client may ask for a block and get an ordinary answer, where the object is small (7.2.4.3.13).
  const bool ordinary = transfer.block && transfer.block->is_initiating() && !transfer.block->is_download() &&
                        specifier == sdo::kUploadAnswer;
  if (ordinary) {
    transfer.block.reset();
    transfer.kind = Kind::read;
  }
  // What began before the log is answered without having been asked, and an acknowledgement of a block is the answer to
  // a segment that looked like another request.
  const bool within_block = !transfer.block || (transfer.block->is_initiating() && (answer.data[0] & kBlockStep) != 0);
  const bool of_unseen_block = !transfer.followed && specifier == kBlockAnswer && within_block;
  if (transfer.block && !of_unseen_block && answer.data[0] != sdo::kAbort) return on_block_answer(logged, node);
  if (of_unseen_block || (transfer.kind == Kind::unknown && transfer.request)) {
    transfer = {};
    return std::nullopt;
  }
  if (is_abort(answer, transfer.followed)) {
    end_transfer(node);
    return std::nullopt;
  }
  if (!transfer.request) {
    if (transfer.kind != Kind::unknown)
      findings_.add(logged, rule::sdo_dialogue, "{} answers without a request", network_.name(node));
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
    transfer.followed = true;
    transfer.request.reset();
    return std::nullopt;
  }
  const Transfer done = std::exchange(transfer, {.kind = Kind::none, .followed = true});
  if (done.kind == Kind::read) return std::nullopt;
  return WrittenObject{node, done.object, done.value};
}

std::optional<WrittenObject> SdoDialogue::on_block_answer(const LogFrame& logged, NodeId node) {
  check_block(logged, node, true);
  Transfer& transfer = nodes_[node];
  if (!transfer.block) return std::nullopt;
  transfer.followed = true;
  if (!transfer.block->is_done()) return std::nullopt;
  WrittenObject written{node, transfer.block->object(), transfer.block->value()};
  end_transfer(node);
  return written;
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
  const Transfer done = std::exchange(transfer, {.kind = Kind::none, .followed = true});
  if (kind == Kind::read) return std::nullopt;
  return WrittenObject{node, done.object, done.value};
}

}  // namespace kenaf::canlog
