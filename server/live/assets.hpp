// The page's files, read once: what is not among them is not served, so no path leads out of their folders.
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

// From share/kenaf/page; three.js from there too, or the system's, with which this was built. Throws std::runtime_error
// where there is no page. `first_page`, such as "index.html", is served as "/", and no other page.
Assets load_assets(std::string_view first_page);

}  // namespace kenaf::live
