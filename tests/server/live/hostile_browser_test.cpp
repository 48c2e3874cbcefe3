// A page of somebody else in a real browser, which a user of this machine has open: what it can make the browser send
// commands nobody's robot.
#include <spdlog/sinks/ringbuffer_sink.h>
#include <spdlog/spdlog.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cerrno>
#include <memory>
#include <string>
#include <system_error>
#include <thread>

#include "tests/server/live/browser.hpp"
#include "tests/server/live/served_world.hpp"
#include "tests/server/live/web_client.hpp"
#include "tests/support/loopback.hpp"
#include "tests/support/patience.hpp"
#include "tests/support/process.hpp"
#include "tests/support/usarsim_client.hpp"

namespace kenaf::live {

namespace {

struct ServersLog {
  std::shared_ptr<spdlog::sinks::ringbuffer_sink_mt> sink = std::make_shared<spdlog::sinks::ringbuffer_sink_mt>(500);
  std::shared_ptr<spdlog::logger> before = spdlog::default_logger();

  ServersLog() { spdlog::set_default_logger(std::make_shared<spdlog::logger>("test", sink)); }
  ~ServersLog() { spdlog::set_default_logger(before); }
  ServersLog(const ServersLog&) = delete;
  ServersLog& operator=(const ServersLog&) = delete;

  bool has(const std::string& part) const {
    const auto lines = sink->last_formatted();
    return std::ranges::any_of(lines, [&](const std::string& line) { return line.find(part) != std::string::npos; });
  }
};

// A server of somebody else, on this machine as well, with one empty page.
class ForeignSite {
 public:
  ForeignSite() : listener_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in address = test::loopback(0);
    socklen_t size = sizeof address;
    if (::bind(listener_, reinterpret_cast<sockaddr*>(&address), sizeof address) != 0 || ::listen(listener_, 16) != 0 ||
        ::getsockname(listener_, reinterpret_cast<sockaddr*>(&address), &size) != 0) {
      throw std::system_error(errno, std::generic_category(), "foreign site");
    }
    url_ = "http://127.0.0.1:" + std::to_string(ntohs(address.sin_port)) + "/";
    thread_ = std::thread([this] { serve(); });
  }
  ~ForeignSite() {
    ::shutdown(listener_, SHUT_RDWR);  // ends accept()
    thread_.join();
    ::close(listener_);
  }
  ForeignSite(const ForeignSite&) = delete;
  ForeignSite& operator=(const ForeignSite&) = delete;

  const std::string& url() const { return url_; }

 private:
  void serve() const {
    for (;;) {
      const int browser = ::accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC);
      if (browser < 0) return;
      std::array<char, 4096> request;
      if (::recv(browser, request.data(), request.size(), 0) > 0) {
        test::send_all(browser,
                       "HTTP/1.1 200 OK\r\nContent-Type: text/html\r\nContent-Length: 16\r\nConnection: close\r\n\r\n"
                       "<p>of others</p>");
      }
      ::close(browser);
    }
  }

  int listener_;
  std::string url_;
  std::thread thread_;
};

// How a request of the page ends, as the page sees it.
std::string outcome_of(Browser& browser, const std::string& url, const std::string& options) {
  return browser.evaluate("fetch('" + url + "', " + options + ").then(() => 'answered', () => 'failed')");
}

}  // namespace

TEST_CASE("In a browser: a page of another origin places no robot, whatever it posts to the world's port",
          "[hostile]") {
  ServersLog log;
  support::TemporaryFolder profile;
  ServedWorld world;
  const ForeignSite others;
  Browser browser(profile.path());
  browser.open(others.url());
  browser.wait_for("document.body?.innerText === 'of others'");
  const std::string url = "http://127.0.0.1:" + std::to_string(world.usarsim_port()) + "/";
  const std::string lines = "INIT {ClassName USARBot.P2DX} {Name Foreign}\\r\\nDRIVE {Left 1} {Right 1}\\r\\n";
  CHECK(outcome_of(browser, url, "{method: 'POST', mode: 'no-cors', body: '" + lines + "'}") == "failed");
  REQUIRE(support::eventually([&] { return log.has("it speaks HTTP, not USARSim"); }));  // it came that far
  CHECK_FALSE(log.has("robot Foreign"));
  support::UsarsimClient controller(world.usarsim_port());
  controller.send("CONTROL {Type GetSTA} {Name Foreign}\r\n");
  CHECK(controller.line_that_begins("STA") == "STA");
}

TEST_CASE("In a browser: neither a page of another origin nor one under a foreign name reaches the live view",
          "[hostile]") {
  ServersLog log;
  support::TemporaryFolder profile;
  ServedWorld world;
  const std::string port = std::to_string(world.port());
  // As if the name server of evil.test had been told to point here.
  Browser browser(profile.path(), {"--host-resolver-rules=MAP evil.test 127.0.0.1"});
  browser.open("http://evil.test:" + port + "/");
  browser.wait_for("document.body?.innerText.includes('only requests to its address')");
  CHECK(outcome_of(browser, "http://evil.test:" + port + "/scene", "{}") == "answered");  // the same words, by 403
  CHECK(browser.evaluate("fetch('/scene').then(answer => answer.status)") == 403);

  const ForeignSite others;
  browser.open(others.url());
  browser.wait_for("document.body?.innerText === 'of others'");
  const std::string socket = "new Promise(done => { const s = new WebSocket('ws://127.0.0.1:" + port +
                             "/ws'); s.onopen = () => done('open'); s.onerror = () => done('refused'); })";
  CHECK(browser.evaluate(socket) == "refused");
}

}  // namespace kenaf::live
