#include "drivers/emulator/effects/call_text.h"

#include <gtest/gtest.h>

namespace imunoise::emulator {
namespace {

using Arguments = std::vector<std::pair<std::string, std::string>>;

TEST(CallText, ReadsNamesAndArguments) {
  const auto call = parse_call(" fan ( frequency = 23,amplitude=1e-3 , channel=gyro_x ) ");
  ASSERT_TRUE(call) << call.error().message;
  EXPECT_EQ(call->name, "fan");
  EXPECT_EQ(call->arguments,
            (Arguments{{"frequency", "23"}, {"amplitude", "1e-3"}, {"channel", "gyro_x"}}));
  EXPECT_EQ(parse_call("unplug")->name, "unplug");
  EXPECT_TRUE(parse_call("unplug()")->arguments.empty());
}

TEST(CallText, RefusesEverythingElse) {
  for (const char* const text : {"", "()", "a b(c=1)", "a(", "a(b)", "a(b=1,)", "a(,b=1)", "a(=1)",
                                 "a(b=1)c", "a(b=1,,c=2)", "a-b(c=1)"}) {
    const auto call = parse_call(text);
    ASSERT_FALSE(call) << text;
    EXPECT_NE(call.error().message.find("NAME(KEY=VALUE, ...)"), std::string::npos) << text;
  }
}

TEST(CallText, TakesNumbersInTheOrderOfTheParameters) {
  const std::vector<NumberParameter> parameters = {{"at", "s"}, {"size", "", 2.5, -1.0, 3.0}};
  EXPECT_EQ(*numbers_of(*parse_call("x(size=-1, at=3)"), parameters),
            (std::vector<double>{3.0, -1.0}));
  EXPECT_EQ(*numbers_of(*parse_call("x(at=3)"), parameters), (std::vector<double>{3.0, 2.5}));
  EXPECT_EQ(usage("x", parameters), "x(at s, size=2.5)");
  EXPECT_FALSE(numbers_of(*parse_call("x(at=3, size=3.1)"), parameters));
  EXPECT_FALSE(numbers_of(*parse_call("x(at=3s)"), parameters));
}

}  // namespace
}  // namespace imunoise::emulator
