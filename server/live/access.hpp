// Who may look and drive. Pure, but for make_token(). docs/live-view.md says against whom each rule stands.
#pragma once

#include <string>
#include <string_view>

namespace kenaf::live {

// 128 random bits as 32 hexadecimal digits. Throws std::runtime_error where the system gives none.
std::string make_token();

// In a time that depends on the lengths alone.
bool equal_in_constant_time(std::string_view a, std::string_view b);

// A Host header that names an address, localhost or this machine: not one that somebody's name server points here.
// `own_name`: the machine's name, "" where it has none.
bool host_allowed(std::string_view host, std::string_view own_name);

// The page that asks came from this server: `origin` is http:// or https:// and `host`. Empty: no browser asks.
bool origin_allowed(std::string_view origin, std::string_view host);

// The value of `key` in "a=1&b=2"; "" where it is missing. Nothing is decoded: a token needs no escapes.
std::string_view query_value(std::string_view query, std::string_view key);

}  // namespace kenaf::live
