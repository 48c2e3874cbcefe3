// The same frames in the formats of several programs: a SYNC, a heartbeat of node 1 in pre-operational, a remote frame.
#include "can/canlog/log_format.hpp"

#include <catch2/catch.hpp>

#include "can/canlog/driver_errors.hpp"
#include "tests/can/canlog/lines.hpp"
#include "tests/can/canopen/frames.hpp"

using namespace kenaf;
using namespace kenaf::canlog;
using namespace std::chrono_literals;
using canopen::frame_of;
using canopen::FrameKind;

namespace {

std::string describe_error(const LogFrame& frame) {
  CHECK(frame.kind == FrameKind::error);
  return driver_error_words(frame.error_class, frame.frame);
}

void check_three(const Log& log) {
  CHECK(log.bad_lines.empty());
  REQUIRE(log.frames.size() == 3);
  CHECK(log.frames[0].frame == frame_of(0x080, {}));
  CHECK(log.frames[1].frame == frame_of(0x701, {0x7f}));
  CHECK(log.frames[2].kind == FrameKind::remote);
  CHECK(log.frames[2].frame == canopen::Frame{.id = 0x701, .length = 1});
  CHECK(log.frames[1].at - log.frames[0].at == 10ms);
  CHECK(log.frames[2].at - log.frames[0].at == 20500us);
}

}  // namespace

TEST_CASE("candump with and without -L, and python-can's .log") {
  check_three(log_from("(1.000) can0 080#\n(1.010) can0 701#7F\n(1.0205) can0 701#R1\n"));
  check_three(log_from("(1.000000) can0 080# R\n(1.010000) can0 701#7F T\n(1.020500) can0 701#R1 R\n"));
  check_three(log_from(
      " (001.000000)  can0  080   [0] \n (001.010000)  can0  701   [1]  7F\n (001.020500)  can0  701   [1]  remote "
      "request\n"));
  check_three(
      log_from("(2020-12-04 23:59:59.990000) can0 080#\n(2020-12-05 00:00:00.000000) can0 701#7F\n"
               "(2020-12-05 00:00:00.010500) can0 701#R1\n"));
}

TEST_CASE("Explanations of an error message by candump -e are passed over") {
  const Log log = log_from(
      "  can0  20000004   [8]  00 08 00 00 00 00 60 00   ERRORFRAME\n\tcontroller-problem{tx-error-warning}\n"
      "\terror-counter-tx-rx{{96}{0}}\n  can0  080   [0]\n\tnonsense\n");
  CHECK(log.frames.size() == 2);
  CHECK(log.bad_lines.size() == 1);
}

TEST_CASE("PCAN traces of versions 1.1, 2.0 and 2.1") {
  check_three(
      log_from(";$FILEVERSION=1.1\r\n;$STARTTIME=39878.6772258947\r\n;---+--   ----+----\r\n"
               "     1)      1000.0  Rx         0080  0  \r\n     2)      1010.0  Rx         0701  1  7F \r\n"
               "     3)      1020.5  Tx         0701  1  RTR\r\n"));
  check_three(
      log_from(";$FILEVERSION=2.0\n;$STARTTIME=42209.4\n;$COLUMNS=N,O,T,I,d,l,D\n;\n"
               "      1      1000.000 DT     0080 Rx 0  \n      2      1010.000 DT     0701 Rx 1  7F\n"
               "      3      1020.500 RR     0701 Tx 1\n"));
  check_three(log_from(
      ";$FILEVERSION=2.1\n;$COLUMNS=N,O,T,B,I,d,R,L,D\n"
      "      1      1000.000 DT 1      0080 Rx -  0    \n      2      1010.000 DT 1      0701 Rx -  1    7F\n"
      "      3      1015.000 DT 2      0701 Rx -  1    7F\n      4      1020.500 RR 1      0701 Tx -  1    \n"));
}

TEST_CASE("Warnings, status and error lines of PCAN traces are error messages") {
  const auto words = [](const std::string& line) {
    const Log log = log_from(";$FILEVERSION=" + line);
    REQUIRE(log.bad_lines.empty());
    REQUIRE(log.frames.size() == 1);
    return describe_error(log.frames[0]);
  };
  // 0x10: bus-off; 0x08 bus heavy, from 128 errors on; 0x04 bus light, from 96 on
  CHECK(words("1.1\n 1) 1000.0 Warng FFFFFFFF 4 00 00 00 10 BUSOFF\n") == "bus-off");
  CHECK(words("2.0\n;$COLUMNS=N,O,T,I,d,l,D\n 6 1398.123 ST          Rx    00 00 00 08\n") ==
        "error passive, receiving, error passive, sending");
  CHECK(words("2.1\n;$COLUMNS=N,O,T,B,I,d,R,L,D\n 6 1398.123 ST 1  -  Rx  -  4  00 00 00 04\n") ==
        "error warning, receiving, error warning, sending");
  // kind 4: a stuff error; the third byte counts errors of receiving, the fourth those of sending
  CHECK(words("1.1\n 1) 1000.0 Error 0004 4 01 0A 19 08\n") ==
        "protocol error (stuff); error counters 8 sending, 25 receiving");
  CHECK(words("2.0\n;$COLUMNS=N,O,T,I,d,l,D\n 7 1497.232 ER          Rx    02 00 05 19 08\n") ==
        "protocol error (form); error counters 8 sending, 25 receiving");
}

