#pragma once

#include <spdlog/sinks/ostream_sink.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <memory>
#include <sstream>
#include <string_view>

namespace kenaf::world_server {

// All that is logged, at the most talkative level.
struct WholeLog {
  std::ostringstream text;
  std::shared_ptr<spdlog::logger> before = spdlog::default_logger();

  WholeLog() {
    auto logger = std::make_shared<spdlog::logger>("test", std::make_shared<spdlog::sinks::ostream_sink_mt>(text));
    logger->set_level(spdlog::level::trace);
    spdlog::set_default_logger(logger);
  }
  ~WholeLog() { spdlog::set_default_logger(before); }
  WholeLog(const WholeLog&) = delete;
  WholeLog& operator=(const WholeLog&) = delete;

  std::ptrdiff_t lines() const { return std::ranges::count(text.view(), '\n'); }
  bool has(std::string_view part) const { return text.view().find(part) != std::string_view::npos; }
};

}  // namespace kenaf::world_server
