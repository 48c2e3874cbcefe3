// Listens where the options say, and serves a site on its own thread.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "server/live/site.hpp"
#include "server/live/view_options.hpp"

namespace kenaf::live {

// Returns the token of the options; if they have none, generates one unless only programs of this machine can connect.
// Throws std::runtime_error with a text for the user.
std::string token_for(const ViewOptions& options);
// "" if the system does not provide it.
std::string machine_name();

class WebServer {
 public:
  // Listens. Throws std::runtime_error with a text for the user. `site` must outlive this.
  WebServer(Site& site, const ViewOptions& options);
  // Stops serving: no handler of `site` runs afterwards.
  ~WebServer();
  WebServer(const WebServer&) = delete;
  WebServer& operator=(const WebServer&) = delete;

  // Serves from now on; the site then belongs to its thread. Call once.
  void start();
  std::uint16_t port() const;
  // The address to open in a browser, with the token, if one is needed.
  std::string url() const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> impl_;
};

}  // namespace kenaf::live
