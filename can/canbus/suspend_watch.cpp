#include "can/canbus/suspend_watch.hpp"

#include <algorithm>

namespace kenaf::canbus {

using canopen::Time;

Time suspended_since(SuspendWatch& watch, Time before, Time boot, Time after) {
  // The lead at the moment of `boot` is between boot - after and boot - before; it only ever grows, by a suspend.
  watch.most_ahead = std::min(watch.most_ahead.value_or(boot - before), boot - before);
  watch.suspended = std::max(watch.suspended, boot - after - *watch.most_ahead);
  return watch.suspended;
}

}  // namespace kenaf::canbus
