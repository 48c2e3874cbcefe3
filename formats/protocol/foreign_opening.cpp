#include "formats/protocol/foreign_opening.hpp"

#include <algorithm>
#include <array>

namespace kenaf::protocol {

namespace {

constexpr char kTlsHandshake = '\x16';
constexpr std::array<std::string_view, 10> kHttpMethods{"GET ",     "HEAD ",    "POST ",  "PUT ",   "DELETE ",
                                                        "CONNECT ", "OPTIONS ", "TRACE ", "PATCH ", "PRI "};

}  // namespace

std::string_view foreign_protocol(std::string_view opening, bool is_whole) {
  if (opening.starts_with(kTlsHandshake)) return "TLS";
  if (opening.starts_with("SSH-")) return "SSH";
  const bool has_method =
      std::ranges::any_of(kHttpMethods, [&](std::string_view method) { return opening.starts_with(method); });
  const bool has_version =
      is_whole && opening.find(" HTTP/") != std::string_view::npos && opening.find('{') == std::string_view::npos;
  return has_method || has_version ? "HTTP" : std::string_view();
}

std::string_view Opening::take(std::string_view bytes) {
  if (decided_) return {};
  // Empty lines before a request are skipped, as HTTP servers and the readers of USARSim's lines do.
  if (first_line_.empty()) bytes.remove_prefix(std::min(bytes.find_first_not_of("\r\n"), bytes.size()));
  const std::size_t end = std::min(bytes.find_first_of("\r\n"), bytes.size());
  const std::size_t room = kMost_bytes - first_line_.size();
  first_line_.append(bytes.substr(0, std::min(end, room)));

  const bool is_whole = end < bytes.size() && end < room;
  const std::string_view protocol = foreign_protocol(first_line_, is_whole);
  decided_ = !protocol.empty() || is_whole || first_line_.size() >= kMost_bytes;
  if (decided_) first_line_ = {};
  return protocol;
}

}  // namespace kenaf::protocol
