// Where the live view is served: command line options of kenaf-world and kenaf-relayd.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace kenaf::live {

struct ViewOptions {
  bool on = true;
  std::string address = "127.0.0.1";    // an IP address
  std::uint16_t port = 8080;            // 0: any free one
  std::string token;                    // empty: none on loopback; otherwise one is generated and printed
  bool asked_for = false;               // by an option: then a program that cannot serve it does not start
  std::string program = "kenaf-world";  // how a person starts the program that serves it
  bool operator==(const ViewOptions&) const = default;
};

// "off", "127.0.0.1:8080", "localhost:0", "0.0.0.0:80", "[::1]:8080"; the rest keeps its defaults. Throws
// std::runtime_error with a text for the user.
ViewOptions parse_view_options(std::string_view text);
// A token that needs no escapes in an address: letters, digits and - . _ ~ only; empty: none. Throws std::runtime_error
// with a text for the user.
std::string parse_view_token(std::string_view text);

}  // namespace kenaf::live
