// Checks a recorded bus against the standards' rules. docs/can-tools.md lists them.
//
// Only evidence in the log is judged: for a log that begins in the middle, a node's state is not judged before it was
// on the bus, nor a transfer or a set-up that began before the log.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "can/canlog/log.hpp"
#include "can/canlog/network.hpp"

namespace kenaf::canlog {

struct Rule {
  std::string_view name;    // "sdo-dialogue"
  std::string_view source;  // standard and section
  std::string_view words;   // the requirement
};

namespace rule {
inline constexpr Rule identifier{
    "identifier", "CiA 301, 7.3.3 to 7.3.5",
    "frames with the identifiers of the predefined connection set, of nodes and PDOs that are known; remote "
    "frames as requests of guarding and of PDOs only"},
    length{
        "length", "CiA 301, 7.2",
        "each service has its length: NMT 2, SYNC 0 or 1, heartbeat 1, SDO, EMCY and LSS 8, PDOs as they are mapped"},
    content{"content", "CiA 301, 7.2.8", "commands and states are defined by NMT"},
    node_guarding{"node-guarding", "CiA 301, 7.2.8.3.2.1",
                  "the toggle bit of a guarded node alternates from answer to answer, beginning with 0"},
    bus_off{"bus-off", "ISO 11898-1, fault confinement", "the recorder's controller stays on the bus"},
    boot_up{"boot-up", "CiA 301, 7.3.2.2.1", "a node that was reset sends boot-up before anything else"},
    nmt_state{"nmt-state", "CiA 301, 7.3.2.3",
              "PDOs from and to operational nodes alone; SDO and EMCY not from or to stopped ones"},
    sdo_dialogue{"sdo-dialogue", "CiA 301, 7.2.4.3",
                 "one transfer at a time; each answer is the request's: object, kind, toggle bit"},
    sdo_block{"sdo-block", "CiA 301, 7.2.4.3.8 to 7.2.4.3.16",
              "segments of a block are numbered from 1 and acknowledged; size and CRC are the data's"},
    sdo_time{"sdo-time", "CiA 301, 7.2.4", "each request is answered in time"},
    sdo_in_loop{"sdo-in-loop", "this project: docs/can-robot.md", "no SDO between the first motion and the last"},
    pdo_setup{"pdo-setup", "CiA 301, 7.5.2.36 and 7.5.2.38",
              "a PDO is made invalid, emptied, mapped, counted and made valid, in this order"},
    sync_pdo{"sync-pdo", "CiA 301, 7.2.2.2 and 7.2.2.3",
             "a synchronous PDO comes once at each SYNC that is its own, within the window"},
    master_heartbeat{"master-heartbeat", "CiA 301, 7.5.2.19", "heartbeats no farther apart than the time in 0x1016"},
    controlword{"controlword", "CiA 402-2, controlword and state machine",
                "an order towards operation has a transition in the state that the drive shows"},
    fault_reset{"fault-reset", "CiA 402-2, transition 15", "bit 7 as an edge, of a drive in fault"},
    statusword{"statusword", "CiA 402-2, state machine",
               "state changes follow the defined transitions, towards operation only on command"},
    set_point{"set-point", "CiA 402-2, profile position: set-point handshake",
              "raised when the drive is ready for it, lowered when it has taken it"},
    target{"target", "this project: docs/can-robot.md",
           "before operation enabled and after a quick stop: speed 0, positions held"};
}  // namespace rule
std::span<const Rule* const> all_rules();

struct Violation {
  std::size_t line;
  canopen::Time at;
  Rule rule;
  std::string words;
};

struct CheckOptions {
  std::optional<canopen::Time> sdo_answer{};  // nullopt: answer_s of the description
  std::optional<canopen::Time>
      sync_window{};  // nullopt: as written to 0x1007; if nothing was written, until the next SYNC
  // Frames of two senders that wait at the same time cross: what one sender shows less than this before another sends
  // cannot be known to that other. The longest frame takes 0.27 ms at 500 kbit/s.
  canopen::Time crossing = std::chrono::milliseconds(1);
  // A heartbeat has the lowest priority and may have waited: one that contradicts an order counts only once the order
  // is this old.
  canopen::Time heartbeat_wait = std::chrono::milliseconds(50);
  double hold_tolerance_rad = 0.01;  // for a flipper commanded to hold its position
};

// In the order of the log.
std::vector<Violation> check_rules(const Log& log, const Network& network, const CheckOptions& options = {});

}  // namespace kenaf::canlog
