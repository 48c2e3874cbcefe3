// Headers of every answer of the live view that make a browser restrict the page.
#pragma once

#include <string>
#include <string_view>
#include <utility>

namespace kenaf::live {

// Nothing is loaded from elsewhere, even if foreign text is injected into the page.
inline constexpr std::pair<const char*, const char*> kSafetyHeaders[] = {
    {"Content-Security-Policy",
     "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' blob:; connect-src 'self'; base-uri "
     "'none'; "
     "form-action 'none'; frame-ancestors 'none'"},
    {"X-Content-Type-Options", "nosniff"},
    {"Referrer-Policy", "no-referrer"},
    {"Cross-Origin-Resource-Policy", "same-origin"},
};

// The same as header lines.
inline std::string safety_headers() {
  std::string out;
  for (const auto& [name, value] : kSafetyHeaders) out += std::string(name) + ": " + value + "\r\n";
  return out;
}

}  // namespace kenaf::live
