// Listens where the options say, and serves a site on a thread of its own.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "server/live/site.hpp"
#include "server/live/view_options.hpp"

namespace kenaf::live {

// The token of the options; where they have none, one is made unless only this machine's programs can ask.
// Throws std::runtime_error in words.
std::string token_for(const ViewOptions& options);
// "" where the system does not say.
std::string machine_name();

class WebServer {
 public:
  // Listens. Throws std::runtime_error in words. `site` must outlive this.
  WebServer(Site& site, const ViewOptions& options);
  // Stops serving: no handler of `site` runs any more.
  ~WebServer();
  WebServer(const WebServer&) = delete;
  WebServer& operator=(const WebServer&) = delete;

  // Serves from now on; the site is its thread's. Once.
  void start();
  std::uint16_t port() const;
  // What to open in a browser, with the token, where one is needed.
  std::string url() const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> impl_;
};

}  // namespace kenaf::live
