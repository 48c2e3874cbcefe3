#include "tests/server/live/browser.hpp"
#include "tests/support/patience.hpp"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <fstream>
#include <stdexcept>
#include <thread>
#include <utility>

namespace kenaf::live {

using nlohmann::json;

namespace {

std::string decode_base64(std::string_view text) {
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  unsigned bits = 0, count = 0;
  for (const char c : text) {
    const std::size_t digit = kDigits.find(c);
    if (digit == std::string_view::npos) break;
    bits = bits << 6 | static_cast<unsigned>(digit);
    count += 6;
    if (count >= 8) out += static_cast<char>(bits >> (count -= 8) & 0xff);
  }
  return out;
}

}  // namespace

Browser::Browser(const std::filesystem::path& profile, const std::vector<std::string>& switches) {
  int there[2], back[2];
  if (::pipe2(there, O_CLOEXEC) != 0 || ::pipe2(back, O_CLOEXEC) != 0) throw std::runtime_error("no pipes");
  const std::string data = "--user-data-dir=" + profile.string();
  // A sandbox needs rights that a container lacks; the page is our own. Software draws: there is no GPU to rely on.
  // It draws what WebGL asks for alone: a page put together by it takes seconds a picture.
  std::vector<const char*> argv{KENAF_CHROMIUM,
                                "--headless",
                                "--no-sandbox",
                                "--use-angle=swiftshader",
                                "--enable-unsafe-swiftshader",
                                "--disable-gpu-compositing",
                                "--disable-dev-shm-usage",
                                "--hide-scrollbars",
                                "--no-first-run",
                                "--disable-background-networking",
                                "--disable-component-update",
                                "--remote-debugging-pipe",
                                data.c_str()};
  for (const std::string& each : switches) argv.push_back(each.c_str());
  argv.insert(argv.end(), {"about:blank", nullptr});
  pid_ = ::fork();
  if (pid_ == 0) {
    ::setpgid(0, 0);  // its own processes go with it
    // DevTools' pipes are descriptors 3 and 4; first out of the way of each other
    const int in = ::fcntl(there[0], F_DUPFD, 10), out = ::fcntl(back[1], F_DUPFD, 10);
    ::dup2(in, 3);
    ::dup2(out, 4);
    const int nowhere = ::open("/dev/null", O_RDWR);
    for (const int standard : {0, 1, 2}) ::dup2(nowhere, standard);
    ::execv(KENAF_CHROMIUM, const_cast<char* const*>(argv.data()));
    ::_exit(127);
  }
  ::close(there[0]);
  ::close(back[1]);
  to_ = there[1];
  from_ = back[0];
  ::signal(SIGPIPE, SIG_IGN);
  const std::string target = call("Target.createTarget", {{"url", "about:blank"}})["targetId"];
  session_ = call("Target.attachToTarget", {{"targetId", target}, {"flatten", true}})["sessionId"];
  for (const char* domain : {"Page.enable", "Runtime.enable", "Log.enable"}) call(domain);
  call("Emulation.setFocusEmulationEnabled", {{"enabled", true}});
}

Browser::~Browser() {
  ::close(to_);
  ::close(from_);
  ::kill(-pid_, SIGKILL);
  ::waitpid(pid_, nullptr, 0);
}

json Browser::receive() {
  for (;;) {
    if (const std::size_t end = received_.find('\0'); end != std::string::npos) {
      json message = json::parse(received_.substr(0, end));
      received_.erase(0, end + 1);
      return message;
    }
    pollfd waiting{from_, POLLIN, 0};
    if (::poll(&waiting, 1, 1000 * static_cast<int>(support::patience().count())) <= 0)
      throw std::runtime_error("the browser does not answer");
    char bytes[65536];
    const ssize_t count = ::read(from_, bytes, sizeof bytes);
    if (count <= 0) throw std::runtime_error("the browser ended; is " KENAF_CHROMIUM " installed?");
    received_.append(bytes, static_cast<std::size_t>(count));
  }
}

void Browser::note(const json& event) {
  const std::string method = event.value("method", "");
  const bool error_entry = method == "Log.entryAdded" && event["params"]["entry"]["level"] == "error";
  const bool console_error = method == "Runtime.consoleAPICalled" && event["params"]["type"] == "error";
  if (error_entry || console_error || method == "Runtime.exceptionThrown")
    complaints_.push_back(event["params"].dump());
}

json Browser::call(const std::string& method, json parameters) {
  json message{{"id", ++last_call_}, {"method", method}, {"params", std::move(parameters)}};
  if (!session_.empty()) message["sessionId"] = session_;
  const std::string bytes = message.dump() + '\0';
  if (::write(to_, bytes.data(), bytes.size()) != static_cast<ssize_t>(bytes.size())) {
    throw std::runtime_error("the browser ended; is " KENAF_CHROMIUM " installed?");
  }
  for (;;) {
    json answer = receive();
    if (answer.value("id", 0) != last_call_) {
      note(answer);
      continue;
    }
    if (answer.contains("error")) {
      const std::string error = method + ": " + answer["error"].dump();
      if (error.find("Inspected target navigated") != std::string::npos) throw PageLeft(error);
      throw std::runtime_error(error);
    }
    return answer["result"];
  }
}

void Browser::open(const std::string& url) {
  call("Page.navigate", {{"url", url}});
}

void Browser::download_to(const std::filesystem::path& folder) {
  const std::string page = std::exchange(session_, {});  // it is the browser that is told
  call("Browser.setDownloadBehavior", {{"behavior", "allow"}, {"downloadPath", folder.string()}});
  session_ = page;
}

void Browser::resize(int width, int height, bool phone) {
  call("Emulation.setDeviceMetricsOverride",
       {{"width", width}, {"height", height}, {"deviceScaleFactor", 1}, {"mobile", phone}});
}

void Browser::set_dark(bool dark) {
  const json feature{{"name", "prefers-color-scheme"}, {"value", dark ? "dark" : "light"}};
  call("Emulation.setEmulatedMedia", {{"features", json::array({feature})}});
}

void Browser::set_print(bool print) {
  call("Emulation.setEmulatedMedia", {{"media", print ? "print" : "screen"}});
}

void Browser::key(std::string_view code, bool down, std::string_view key) {
  json event{{"type", down ? "rawKeyDown" : "keyUp"}, {"code", code}, {"key", key.empty() ? code : key}};
  if (code == "ShiftLeft" || code == "ShiftRight") shift_ = down;
  if (shift_) event["modifiers"] = 8;
  if (code == "Enter" || code == "Space") {
    event["windowsVirtualKeyCode"] = code == "Enter" ? 13 : 32;
    event["key"] = code == "Enter" ? "Enter" : " ";
    if (down) event["type"] = "keyDown";
    if (down) event["text"] = code == "Enter" ? "\r" : " ";
  }
  call("Input.dispatchKeyEvent", event);
}

void Browser::mouse(const std::string& what, double x, double y, int clicks) {
  call("Input.dispatchMouseEvent",
       {{"type", what}, {"x", x}, {"y", y}, {"button", "left"}, {"buttons", 1}, {"clickCount", clicks}});
}

void Browser::click(const std::string& selector) {
  const json at = evaluate("(() => { const box = document.querySelector(" + json(selector).dump() +
                           ").getBoundingClientRect(); return [box.x + box.width / 2, box.y + box.height / 2]; })()");
  mouse("mouseMoved", at[0], at[1]);
  mouse("mousePressed", at[0], at[1]);
  mouse("mouseReleased", at[0], at[1]);
}

json Browser::evaluate(const std::string& expression) {
  const json answer =
      call("Runtime.evaluate", {{"expression", expression}, {"returnByValue", true}, {"awaitPromise", true}});
  if (answer.contains("exceptionDetails")) throw PageThrew(answer["exceptionDetails"].dump());
  return answer["result"].value("value", json());
}

void Browser::wait_for(const std::string& expression) {
  std::string why;
  const bool held = support::eventually([&] {
    try {
      why.clear();
      return evaluate("Boolean(" + expression + ")") == true;
    } catch (const PageLeft&) {
      return false;  // it was asked while the page loaded itself anew
    } catch (const PageThrew& error) {
      why = std::string(", last: ") + error.what();
      return false;  // what it is about may not be there yet
    }
  });
  if (!held) throw std::runtime_error("in vain waited for: " + expression + why);
}

void Browser::screenshot(const std::filesystem::path& png) {
  const std::string data = call("Page.captureScreenshot", {{"format", "png"}})["data"];
  std::ofstream(png, std::ios::binary) << decode_base64(data);
}

}  // namespace kenaf::live
