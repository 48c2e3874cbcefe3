#include "formats/protocol/foreign_opening.hpp"

#include <algorithm>
#include <array>

namespace kenaf::protocol {

namespace {

constexpr char kTlsHandshake = '\x16';
constexpr std::array<std::string_view, 10> kHttpMethods{"GET ",     "HEAD ",    "POST ",  "PUT ",   "DELETE ",
                                                        "CONNECT ", "OPTIONS ", "TRACE ", "PATCH ", "PRI "};

}  // namespace

std::string_view foreign_protocol(std::string_view opening) {
  if (opening.starts_with(kTlsHandshake)) return "TLS";
  if (opening.starts_with("SSH-")) return "SSH";
  const bool has_method =
      std::ranges::any_of(kHttpMethods, [&](std::string_view method) { return opening.starts_with(method); });
  const std::size_t version = opening.rfind(" HTTP/");
  const bool has_version = version != std::string_view::npos && opening.find('{') == std::string_view::npos;
  return has_method || has_version ? "HTTP" : std::string_view();
}

}  // namespace kenaf::protocol
