#include "daemon/config/quantity_text.h"

#include <gtest/gtest.h>

namespace imunoise::config {
namespace {

TEST(QuantityText, ReadsTimesAsPeopleWriteThem) {
  EXPECT_EQ(parse_duration("2h").value(), 7200.0);
  EXPECT_EQ(parse_duration("90 s").value(), 90.0);
  EXPECT_EQ(parse_duration("1 h 30 min").value(), 5400.0);
  EXPECT_EQ(parse_duration("1h30min").value(), 5400.0);
  EXPECT_EQ(parse_duration("0.5 d").value(), 43200.0);
  EXPECT_EQ(parse_duration(" 250 ms ").value(), 0.25);
  EXPECT_EQ(parse_duration("0 s").value(), 0.0);
}

TEST(QuantityText, RefusesTimesThatAreNone) {
  for (const char* const text : {"", " ", "2", "h", "2 lightyears", "-1 s", "1 s 2", "nan s",
                                 "inf s", "1e9 s", "200000 d", "1 s,"}) {
    const auto read = parse_duration(text);
    ASSERT_FALSE(read.has_value()) << text;
    EXPECT_NE(read.error().message.find(text), std::string::npos) << read.error().message;
  }
  EXPECT_NE(parse_duration("2").error().message.find("unit is missing"), std::string::npos);
  EXPECT_NE(parse_duration("2 hs").error().message.find("'hs'"), std::string::npos);
}

TEST(QuantityText, PrintsWhatItReads) {
  for (const double seconds : {0.0, 0.25, 1.0, 61.0, 5400.0, 90061.0, 604800.0, 1e7}) {
    EXPECT_EQ(parse_duration(print_duration(seconds)).value(), seconds) << print_duration(seconds);
  }
  EXPECT_EQ(print_duration(5400.0), "1 h 30 min");
  EXPECT_EQ(print_duration(0.0), "0 s");
  EXPECT_EQ(print_duration(59.9999), "1 min");
}

TEST(QuantityText, ReadsAndPrintsSizes) {
  EXPECT_EQ(parse_bytes("20 GB").value(), 20'000'000'000U);
  EXPECT_EQ(parse_bytes("1.5KiB").value(), 1536U);
  EXPECT_EQ(parse_bytes("0 B").value(), 0U);
  for (const char* const text : {"20", "GB", "20 gb", "-1 B", "9999999999 TB"}) {
    EXPECT_FALSE(parse_bytes(text).has_value()) << text;
  }
  EXPECT_EQ(print_bytes(1.234e10), "12.3 GB");
  EXPECT_EQ(print_bytes(999.0), "999 B");
  EXPECT_EQ(print_bytes(0.0), "0 B");
}

}  // namespace
}  // namespace imunoise::config
