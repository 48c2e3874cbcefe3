// A USARSim client for tests: one blocking TCP connection, text out, lines in.
// Throws std::runtime_error when the server is silent for 20 s or closes. Thread safety: one thread.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "formats/protocol/usarsim_message.hpp"

namespace kenaf::support {

class UsarsimClient {
 public:
  explicit UsarsimClient(std::uint16_t port);  // loopback
  ~UsarsimClient();
  UsarsimClient(const UsarsimClient&) = delete;
  UsarsimClient& operator=(const UsarsimClient&) = delete;

  void send(std::string_view text);  // as it is: with its line end
  // The next line, without its end.
  std::string line();
  // The next line that begins with `start`; others before it are dropped.
  std::string line_that_begins(std::string_view start);

 private:
  int descriptor_;
  protocol::usarsim::LineSplitter lines_;
};

// The number of `key` in `line`, such as Time in "STA {Time 1.5}". Throws where there is none.
double number_in(std::string_view line, std::string_view key);
// The `index`-th of the numbers of `key`, such as z, 2, of "{Location 1,2,3}".
double number_in(std::string_view line, std::string_view key, std::size_t index);

}  // namespace kenaf::support
