// What the frames of a log have set up so far: followed for those who only decode frames and judge none.
#pragma once

#include <optional>

#include "can/canlog/findings.hpp"
#include "can/canlog/pdo_setup.hpp"
#include "can/canlog/sdo_dialogue.hpp"

namespace kenaf::canlog {

class BusState {
 public:
  // `network` must outlive this.
  explicit BusState(const Network& network)
      : network_(network), setup_(network, ignored_), dialogue_(network, options_, ignored_) {}
  BusState(const BusState&) = delete;
  BusState& operator=(const BusState&) = delete;

  // Takes each frame in the order of the log. Returns the write that this one has completed.
  std::optional<WrittenObject> on_frame(const LogFrame& logged);

  const PdoSetup& setup() const { return setup_; }
  const SdoDialogue& dialogue() const { return dialogue_; }

 private:
  const Network& network_;
  CheckOptions options_{};
  Findings ignored_{Findings::Keep::none};
  PdoSetup setup_;
  SdoDialogue dialogue_;
};

}  // namespace kenaf::canlog
