// Any key and report, one after the other with a zero byte between, are scored or it is said why not.
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>

#include "gap/challenge/score.hpp"

using namespace kenaf;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const std::size_t between = text.find('\0');
  if (between == text.npos) return 0;
  std::vector<gap::challenge::ScoredCase> cases;
  try {
    const gap::challenge::ReadReport report = gap::challenge::report_of(std::string(text.substr(between + 1)));
    for (const gap::challenge::SealedCase& sealed :
         gap::challenge::read_key(std::string(text.substr(0, between))).cases)
      cases.push_back({sealed, report, {}});
  } catch (const std::runtime_error&) {
    return 0;
  }
  for (const gap::challenge::Figure& figure : gap::challenge::figures(cases))
    if (figure.cases > 2 * cases.size()) __builtin_trap();
  if (gap::challenge::score_markdown(cases).empty() || gap::challenge::score_json(cases).empty()) __builtin_trap();
  return 0;
}
