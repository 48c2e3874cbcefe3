#include "server/live/view_options.hpp"

#include <fmt/format.h>

#include <boost/asio/ip/address.hpp>
#include <optional>
#include <stdexcept>

#include "formats/protocol/host_port.hpp"

namespace kenaf::live {

ViewOptions parse_view_options(std::string_view text) {
  ViewOptions options;
  if (text == "off") {
    options.on = false;
    return options;
  }
  const auto fail = [&] {
    throw std::runtime_error(fmt::format("'{}' is neither ADDRESS:PORT, such as 127.0.0.1:8080, nor off", text));
  };
  const std::optional<protocol::HostPort> parsed = protocol::parse_host_port(text);
  if (!parsed) fail();
  options.address = parsed->host == "localhost" ? "127.0.0.1" : parsed->host;
  options.port = parsed->port;
  boost::system::error_code no_address;
  const auto address = boost::asio::ip::make_address(options.address, no_address);
  if (no_address || address.is_v6() != text.starts_with('[')) fail();
  return options;
}

std::string parse_view_token(std::string_view text) {
  constexpr std::string_view kUnreserved = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-._~";
  if (text.find_first_not_of(kUnreserved) != std::string_view::npos) {
    throw std::runtime_error("a token consists of letters, digits and - . _ ~ only, because it is part of an address");
  }
  return std::string(text);
}

}  // namespace kenaf::live
