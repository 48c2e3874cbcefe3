// A browser without a window: Chromium, controlled by its DevTools protocol over two pipes.
//
// Waits at most 60 s for each answer, then throws std::runtime_error. Thread safety: one thread.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace kenaf::live {

// The page was left, or loaded anew, before it answered.
struct PageLeft : std::runtime_error {
  using std::runtime_error::runtime_error;
};
// What was evaluated threw.
struct PageThrew : std::runtime_error {
  using std::runtime_error::runtime_error;
};

class Browser {
 public:
  // Opens an empty page. `profile`: an empty folder; `switches`: further ones of Chromium's. Throws where there is no
  // Chromium.
  explicit Browser(const std::filesystem::path& profile, const std::vector<std::string>& switches = {});
  ~Browser();
  Browser(const Browser&) = delete;
  Browser& operator=(const Browser&) = delete;

  void open(const std::string& url);
  // Files that the page gives the person come into this folder, without a question.
  void download_to(const std::filesystem::path& folder);
  void resize(int width, int height, bool phone = false);
  void set_dark(bool dark);
  void set_print(bool print);  // as on paper, or on a screen
  // `code`: a KeyboardEvent.code, "KeyW"; `key`: what it types, if that matters. Enter, Space and Shift do what they
  // do.
  void key(std::string_view code, bool down, std::string_view key = {});
  // "mousePressed", "mouseMoved" or "mouseReleased" of the left button, which is down meanwhile.
  // `clicks`: 2 for the second press of a double click.
  void mouse(const std::string& what, double x, double y, int clicks = 1);
  // Presses and releases the left button in the middle of the element, which is on the screen.
  void click(const std::string& selector);
  // What the expression is worth; a promise is waited for. Throws where it throws.
  nlohmann::json evaluate(const std::string& expression);
  // Until the expression is true. It may throw before that, and the page may load itself anew.
  void wait_for(const std::string& expression);
  void screenshot(const std::filesystem::path& png);
  // What the page complained of so far: errors, exceptions, what its policy kept out.
  const std::vector<std::string>& complaints() const { return complaints_; }

 private:
  nlohmann::json call(const std::string& method, nlohmann::json parameters = nlohmann::json::object());
  nlohmann::json receive();
  void note(const nlohmann::json& event);

  pid_t pid_ = -1;
  int to_ = -1, from_ = -1;
  int last_call_ = 0;
  bool shift_ = false;
  std::string session_, received_;
  std::vector<std::string> complaints_;
};

}  // namespace kenaf::live
