// A relay with a Plant behind it, in a thread of its own, and a bad network to put before it. Test-only.
#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "formats/protocol/relay_datagram.hpp"
#include "tests/hrt/plant.hpp"

namespace kenaf::hrt::test {

// Lock step, as docs/relay-protocol.md has it: a Command that answers the newest frame begins the next one, any other
// is answered with the newest State.
class FakeRelay {
 public:
  struct Behaviour {
    PlantSettings plant;
    std::optional<protocol::relay::RefusedReason> refuse;
    std::string words = "because of the test";
    int refuse_times = 1 << 30;
    std::uint32_t silent_from_frame = 0;    // says nothing more instead of this frame; 0: never
    std::uint32_t frozen_from_frame = 0;    // answers pings, but this frame never comes
    std::uint32_t world_lost_at_frame = 0;  // says kWorldServerLost instead of it
    std::uint32_t forgets_at_frame = 0;     // says Refused unknown_session instead of it
    std::uint32_t pause_at_frame = 0;       // says kWorldPaused `pause_states` times before it
    int pause_states = 0;
    bool first_state_lost = false;
    bool not_at_start = false;
    bool no_state = false;  // welcomes and answers pings, and nothing more
  };
  explicit FakeRelay(const Behaviour& behaviour);
  ~FakeRelay();

  std::string address() const;  // HOST:PORT
  std::uint16_t port() const { return port_; }
  std::vector<protocol::relay::Command> commands() const;  // the answers to frame 1, 2, 3, ...
  int byes() const { return byes_; }
  int hellos() const { return hellos_; }
  int pings() const { return pings_; }
  int repeats() const { return repeats_; }  // Commands that it had already
  std::optional<protocol::relay::Hello> hello() const;

 private:
  void run();
  protocol::relay::State state() const;
  std::vector<protocol::relay::Datagram> answers_to(const protocol::relay::Datagram& datagram);

  Behaviour behaviour_;
  int socket_ = -1, stop_ = -1;
  std::uint16_t port_ = 0;
  mutable std::mutex mutex_;
  Plant plant_;
  std::uint64_t session_ = 0;
  std::uint32_t acknowledged_ = 0;
  std::vector<protocol::relay::Command> commands_;
  std::optional<protocol::relay::Hello> hello_;
  std::atomic<int> byes_ = 0, hellos_ = 0, pings_ = 0, repeats_ = 0;
  std::thread thread_;
};

// Between a commander and a relay: drops, doubles and delays datagrams, both ways, for a seed.
class BadNetwork {
 public:
  struct Quality {
    double loss = 0, doubling = 0, delay = 0;  // probabilities
    int longest_delay_ms = 0;
    unsigned seed = 1;
  };
  BadNetwork(std::uint16_t relay_port, const Quality& quality);
  ~BadNetwork();
  std::string address() const;
  int dropped() const { return dropped_; }

 private:
  void run();

  Quality quality_;
  int front_ = -1, back_ = -1, stop_ = -1;
  std::uint16_t port_ = 0;
  std::atomic<int> dropped_ = 0;
  std::thread thread_;
};

}  // namespace kenaf::hrt::test
