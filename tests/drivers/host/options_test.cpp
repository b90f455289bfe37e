// What users write for options.

#include <gtest/gtest.h>

#include "drivers/host/option_values.h"

namespace imunoise::drivers {
namespace {

std::vector<Option> offered() {
  using enum OptionType;
  return {
      {.name = "port", .type = kText, .description = "The port", .required = true},
      {.name = "rate",
       .type = kNumber,
       .description = "Rate",
       .unit = "Hz",
       .by_default = "100",
       .minimum = 1.0,
       .maximum = 1000.0},
      {.name = "burst",
       .type = kInteger,
       .description = "Burst",
       .by_default = "8",
       .minimum = 1.0},
      {.name = "raw", .type = kFlag, .description = "Raw", .by_default = "false"},
      {.name = "mode", .type = kText, .description = "Mode", .choices = {"slow", "fast"}},
      {.name = "file", .type = kText, .description = "File", .repeated = true},
  };
}

std::string complaint(std::vector<OptionText> chosen) {
  if (chosen.empty() || chosen[0].name != "-") chosen.push_back({"port", "x"});
  if (chosen[0].name == "-") chosen.clear();
  const auto values = OptionValues::make(offered(), chosen);
  return values ? "" : values.error().message;
}

TEST(OptionValues, FillInDefaultsAndKeepOrder) {
  const std::vector<OptionText> chosen = {
      {"file", "b"}, {"rate", "2.5e2"}, {"port", "/dev/x"}, {"file", "a"}, {"raw", "true"}};
  auto made = OptionValues::make(offered(), chosen);
  ASSERT_TRUE(made) << made.error().message;
  const OptionValues values = std::move(*made);  // what it points to must not move
  ASSERT_EQ(values.size(), 6U);
  const auto& value = [&](std::size_t i) -> const imunoise_option_value& {
    return *values.data()[i];
  };
  EXPECT_STREQ(value(0).name, "port");
  EXPECT_STREQ(value(0).text, "/dev/x");
  EXPECT_EQ(value(1).type, std::uint32_t{IMUNOISE_OPTION_NUMBER});
  EXPECT_EQ(value(1).number, 250.0);
  EXPECT_STREQ(value(2).name, "burst");
  EXPECT_EQ(value(2).integer, 8);
  EXPECT_EQ(value(3).integer, 1);
  EXPECT_STREQ(value(4).name, "file");  // mode has no default: absent
  EXPECT_STREQ(value(4).text, "b");
  EXPECT_STREQ(value(5).text, "a");
}

TEST(OptionValues, RefuseWithTheWayOut) {
  EXPECT_EQ(complaint({{"speed", "1"}}),
            "no option speed; it has: port, rate, burst, raw, mode, file");
  EXPECT_EQ(complaint({{"prot", "1"}}),
            "no option prot; it has: port, rate, burst, raw, mode, file; did you mean 'port'?");
  EXPECT_EQ(complaint({{"-", ""}}), "option port is missing: The port; give port=...");
  EXPECT_EQ(complaint({{"rate", "10"}, {"rate", "20"}}),
            "option rate: given 2 times; give it once");
  EXPECT_EQ(complaint({{"rate", "quick"}}), "option rate: 'quick' is not a number");
  EXPECT_EQ(complaint({{"rate", "10 Hz"}}), "option rate: '10 Hz' is not a number");
  EXPECT_EQ(complaint({{"rate", "nan"}}), "option rate: 'nan' is not a number");
  EXPECT_EQ(complaint({{"rate", ""}}), "option rate: '' is not a number");
  EXPECT_EQ(complaint({{"rate", "0.5"}}),
            "option rate: 0.5 Hz is out of bounds; give from 1 to 1000 Hz");
  EXPECT_EQ(complaint({{"rate", "1"}}), "");
  EXPECT_EQ(complaint({{"rate", "1000"}}), "");
  EXPECT_EQ(complaint({{"burst", "2.5"}}), "option burst: '2.5' is not a whole number");
  EXPECT_EQ(complaint({{"burst", "99999999999999999999"}}),
            "option burst: '99999999999999999999' is not a whole number");
  EXPECT_EQ(complaint({{"burst", "0"}}), "option burst: 0 is out of bounds; give at least 1");
  EXPECT_EQ(complaint({{"raw", "yes"}}), "option raw: 'yes' is neither true nor false");
  EXPECT_EQ(complaint({{"mode", "medium"}}), "option mode: 'medium' is none of: slow, fast");
}

TEST(OptionValues, AreTextsThatADriverCanRead) {
  EXPECT_EQ(complaint({{"file", "caf\xe9"}}),
            "option file: 'caf\xEF\xBF\xBD' is not UTF-8; write it in UTF-8, or rename the file");
  EXPECT_EQ(complaint({{"file", std::string("a\0b", 3)}}),
            "option file: contains a NUL character; remove it");
  EXPECT_EQ(complaint({{"file", "café"}}), "");
}

TEST(OptionText, IsTakenApartAtTheFirstEqualsSign) {
  const auto option = parse_option("file=a=b.csv");
  ASSERT_TRUE(option);
  EXPECT_EQ(option->name, "file");
  EXPECT_EQ(option->value, "a=b.csv");
  EXPECT_TRUE(parse_option("unit=")->value.empty());
  EXPECT_EQ(parse_option("file").error().message, "'file' is not an option; write NAME=VALUE");
  EXPECT_FALSE(parse_option("=x"));
}

}  // namespace
}  // namespace imunoise::drivers
