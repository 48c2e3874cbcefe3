// What is a number of an option or a variable, and what is not.
#include "formats/settings/numbers.hpp"

#include <catch2/catch.hpp>
#include <clocale>
#include <limits>

using kenaf::settings::must_be_number;
using kenaf::settings::must_be_whole_number;
using kenaf::settings::number_from;
using kenaf::settings::whole_number_from;

TEST_CASE("A number is decimal, finite, and nothing else") {
  CHECK(number_from("200") == 200.0);
  CHECK(number_from("-0.5") == -0.5);
  CHECK(number_from("1e-3") == 0.001);
  CHECK(number_from("007.5") == 7.5);
  for (const char* text :
       {"",      " ",  "nan", "NaN", "-nan", "inf", "-inf", "infinity", "1e999", "-1e999", "0x10", "1,5",
        "1.5.2", "+1", " 1",  "1 ",  "1m",   "--1", "1e",   ".",        "e5",    "\t1",    "1\n"}) {
    CAPTURE(text);
    CHECK_FALSE(number_from(text));
  }
}

TEST_CASE("A whole number has no sign, fraction or leading zero") {
  CHECK(whole_number_from("0") == 0u);
  CHECK(whole_number_from("65535") == 65535u);
  CHECK(whole_number_from("18446744073709551615") == std::numeric_limits<std::uint64_t>::max());
  for (const char* text : {"", "-1", "-0", "+1", "010", "00", "0x10", "1.0", "1e3", "18446744073709551616", " 1", "1 ",
                           "nan", "99999999999999999999"}) {
    CAPTURE(text);
    CHECK_FALSE(whole_number_from(text));
  }
}

TEST_CASE("The decimal point is a point in every locale") {
  if (std::setlocale(LC_NUMERIC, "de_DE.UTF-8") == nullptr) {
    WARN("skipped: there is no locale de_DE.UTF-8");
    return;
  }
  CHECK(number_from("0.5") == 0.5);
  CHECK_FALSE(number_from("0,5"));
  std::setlocale(LC_NUMERIC, "C");
}

TEST_CASE("Ranges in words") {
  CHECK(must_be_number(0, 1e6) == "must be a number from 0 to 1000000");
  CHECK(must_be_number(-0.5, 0.25) == "must be a number from -0.5 to 0.25");
  CHECK(must_be_whole_number(1, 65535) == "must be a whole number from 1 to 65535");
}
