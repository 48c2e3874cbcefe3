#include "server/live/view_options.hpp"

#include <fmt/format.h>

#include <boost/asio/ip/address.hpp>
#include <charconv>
#include <stdexcept>

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
  const std::size_t colon = text.rfind(':');
  if (colon == std::string_view::npos) fail();
  std::string_view address = text.substr(0, colon), port = text.substr(colon + 1);
  const auto [end, error] = std::from_chars(port.data(), port.data() + port.size(), options.port);
  if (error != std::errc() || end != port.data() + port.size()) fail();
  if (address == "localhost") address = "127.0.0.1";
  const bool brackets = address.size() > 2 && address.front() == '[' && address.back() == ']';
  if (brackets) address = address.substr(1, address.size() - 2);
  boost::system::error_code no_address;
  const auto parsed = boost::asio::ip::make_address(std::string(address), no_address);
  if (no_address || parsed.is_v6() != brackets) fail();
  options.address = address;
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
