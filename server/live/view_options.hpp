// Where the live view is served, as the command lines of kenaf-world and kenaf-relayd say it.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace kenaf::live {

struct ViewOptions {
  bool on = true;
  std::string address = "127.0.0.1";  // an IP address
  std::uint16_t port = 8080;          // 0: any free one
  std::string token;                  // empty: none on loopback; elsewhere one is made and printed
  bool operator==(const ViewOptions&) const = default;
};

// "off", "127.0.0.1:8080", "localhost:0", "0.0.0.0:80", "[::1]:8080"; the token stays empty. Throws std::runtime_error
// in words.
ViewOptions parse_view_options(std::string_view text);
// A token that stands in an address as it is: letters, digits and - . _ ~ alone; empty: none. Throws std::runtime_error
// in words.
std::string parse_view_token(std::string_view text);

}  // namespace kenaf::live
