#include "seat.hpp"

namespace kenaf::teleop {

Admission admit(Seat& seat, const Wish& wish, double now_s, double takeover_s) {
  if (wish.session == seat.left) return Admission::old;
  if (wish.session != seat.session) {
    if (seat.session != 0 && now_s - seat.heard_s < takeover_s) return Admission::taken;
    seat = {.session = wish.session, .left = seat.left};
  }
  ++seat.received;
  if (seat.wish && wish.sequence <= seat.wish->sequence) return Admission::old;
  seat.wish = wish;
  seat.heard_s = now_s;
  return Admission::newest;
}

void leave(Seat& seat, std::uint64_t session) {
  if (session == seat.session) seat = {.left = session};
}

}  // namespace kenaf::teleop
