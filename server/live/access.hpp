// Access control for viewing and driving. Pure, except make_token(). docs/live-view.md explains the threat behind each
// rule.
#pragma once

#include <string>
#include <string_view>

namespace kenaf::live {

// Returns 128 random bits as 32 hexadecimal digits. Throws std::runtime_error if the system provides none.
std::string make_token();

// Takes a time that depends only on the lengths.
bool equal_in_constant_time(std::string_view a, std::string_view b);

// True if a Host header names an address, localhost or this machine, not a name that a foreign name server points here.
// `own_name`: the machine's name, "" if it has none.
bool host_allowed(std::string_view host, std::string_view own_name);

// True if the requesting page came from this server: `origin` is http:// or https:// and `host`. Empty: no browser
// asks.
bool origin_allowed(std::string_view origin, std::string_view host);

// Returns the value of `key` in "a=1&b=2"; "" if it is missing. Nothing is decoded: a token needs no escapes.
std::string_view query_value(std::string_view query, std::string_view key);

}  // namespace kenaf::live
