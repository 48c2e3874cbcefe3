// A node's process data objects: up to four that it transmits (TPDO) and four that it receives (RPDO), each described
// by two records in the object dictionary, which a master may write by SDO.
//
//   communication, 0x1400 and 0x1800 + number - 1      mapping, 0x1600 and 0x1a00 + number - 1
//     1  COB-ID; bit 31 set: this PDO is invalid         0     how many objects are mapped; 0: none
//     2  transmission type                               1..8  index << 16 | sub-index << 8 | bits
//     3  inhibit time, 100 us (TPDO)
//     5  event timer, ms: a TPDO is sent at the latest then; an RPDO must come again within it
//
// Order of a change (CiA 301, 7.5.2.36 and 7.5.2.38): PDO invalid, count to 0, objects, count, PDO valid. Any other
// order is refused. Transmission types (7.5.2.35 and 7.5.2.37): 0 = at the SYNC after a change, 1 to 240 = at every
// n-th SYNC, 254 and 255 = when the data changes or the event timer expires; for an RPDO 0 to 240 = takes effect at the
// next SYNC, 254 and 255 = at once. Remote requests (252, 253) are refused, as CiA 301 advises against them. The event
// timer of an RPDO (7.5.2.35) is optional; it begins with the first reception after it was written.
#pragma once

#include <array>
#include <vector>

#include "can/candrives/dictionary.hpp"
#include "can/canopen/nmt.hpp"

namespace kenaf::candrives {

using Frames = std::vector<canopen::Frame>;

// A PDO in the node's initial configuration.
struct DefaultPdo {
  canopen::Pdo pdo;
  bool valid = true;
  std::uint16_t inhibit_100us = 0, event_ms = 0;  // TPDO
  bool has_event_timer = true;                    // RPDO: false: its record ends with sub-index 2
};

class ProcessData {
 public:
  // Adds the records of `pdos`: the node has these PDOs and no others. The dictionary must outlive this object.
  ProcessData(canopen::NodeId node, Dictionary& objects, const std::vector<DefaultPdo>& pdos);

  // Rules of nodes that have others than the standard.
  struct Quirks {
    bool count_first;    // a PDO with mapped objects cannot be switched off, but its mapping emptied while it is valid
    bool fixed_mapping;  // no mapping can be written
    bool first_rpdo_fixed;  // that of RPDO1 cannot be written
  };
  void set_quirks(Quirks quirks) { quirks_ = quirks; }

  // Checks the rules of the two records above; nullopt also if the object belongs to neither.
  std::optional<canopen::SdoAbort> check(canopen::ObjectAddress object, std::int64_t value) const;

  // Returns the object that `value` maps if it is written to `object`; nullopt: `object` is no entry of a mapping.
  std::optional<canopen::ObjectAddress> mapped_by(canopen::ObjectAddress object, std::int64_t value) const;

  // Called after a write to `object`: a changed PDO restarts.
  void on_written(canopen::ObjectAddress object);
  // The node becomes operational: all PDOs restart, and earlier data are neither used nor sent.
  void begin();

  // True if the frame is an RPDO of this node.
  bool receives(const canopen::Frame& frame) const;
  enum class Reception { not_for_me, taken, too_short };
  Reception on_frame(const canopen::Frame& frame, canopen::Time now);
  // True once after the event timer of an RPDO has expired.
  bool take_overdue(canopen::Time now);
  // Writes data received by synchronous RPDOs, then sends synchronous TPDOs. `refresh`, called between the two, brings
  // measurements into the dictionary.
  void on_sync(canopen::Time now, const std::function<void()>& refresh, Frames& out);
  // Sends event-driven TPDOs whose data has changed or whose event timer has expired.
  void on_time(canopen::Time now, Frames& out);
  // The next event timer to expire; Time::max(): none.
  canopen::Time deadline() const;
  // True if some TPDO is sent on change, so that the data should be kept up to date.
  bool follows_data() const;

 private:
  struct State {
    std::uint16_t communication, mapping;  // indices of the two records
    bool transmit;
    std::array<std::uint8_t, 8> received{};
    bool pending = false;    // received, not yet in force
    std::uint8_t syncs = 0;  // since the last transmission
    std::optional<canopen::Frame> sent{};
    canopen::Time sent_at{};
    canopen::Time overdue_at = canopen::Time::max();  // RPDO: unless it is received before
  };
  bool is_valid(const State& state) const;
  bool is_active(const State& state) const;  // valid, and something is mapped
  bool is_event_driven(const State& state) const;
  canopen::Time event_time(const State& state) const;  // zero: no event timer
  canopen::Time inhibit_time(const State& state) const;
  std::vector<canopen::MappedObject> mapped(const State& state) const;
  std::size_t bytes(const State& state) const;
  canopen::Frame pack(const State& state) const;
  void begin(State& state);
  void take(State& state, std::vector<Dictionary::Number>& numbers) const;
  void transmit(State& state, const canopen::Frame& frame, canopen::Time now, Frames& out);
  std::optional<canopen::SdoAbort> check_cob_id(const State& state, std::int64_t value) const;
  std::optional<canopen::SdoAbort> check_mapping(const State& state, std::uint8_t sub, std::int64_t value) const;

  Dictionary* objects_;
  std::vector<State> pdos_;
  Quirks quirks_{};
};

}  // namespace kenaf::candrives
