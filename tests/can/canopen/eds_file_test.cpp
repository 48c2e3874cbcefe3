// Electronic data sheets: what they say of each object, by CiA 306-1, and what is wrong with them, by line.
#include "can/canopen/eds_file.hpp"

#include <catch2/catch.hpp>

using namespace kenaf::canopen;

namespace {

const std::string kDrive =
    "[DeviceInfo]\r\n"          // 1
    "VendorName=Maker\r\n"      // 2
    "ProductName=Drive 7\r\n"   // 3
    "NrOfRXPDO=4\r\n"           // 4
    "NrOfTXPDO=0x4\r\n"         // 5
    "; a comment\r\n"           // 6
    "[OptionalObjects]\r\n"     // 7
    "SupportedObjects=2\r\n"    // 8
    "1=0x1400\r\n"              // 9
    "2=0x60FF\r\n"              // 10
    "[60ff]\r\n"                // 11
    "ParameterName=Target\r\n"  // 12
    "ObjectType=0x7\r\n"        // 13
    "DataType=0x0004\r\n"       // 14
    "AccessType=RWW\r\n"        // 15
    "LowLimit=0x80000000\r\n"   // 16: -2^31
    "HighLimit=017\r\n"         // 17: octal
    "DefaultValue=-5\r\n"       // 18
    "PDOMapping=1\r\n"          // 19
    "[1400]\r\n"                // 20
    "ObjectType=0x9\r\n"        // 21
    "SubNumber=2\r\n"           // 22
    "[1400sub1]\r\n"            // 23
    "DataType=0x0007\r\n"       // 24
    "AccessType=rw\r\n"         // 25
    "DefaultValue=$NODEID+0x200\r\n";

}  // namespace

TEST_CASE("An EDS says type, access, limits, value and mapping of each object") {
  const EdsFile file = read_eds(kDrive);
  CHECK(file.faults.empty());
  CHECK(file.vendor == "Maker");
  CHECK(file.product == "Drive 7");
  CHECK(file.receive_pdos == 4);
  CHECK(file.transmit_pdos == 4);
  CHECK(file.objects.size() == 2);  // the record is in its sub-indices
  const EdsObject* target = file.find({0x60ff, 0});
  REQUIRE(target);
  CHECK(target->line == 11);
  CHECK(target->name == "Target");
  CHECK(describe(target->type) == "INTEGER32");
  CHECK(target->access == EdsAccess::read_write);
  CHECK(target->mappable);
  CHECK(target->low == EdsNumber{-2147483648, false});
  CHECK(target->high == EdsNumber{15, false});
  CHECK(target->value == EdsNumber{-5, false});
  const EdsObject* id = file.find({0x1400, 1});
  REQUIRE(id);
  CHECK(id->value == EdsNumber{0x200, true});
  CHECK(value_for(*id->value, 5) == 0x205);
}

TEST_CASE("In a DCF the configured value stands before the default one, and the node has a number") {
  const EdsFile file = read_eds(
      "[6060]\nDataType=2\nAccessType=rw\nDefaultValue=1\nParameterValue=3\n"
      "[DeviceCommissioning]\nNodeID=0x11\n");
  CHECK(file.find({0x6060, 0})->value == EdsNumber{3, false});
  CHECK(file.node == 17);
}

TEST_CASE("One section may stand for all sub-indices, and CompactPDO for all records of PDOs") {
  const EdsFile file = read_eds(
      "[1003]\nParameterName=Error\nObjectType=8\nDataType=7\nAccessType=ro\nCompactSubObj=3\n"
      "[1003Name]\n2=Second\n[1003Value]\n3=0x21\n[DeviceInfo]\nNrOfRXPDO=1\nNrOfTXPDO=2\nCompactPDO=3\n");
  CHECK(file.find({0x1003, 0})->value == EdsNumber{3, false});
  CHECK(file.find({0x1003, 1})->name == "Error1");
  CHECK(file.find({0x1003, 2})->name == "Second");
  CHECK(file.find({0x1003, 3})->value == EdsNumber{0x21, false});
  CHECK_FALSE(file.find({0x1003, 4}));
  CHECK(file.find({0x1400, 1}));
  CHECK_FALSE(file.find({0x1401, 1}));
  CHECK(file.find({0x1a01, 8})->access == EdsAccess::read_write);
}

TEST_CASE("What is wrong with an EDS is listed by line, and the rest is read") {
  const EdsFile open_section = read_eds("[1000\n[1001]\n");
  REQUIRE(open_section.faults.size() == 1);
  CHECK(open_section.faults[0].line == 1);
  CHECK_THAT(open_section.faults[0].words, Catch::Contains("without ]"));
  CHECK_THAT(read_eds("x=1\n[1001]\n").faults.at(0).words, Catch::Contains("before the first section"));
  const auto fault_of = [](const std::string& line) {
    const EdsFile file = read_eds("[1001]\nDataType=5\n" + line + "\n");
    REQUIRE(file.faults.size() == 1);
    CHECK(file.faults[0].line == 3);
    CHECK(file.find({0x1001, 0}));
    return file.faults[0].words;
  };
  CHECK_THAT(fault_of("nonsense"), Catch::Contains("neither [section] nor key=value"));
  CHECK_THAT(fault_of("DefaultValue=0x100"), Catch::Contains("UNSIGNED8 cannot hold"));
  CHECK_THAT(fault_of("LowLimit=one"), Catch::Contains("no whole number"));
  CHECK_THAT(fault_of("AccessType=maybe"), Catch::Contains("must be ro, wo, rw"));
  CHECK_THAT(fault_of("PDOMapping=2"), Catch::Contains("from 0 to 1"));
  CHECK_THAT(fault_of("DataType=6"), Catch::Contains("already, in line 2"));
  CHECK_THAT(fault_of("[1001]"), Catch::Contains("already, in line 1"));
  CHECK_THAT(read_eds("[1001]\n[OptionalObjects]\n1=0x1234\n").faults.at(0).words, Catch::Contains("has no section"));
}

TEST_CASE("A file without objects is no EDS") {
  CHECK_THROWS_WITH(read_eds(""), Catch::Contains("no [section]"));
  CHECK_THROWS_WITH(read_eds("\n[track]\nlength_m = 1\n"), Catch::Contains("line 2"));
}

TEST_CASE("Numbers are decimal, hexadecimal or octal, with the node's number before or behind") {
  CHECK(eds_number("10") == EdsNumber{10, false});
  CHECK(eds_number("0X1f") == EdsNumber{31, false});
  CHECK(eds_number("-010") == EdsNumber{-8, false});
  CHECK(eds_number("$NodeId") == EdsNumber{0, true});
  CHECK(eds_number("0x180 + $NODEID") == EdsNumber{0x180, true});
  CHECK(eds_number("$NODEID+0x180") == EdsNumber{0x180, true});
  for (const char* bad : {"", "-", "0x", "1.5", "08", "$NODE", "1+1", "$NODEID+", "99999999999999999999"})
    CHECK_FALSE(eds_number(bad));
}
