#include "can/canlog/log_format.hpp"

#include <fmt/format.h>

#include "can/canlog/pcan_trace.hpp"
#include "can/canlog/python_can_csv.hpp"
#include "can/canlog/vector_ascii.hpp"
#include "can/canopen/candump_line.hpp"
#include "can/canopen/text_fields.hpp"

namespace kenaf::canlog {
namespace {

using namespace std::string_view_literals;

struct Refused {
  std::string_view begins, name;
};

constexpr Refused kRefused[] = {
    {"LOGG"sv, "a binary log of Vector (.blf)"},
    {"MDF "sv, "a measurement file of ASAM (.mf4)"},
    {"UnFinMF"sv, "a measurement file of ASAM (.mf4)"},
    {"\xd4\xc3\xb2\xa1"sv, "a capture of packets (.pcap)"},
    {"\xa1\xb2\xc3\xd4"sv, "a capture of packets (.pcap)"},
    {"\x4d\x3c\xb2\xa1"sv, "a capture of packets (.pcap)"},
    {"SQLite format 3"sv, "a database of SQLite"},
    {"\x1f\x8b"sv, "a file compressed by gzip"},
    {"PK\x03\x04"sv, "a ZIP archive"},
    {"\xff\xfe"sv, "a text in UTF-16"},
    {"\xfe\xff"sv, "a text in UTF-16"},
    {"***BUSMASTER"sv, "a log of BUSMASTER"},
    {"Time Stamp,ID,Extended"sv, "a CSV file of SavvyCAN"},
    {"Timestamp:"sv, "text that python-can prints"},
};
constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";

// `candump -e` explains an error message in lines below it, which begin with a tab.
class CandumpReader {
 public:
  std::optional<canopen::RecordedFrame> operator()(std::string_view line) {
    if (after_error_ && line.starts_with('\t')) return std::nullopt;
    after_error_ = false;
    const canopen::RecordedFrame read = canopen::parse_candump_line(line);
    after_error_ = read.kind == canopen::FrameKind::error;
    return read;
  }

 private:
  bool after_error_ = false;
};

}  // namespace

LineReader reader_of(std::string_view first_line) {
  for (const Refused& refused : kRefused) {
    if (!first_line.starts_with(refused.begins)) continue;
    throw std::runtime_error(
        fmt::format("{}, which is not read: export or convert it to text, for example by `candump -L`, as a PCAN trace "
                    "(.trc) or as Vector's ASCII log (.asc)",
                    refused.name));
  }
  std::string_view text = first_line;
  if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
  text = canopen::text::trimmed(text);
  if (text.starts_with(';')) return [trace = PcanTrace()](std::string_view line) mutable { return trace.read(line); };
  if (text == kPythonCanHeader) return read_python_can_csv;
  if (text.starts_with("date ") || text.starts_with("base ") || text.starts_with("//"))
    return [ascii = VectorAscii()](std::string_view line) mutable { return ascii.read(line); };
  return CandumpReader();
}

}  // namespace kenaf::canlog
