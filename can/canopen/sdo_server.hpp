// Server end of SDO transfers: a node that lets its objects be read and written. Expedited and segmented, as
// sdo_client.hpp; a block transfer is refused with "command specifier not valid". CiA 301, 7.2.4.3.
#pragma once

#include <functional>
#include <optional>
#include <utility>
#include <variant>

#include "can/canopen/nmt.hpp"
#include "can/canopen/sdo.hpp"

namespace kenaf::canopen {

// The node's object dictionary, as seen by the server.
struct ObjectAccess {
  std::function<std::variant<ObjectBytes, SdoAbort>(ObjectAddress)> read;
  // Called once per transfer, with the whole value. All four bytes if a client writes in one frame without indicating
  // the size (CiA 301 allows it).
  std::function<std::optional<SdoAbort>(ObjectAddress, std::span<const std::uint8_t>)> write;
};

class SdoServer {
 public:
  SdoServer(NodeId node, ObjectAccess objects) : node_(node), objects_(std::move(objects)) {}

  // Returns the answer to a request to this node; nullopt if the frame is none, or an abort, which has no answer. A
  // request of another length than eight bytes is no SDO (CiA 301, 7.2.4.3.1). A new transfer ends the previous one.
  std::optional<Frame> on_frame(const Frame& frame);

 private:
  enum class Transfer { none, reading, writing };
  void begin(const Frame& frame);
  Frame begin_write(const Frame& frame);
  Frame write_segment(const Frame& frame);
  Frame begin_read(const Frame& frame);
  Frame read_segment(const Frame& frame);
  Frame refuse(SdoAbort abort);
  bool has_toggle(const Frame& frame) const;
  std::uint16_t answer_id() const;

  NodeId node_;
  ObjectAccess objects_;
  Transfer transfer_ = Transfer::none;
  ObjectAddress object_{};
  ObjectBytes value_;                       // to be read, or written so far
  std::size_t read_ = 0;                    // bytes of value_
  std::optional<std::uint32_t> announced_;  // size announced for a segmented write
  bool toggle_ = false;
};

}  // namespace kenaf::canopen
