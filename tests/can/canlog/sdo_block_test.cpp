// Block transfers, their frames worked out by hand from CiA 301, 7.2.4.3.9 to 7.2.4.3.15.
#include "can/canlog/sdo_block.hpp"

#include <catch2/catch.hpp>

#include "can/canlog/describe.hpp"
#include "tests/can/canlog/lines.hpp"

using namespace kenaf;
using namespace kenaf::canlog;

namespace {

// CRCs by another program, binascii.crc_hqx of Python: "ABCDEFGHIJ" 0x86f5, "Tiny Node" 0x4050.

// Ten bytes "ABCDEFGHIJ" to 0x1f50:01, with size and CRC: 110 00 1 1 0, answered 101 00 1 00 with blocks of 127.
const Lines kWriteBegin{{0, "601#C6501F010A000000"}, {1, "581#A4501F017F000000"}};
const Lines kWriteData{{2, "601#0141424344454647"}, {3, "601#8248494A00000000"}, {4, "581#A2027F0000000000"}};
// 4 of 7 bytes are unused: 110 100 0 1
const Lines kWriteEnd{{5, "601#D1F5860000000000"}, {6, "581#A100000000000000"}};

// Nine bytes "Tiny Node" from 0x1008, in one block of two; 5 bytes unused: 110 101 0 1.
const Lines kRead{{0, "601#A40810007F000000"}, {1, "581#C608100009000000"}, {2, "601#A300000000000000"},
                  {3, "581#0154696E79204E6F"}, {4, "581#8264650000000000"}, {5, "601#A2027F0000000000"},
                  {6, "581#D550400000000000"}, {7, "601#A100000000000000"}};

}  // namespace

TEST_CASE("The CRC of a block transfer is that of the standard's example") {
  const std::string digits = "123456789";
  CHECK(block_crc({reinterpret_cast<const std::uint8_t*>(digits.data()), digits.size()}) == 0x31c3);
  CHECK(block_crc({}) == 0);
  // 0x80 is the divisor's x^7 times x^16: x^23 = x^7 (x^12 + x^5 + 1) = x^19 + x^12 + x^7, and x^19 = x^15 + x^8 + x^3
  const std::uint8_t top = 0x80;
  CHECK(block_crc({&top, 1}) == 0x9188);
}

TEST_CASE("A block download and a block upload break no rule") {
  CHECK(broken(kWriteBegin + kWriteData + kWriteEnd).empty());
  CHECK(broken(kRead).empty());
  CHECK(broken(kWriteBegin + kWriteData + kWriteEnd + Lines{{10, "601#4000100000000000"}, {11, "581#4300100092010200"}})
            .empty());
}

TEST_CASE("Block transfers are put in words, with their objects and data") {
  CHECK(words_of(kWriteBegin + kWriteData + kWriteEnd) ==
        std::vector<std::string>{
            "SDO block write 0x1f50:01 (program data, 1) of track left, 10 bytes",
            "SDO block answer of track left: 0x1f50:01 (program data, 1), in blocks of 127",
            "SDO block segment 1 to track left: \"ABCDEFG\"",
            "SDO block segment 2 to track left: 48 49 4A 00 00 00 00, the last",
            "SDO block answer of track left: up to segment 2 taken, next block of 127",
            "SDO block end to track left: 0x1f50:01 (program data, 1) = \"ABCDEFGHIJ\", 10 bytes, CRC 0x86f5",
            "SDO block answer of track left: end confirmed"});
  CHECK(words_of(kRead) ==
        std::vector<std::string>{
            "SDO block from track left: read 0x1008:00 (device name), in blocks of 127",
            "SDO block answer of track left: 0x1008:00 (device name), 9 bytes", "SDO block from track left: start",
            "SDO block segment 1 of track left: \"Tiny No\"",
            "SDO block segment 2 of track left: 64 65 00 00 00 00 00, the last",
            "SDO block from track left: up to segment 2 taken, next block of 127",
            "SDO block end of track left: 0x1008:00 (device name) = \"Tiny Node\", 9 bytes, CRC 0x4050",
            "SDO block from track left: end confirmed"});
}

