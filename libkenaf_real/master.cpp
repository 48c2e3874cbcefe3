#include "libkenaf_real/master.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace kenaf::real {
namespace {

using canopen::Frame;
using canopen::MappedObject;
using canopen::ReceivedFrame;
using canopen::SdoAbort;
using canopen::SdoOutcome;
using canopen::SdoWrite;
using canopen::Time;
using hrt::Error;

[[noreturn]] void fail(const NamedNode& node, std::string_view verb, canopen::ObjectAddress object,
                       std::string_view purpose, const SdoOutcome& outcome, std::int64_t value = 0) {
  const bool silent = !outcome.by_server && outcome.abort == SdoAbort::timed_out;
  throw SdoRefused(
      fmt::format("{}: {} object {} ({}): {}", to_string(node), verb, to_string(object), purpose,
                  silent ? std::string("no answer; is it powered, is the bit rate right?")
                         : fmt::format("{}{} (SDO abort {:#010x})", outcome.by_server ? "" : "a wrong answer: ",
                                       describe(*outcome.abort), static_cast<std::uint32_t>(*outcome.abort))),
      object, value, *outcome.abort);
}

bool is_missing(const SdoOutcome& outcome) {
  return outcome.by_server && (outcome.abort == SdoAbort::no_object || outcome.abort == SdoAbort::no_sub_index);
}

// An expedited answer without a size has four bytes, of which the first ones are the number.
std::int64_t number_in(const MappedObject& object, const SdoOutcome& outcome) {
  return decode_number(object.type, std::span(outcome.value).first(byte_count(object.type)));
}

}  // namespace

std::string to_string(const NamedNode& node) {
  return fmt::format("{} (node {})", node.name, node.node);
}

Time to_time(double seconds) {
  return std::chrono::round<Time>(std::chrono::duration<double>(seconds));
}

Master::Master(canopen::Bus& bus, canopen::NodeId own_node, Time heartbeat, Time answer_patience)
    : bus_(bus), own_node_(own_node), heartbeat_(heartbeat), answer_patience_(answer_patience) {}

void Master::start_heartbeat() {
  if (!next_heartbeat_) next_heartbeat_ = now();
}

void Master::watch_pauses(Time silence) {
  longest_pause_ = silence;
  suspended_before_ = bus_.suspended();
}

void Master::guard(canopen::NodeId node) {
  if (std::ranges::find(guarded_, node) == guarded_.end()) guarded_.push_back(node);
}

void Master::check_pause() {
  if (!longest_pause_ || !next_heartbeat_) return;
  const Time suspended = bus_.suspended() - suspended_before_;
  const Time pause = now() - (*next_heartbeat_ - heartbeat_) + suspended;
  if (pause < *longest_pause_ && suspended == Time::zero()) return;
  stop_heartbeat();
  throw HeldUp(HRT_E_LINK,
               fmt::format("{} for {:.2f} s: its heartbeat was missed, and the drives stopped by themselves; to start "
                           "them again, call hrt_close(), then hrt_kenaf_init()",
                           suspended > Time::zero() ? "this computer was suspended" : "this program was held up",
                           std::chrono::duration<double>(suspended > Time::zero() ? suspended : pause).count()));
}

void Master::send_heartbeat() {
  const Time before = now();
  try {
    send(encode(canopen::Heartbeat{own_node_, canopen::NmtState::operational}));
    for (const canopen::NodeId node : guarded_) send(canopen::guard_request(node));
    next_heartbeat_ = before + heartbeat_;
  } catch (const canopen::BusFull&) {
    next_heartbeat_ = now() + heartbeat_;  // if the caller continues all the same, it can receive in between
    throw;
  }
}

std::optional<ReceivedFrame> Master::receive(Time until) {
  interrupted_ = false;
  while (true) {
    check_pause();
    if (next_heartbeat_ && now() >= *next_heartbeat_) send_heartbeat();
    const Time wake = next_heartbeat_ ? std::min(until, *next_heartbeat_) : until;
    if (const std::optional<ReceivedFrame> frame = bus_.receive(wake)) {
      refuse_own_heartbeat(*frame);
      if (watch_) watch_(*frame);
      return frame;
    }
    const Time after = now();
    if (after < wake) {
      interrupted_ = true;
      return std::nullopt;
    }
    if (after >= until) return std::nullopt;
  }
}

// The bus does not return this program's own frames.
void Master::refuse_own_heartbeat(const ReceivedFrame& received) const {
  const auto heartbeat = canopen::heartbeat_from(received.frame);
  if (!heartbeat || heartbeat->node != own_node_) return;
  throw OtherMaster(
      HRT_E_LINK,
      fmt::format("another program controls the robot: the heartbeat of node {} is on the bus, and is not this one's; "
                  "end one of the two, or is there a device with this number?",
                  own_node_));
}

bool Master::wait_until(Time until, const std::function<bool()>& done) {
  while (!done()) {
    if (!receive(until)) return false;
  }
  return true;
}

SdoOutcome Master::run(canopen::SdoClient& client, const Frame& first) {
  send(first);
  while (!client.outcome()) {
    const std::optional<ReceivedFrame> received = receive(client.deadline());
    if (interrupted_) throw Error(HRT_E_CLOSED, "hrt_close() was called while the robot was being set up");
    const std::optional<Frame> next = received ? client.on_frame(received->frame, now()) : client.on_time(now());
    if (next) send(*next);
  }
  return *client.outcome();
}

std::int64_t Master::read(const NamedNode& node, const MappedObject& object, std::string_view purpose) {
  canopen::SdoClient client(node.node, answer_patience_);
  const SdoOutcome outcome = run(client, client.begin_read(object.object, now()));
  if (outcome.abort) fail(node, "reading", object.object, purpose, outcome);
  if (outcome.value.size() < byte_count(object.type)) {
    throw Error(HRT_E_DEVICE,
                fmt::format("{}: object {} ({}) has {} bytes, not {}", to_string(node), to_string(object.object),
                            purpose, outcome.value.size(), byte_count(object.type)));
  }
  return number_in(object, outcome);
}

void Master::write(const NamedNode& node, const SdoWrite& write) {
  canopen::SdoClient client(node.node, answer_patience_);
  const SdoOutcome outcome =
      run(client, client.begin_write(write.object, encode_number(write.type, write.value), now()));
  if (outcome.abort)
    fail(node, fmt::format("writing {} to", write.value), write.object, write.purpose, outcome, write.value);
}

std::optional<std::int64_t> Master::read_if_there(const NamedNode& node, const MappedObject& object) {
  canopen::SdoClient client(node.node, answer_patience_);
  const SdoOutcome outcome = run(client, client.begin_read(object.object, now()));
  if (outcome.abort && is_missing(outcome)) return std::nullopt;
  if (outcome.abort) fail(node, "reading", object.object, "which not every drive has", outcome);
  return outcome.value.size() >= byte_count(object.type) ? std::optional(number_in(object, outcome)) : std::nullopt;
}

bool Master::write_if_there(const NamedNode& node, const SdoWrite& write) {
  canopen::SdoClient client(node.node, answer_patience_);
  const SdoOutcome outcome =
      run(client, client.begin_write(write.object, encode_number(write.type, write.value), now()));
  if (outcome.abort && !is_missing(outcome))
    fail(node, fmt::format("writing {} to", write.value), write.object, write.purpose, outcome, write.value);
  return !outcome.abort;
}

}  // namespace kenaf::real
