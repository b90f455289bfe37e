#include "core/support/json_text.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace imunoise {
namespace {

// Another program reads back every character that needs an escape, and those that need none.
TEST(JsonText, IsReadBackByAnotherLibrary) {
  std::string text = "gyro \"x\" \\ µrad/s ";
  for (char c = 0; c < 0x20; ++c) text += c;
  text += '\x7f';
  EXPECT_EQ(nlohmann::json::parse(json_string(text)), text);
  EXPECT_EQ(json_string("\x1f\n"), "\"\\u001f\\u000a\"");
}

TEST(JsonText, ObjectsAndArraysAreJson) {
  JsonObject object;
  object.add_text("a \"b\"", "c\\d\n\x01").add("list", json_array({"1", json_string("x")}));
  const auto read = nlohmann::json::parse(object.text());
  EXPECT_EQ(read["a \"b\""], "c\\d\n\x01");
  EXPECT_EQ(read["list"], nlohmann::json::parse(R"([1, "x"])"));
}

TEST(JsonText, KeepsTheOrderOfMembers) {
  JsonObject object;
  EXPECT_EQ(object.text(), "{}");
  object.add_text("b \"1\"", "x\ty").add("a", json_array({"1", json_string("s"), json_array({})}));
  EXPECT_EQ(object.text(), "{\"b \\\"1\\\"\":\"x\\u0009y\",\"a\":[1,\"s\",[]]}");
}

}  // namespace
}  // namespace imunoise
