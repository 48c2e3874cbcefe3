// Client end of SDO transfers: reads and writes single objects of one node. Expedited and segmented transfers; no block
// transfers, which drives offer for firmware and logs. CiA 301, 7.2.4.3.
//
// Use: begin_read or begin_write returns the first frame to send; then pass every frame of the bus to on_frame, and the
// time to on_time, and send what they return, until outcome() has a value. Frames that do not belong to this transfer
// change nothing: other identifiers and lengths, late answers for another object or to another kind of request, and
// answers while none is awaited. A late answer for the same object to the same kind of request cannot be distinguished
// from the new one.
#pragma once

#include <optional>

#include "can/canopen/nmt.hpp"
#include "can/canopen/sdo.hpp"

namespace kenaf::canopen {

struct SdoOutcome {
  ObjectAddress object;
  std::optional<SdoAbort> abort;  // nullopt: done
  bool by_server = false;         // who aborted: the node, or this end (time-out, toggle bit, malformed answer)
  // Result of a successful read. If a node answers in one frame without indicating the size (CiA 301 allows it), this
  // has four bytes: a caller that knows the object's type takes the first byte_count(type) of them.
  ObjectBytes value;
};

class SdoClient {
 public:
  // `patience`: time-out for each answer.
  SdoClient(NodeId server, Time patience) : server_(server), patience_(patience) {}

  // A transfer under way is abandoned. Throws std::length_error unless `value` has 1 to kMaxSdoBytes bytes.
  Frame begin_read(ObjectAddress object, Time now);
  Frame begin_write(ObjectAddress object, ObjectBytes value, Time now);

  std::optional<Frame> on_frame(const Frame& frame, Time now);
  std::optional<Frame> on_time(Time now);

  // Outcome of the last transfer begun; nullopt while it is under way or if none was begun.
  const std::optional<SdoOutcome>& outcome() const { return outcome_; }
  // When on_time has something to do during a transfer.
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
  std::optional<std::uint32_t> announced_;  // size announced for a segmented read
  bool toggle_ = false;
  Time deadline_{};
  std::optional<SdoOutcome> outcome_;
};

}  // namespace kenaf::canopen
