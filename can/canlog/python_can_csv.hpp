// CSV files of python-can: its CSVWriter, and `can_logger -f bus.csv`.
//
//   timestamp,arbitration_id,extended,remote,error,dlc,data
//   1483389464.165,0x701,0,0,0,1,fw==                          the bytes in base 64 (RFC 4648)
//
// There is no interface: "can". Source: python-can, can/io/csv.py. Pure functions.
#pragma once

#include <optional>
#include <string_view>

#include "can/canopen/recorded_frame.hpp"

namespace kenaf::canlog {

inline constexpr std::string_view kPythonCanHeader = "timestamp,arbitration_id,extended,remote,error,dlc,data";

// nullopt: the header, or an empty line. Throws canopen::BadLogLine.
std::optional<canopen::RecordedFrame> read_python_can_csv(std::string_view line);

}  // namespace kenaf::canlog
