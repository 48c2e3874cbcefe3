// The page's files, read once: no other file is served, so no path leads out of their folders.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <string_view>

namespace kenaf::live {

struct Asset {
  std::string_view type;
  std::string bytes;
};
using Assets = std::map<std::string, Asset, std::less<>>;  // by path: "/", "/page.css", "/three/build/three.module.js"

// Reads share/kenaf/page, and three.js from share/kenaf/three. Throws std::runtime_error with a text for the user if
// one of the two is not there. Of the pages only `first_page`, such as "index.html", is served, as "/".
Assets load_assets(std::string_view first_page);

}  // namespace kenaf::live