TEST_CASE("A wrong CRC and a wrong size are findings") {
  CHECK(broken(kWriteBegin + kWriteData + Lines{{5, "601#D1F5870000000000"}, {6, "581#A100000000000000"}}) ==
        Broken{"6: sdo-block"});
  // 5 bytes unused: nine bytes, ten were announced
  CHECK(broken(kWriteBegin + kWriteData + Lines{{5, "601#D5F5860000000000"}, {6, "581#A100000000000000"}}) ==
        Broken{"6: sdo-block"});
  // without the server's bit (0xA0) there is no CRC
  CHECK(broken(Lines{{0, "601#C6501F010A000000"}, {1, "581#A0501F017F000000"}} + kWriteData +
               Lines{{5, "601#D100000000000000"}, {6, "581#A100000000000000"}})
            .empty());
}

TEST_CASE("Segments are numbered from 1 in each block, and sent again where they are not acknowledged") {
  // blocks of two; the second segment is lost: 1 is acknowledged, and the rest comes again
  const Lines begin{{0, "601#C6501F010A000000"}, {1, "581#A4501F0102000000"}};
  CHECK(broken(begin +
               Lines{{2, "601#0141424344454647"},
                     {3, "601#8248494A00000000"},
                     {4, "581#A201020000000000"},
                     {5, "601#8148494A00000000"},
                     {6, "581#A201020000000000"}} +
               kWriteEnd)
            .empty());
  CHECK(broken(begin + Lines{{2, "601#0141424344454647"}, {3, "601#8348494A00000000"}}) == Broken{"4: sdo-block"});
  CHECK(broken(begin + Lines{{2, "601#0141424344454647"}, {3, "601#8248494A00000000"}, {4, "581#A203020000000000"}}) ==
        Broken{"5: sdo-block"});
  // a block of no segments
  CHECK(broken({{0, "601#C6501F010A000000"}, {1, "581#A4501F0100000000"}}) == Broken{"2: sdo-block"});
}

TEST_CASE("The first byte of a segment is its number, whatever else it would mean") {
  // 32 is 0x20, which begins a write elsewhere; 64 is 0x40; 96 is 0x60
  Lines lines{{0, "601#C4501F0100000000"}, {1, "581#A4501F017F000000"}};
  std::vector<std::string> frames;
  for (int number = 1; number <= 100; ++number)
    frames.push_back(fmt::format("601#{:02X}00000000000000", number == 100 ? 0x80 | number : number));
  for (const std::string& frame : frames) lines.push_back({2, frame});
  // the CRC of zeros is 0
  CHECK(broken(lines + Lines{{3, "581#A2647F0000000000"}, {4, "601#C100000000000000"}, {5, "581#A100000000000000"}})
            .empty());
}

TEST_CASE("A block transfer ends with an abort of either side, and is answered in time") {
  const Lines ask{{10, "601#4000100000000000"}, {11, "581#4300100092010200"}};
  CHECK(broken(kWriteBegin + Lines{{2, "581#80501F0121000008"}} + ask).empty());
  CHECK(broken(kWriteBegin + Lines{{2, "601#0141424344454647"}, {3, "601#80501F0121000008"}} + ask).empty());
  // 0x40 would be segment 64, and 0x43 is no frame of a block transfer: it is given up, and the next one judged
  CHECK(broken(kWriteBegin + ask + ask + ask) == Broken{"3: sdo-block", "4: sdo-block"});
  CHECK(broken({{0, "601#C6501F010A000000"}, {900, "080#"}}) == Broken{"1: sdo-time"});
  CHECK(broken(kWriteBegin + Lines{{2, "601#0141424344454647"}, {3, "601#8248494A00000000"}, {900, "080#"}}) ==
        Broken{"4: sdo-time"});
}

TEST_CASE("A node may answer the request of a block by an ordinary transfer") {
  CHECK(broken({{0, "601#A40010007F040000"}, {1, "581#4300100092010200"}}).empty());
}

TEST_CASE("What a block download has written is in force") {
  // 0x1016:1 = 0x007f0064, node 127 each 100 ms: four bytes, three unused, 110 011 0 1; without a CRC
  const Lines watch{{0, "601#C216100104000000"}, {1, "581#A01610017F000000"}, {2, "601#8164007F00000000"},
                    {3, "581#A2017F0000000000"}, {4, "601#CD00000000000000"}, {5, "581#A100000000000000"}};
  CHECK(broken(watch + Lines{{300, "77F#05"}, {401, "77F#05"}}) == Broken{"7: master-heartbeat"});
}