TEST_CASE("Damaged lines of PCAN traces are named") {
  const Log log = log_from(
      ";$FILEVERSION=1.1\n 1) 1000.0 Rx 0080 0\n 2) x Rx 0080 0\n 3) 1000.0\n 4) 1001.0 Rx 0800 0\n"
      " 5) 1001.0 Rx 0701 2 7F\n 6) 1001.0 Xx 0701 1 7F\n 7) 1001.0 Warng FFFFFFFF 4 00 00\n"
      " 8) 1001.0 Rx 0701 1 7Z\n");
  CHECK(log.frames.size() == 1);
  CHECK(log.bad_lines.size() == 7);
}

TEST_CASE("Vector's ASCII logs, in both bases, with both kinds of times") {
  check_three(log_from(
      "date Sat Sep 30 10:06:13.191 PM 2017\nbase hex  timestamps absolute\ninternal events logged\n"
      "// version 9.0.0\nBegin Triggerblock Sat Sep 30 10:06:13.191 PM 2017\n   0.000000 Start of measurement\n"
      "   1.000000 1  80              Rx   d 0\n"
      "   1.001000 1  Statistic: D 0 R 0 XD 0 XR 0 E 0 O 0 B 0.00%\n   1.005000 2  701  Rx   d 1 7F\n"
      "   1.006000 1  701             TxRq d 1 7F\n"
      "   1.010000 1  701             Tx   d 1 7F  Length = 0 BitCount = 0 ID = 1793\n"
      "   1.020500 1  701             Rx   r 1\nEnd TriggerBlock\n"));
  // an interval counts from the event before: 1, 10 - 4, 4, 10.5
  check_three(
      log_from("date Sat\nbase dec  timestamps relative\n   1.000000 1  128  Rx   d 0\n   0.006000 SV: 1\n"
               "   0.004000 1  1793  Rx   d 1 127\n   0.010500 1  1793  Rx   r 1\n"));
}

TEST_CASE("Errors and CAN FD in Vector's ASCII logs") {
  const Log log = log_from(
      "base hex  timestamps absolute\n   1.0 1  ErrorFrame\n   1.1 CAN 1 Status:chip status bus off\n"
      "   1.2 CAN 1 Status:chip status error passive - TxErr: 132 RxErr: 0\n   1.3 1  12345678x Rx d 1 00\n"
      "   1.4 CANFD   1 Rx        701  Guard  0 0 1  1 7f  130000  130  0 0 0 0 0 0\n"
      "   1.5 CANFD   1 Rx        701         1 0 1  1 7f  130000  130  3000 0 0 0 0 0\n");
  CHECK(log.bad_lines.empty());
  REQUIRE(log.frames.size() == 6);
  CHECK(describe_error(log.frames[0]) == "protocol error (unspecified)");
  CHECK(describe_error(log.frames[1]) == "bus-off");
  CHECK(describe_error(log.frames[2]) == "error passive, receiving, error passive, sending");
  CHECK(log.frames[3].kind == FrameKind::extended);
  CHECK(log.frames[4].frame == frame_of(0x701, {0x7f}));  // no flag 0x1000: a classic frame
  CHECK(log.frames[5].kind == FrameKind::fd);
  // flag 0x10: a remote frame, which has no bytes whatever the line says
  const Log remote = log_from("base hex\n 1.0 CANFD 1 Rx 701 0 0 1 1 7f 130000 130 10 0 0 0 0 0\n");
  CHECK(remote.frames.at(0).kind == FrameKind::remote);
  CHECK(remote.frames.at(0).frame == canopen::Frame{.id = 0x701, .length = 1});
  CHECK_THAT(log_from("base hex\n 1.0 1 EngineData Rx d 1 00\n").bad_lines.at(0).words,
             Catch::Contains("symbolic names are not read"));
}

TEST_CASE("CSV of python-can") {
  const std::string header = "timestamp,arbitration_id,extended,remote,error,dlc,data\n";
  // 0x7f is 011111 11(0000): "fw"
  check_three(log_from(header + "1.0,0x80,0,0,0,0,\n1.01,0x701,0,0,0,1,fw==\n1.0205,0x701,0,1,0,1,\n"));
  const Log log = log_from(header + "1.0,0x40,0,0,1,8,AAAAAAAAAAA=\n1e-05,0x12345678,1,0,0,0,\n");
  CHECK(describe_error(log.frames.at(0)) == "bus-off");
  CHECK(log.frames.at(1).kind == FrameKind::extended);
  CHECK(
      log_from(header + "1.0,0x80,0,0,0\n1.0,80,0,0,0,0,\n1.0,0x80,2,0,0,0,\n1.0,0x80,0,0,0,1,f\n").bad_lines.size() ==
      4);
}

TEST_CASE("Formats that are not read are refused by name") {
  const auto refused = [](const std::string& text, const std::string& name) {
    CHECK_THROWS_WITH(log_from(text), Catch::Contains(name));
  };
  refused("LOGG\x90", "Vector (.blf)");
  refused("MDF     4.10", "ASAM (.mf4)");
  refused("\xd4\xc3\xb2\xa1", "(.pcap)");
  refused("***BUSMASTER Ver 3.2.0***", "BUSMASTER");
  refused("Time Stamp,ID,Extended,Dir,Bus,LEN,D1", "SavvyCAN");
  refused("Timestamp:        0.000000    ID:      123    S Rx", "python-can prints");
  refused(";$FILEVERSION=1.3\n 1) 1.0 1 Rx 0080 - 0\n", "version 1.3");
  refused(";####\n;\n     1)      1841 0001 8 00 00 00 00 00 00 00 00\n", "version 1.0");
}

TEST_CASE("A line of any length is quoted in part") {
  const Log log = log_from(std::string(1'000'000, 'x') + "\n");
  CHECK(log.bad_lines.at(0).words.size() < 200);
}
