// One end of SDO transfers: reads and writes single objects of one node. Expedited and segmented transfers; no block
// transfers, which drives offer for firmware and logs. CiA 301, 7.2.4.3.
//
// How it is used: begin_read or begin_write gives the first frame to send; then every frame of the bus goes into
// on_frame, and the time into on_time, and what they return is sent, until outcome() has a value. Frames that are not
// this transfer's change nothing: other identifiers and lengths, answers for another object or to another kind of
// request (they come late, of a transfer before), and answers that come when none is waited for. A late answer for the
// same object to the same kind of request cannot be told from the new one.
#pragma once

#include <optional>

#include "can/canopen/nmt.hpp"
#include "can/canopen/sdo.hpp"

namespace kenaf::canopen {

struct SdoOutcome {
  ObjectAddress object;
  std::optional<SdoAbort> abort;  // nullopt: done
  bool by_server = false;         // who aborted: the node, or this end (time, toggle bit, malformed answers)
  // Of a read that is done. A node that answers in one frame without saying how many of its four bytes count (CiA 301
  // allows it) makes this four bytes long: who knows the object's type takes the first byte_count(type) of them.
  ObjectBytes value;
};

class SdoClient {
 public:
  // `patience`: how long each answer is waited for.
  SdoClient(NodeId server, Time patience) : server_(server), patience_(patience) {}

  // A transfer under way is forgotten. `value` of 1 to kMaxSdoBytes bytes, else std::length_error.
  Frame begin_read(ObjectAddress object, Time now);
  Frame begin_write(ObjectAddress object, ObjectBytes value, Time now);

  std::optional<Frame> on_frame(const Frame& frame, Time now);
  std::optional<Frame> on_time(Time now);

  // Of the transfer that was begun last; nullopt while it is under way or none was begun.
  const std::optional<SdoOutcome>& outcome() const { return outcome_; }
  // When on_time has something to do, while a transfer is under way.
  Time deadline() const { return deadline_; }

 private:
  enum class Awaits { nothing, read_answer, read_segment, write_answer, write_segment_answer };
  void begin(ObjectAddress object, ObjectBytes value, Awaits awaits, Time now);
  std::optional<Frame> next_after(const Frame& answer);
  std::optional<Frame> read_answer(const Frame& answer);
  std::optional<Frame> read_segment(const Frame& answer);
  std::optional<Frame> write_answer();
  std::optional<Frame> write_segment_answer(const Frame& answer);
  Frame next_write_segment();
  void finish(std::optional<SdoAbort> abort, bool by_server);
  Frame give_up(SdoAbort abort);
  bool has_toggle(const Frame& answer) const;
  std::uint16_t request_id() const;

  NodeId server_;
  Time patience_;
  Awaits awaits_ = Awaits::nothing;
  ObjectAddress object_{};
  ObjectBytes value_;                       // read so far, or to be written
  std::size_t written_ = 0;                 // bytes of value_
  std::optional<std::uint32_t> announced_;  // bytes that a segmented read was said to have
  bool toggle_ = false;
  Time deadline_{};
  std::optional<SdoOutcome> outcome_;
};

}  // namespace kenaf::canopen
