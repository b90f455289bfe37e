#include "drivers/codec/wire_format.h"

#include <gtest/gtest.h>

namespace imunoise::drivers {
namespace {

TEST(WireFormats, AreFoundByTheirNames) {
  const std::vector<std::string> names = wire_format_names();
  ASSERT_EQ(names.size(), kWireFormats.size());
  for (std::size_t i = 0; i < names.size(); ++i) {
    EXPECT_EQ(find_wire_format(names[i]), kWireFormats[i]) << names[i];
  }
  EXPECT_EQ(names, (std::vector<std::string>{"xbus", "candump", "adis16405"}));
  EXPECT_FALSE(find_wire_format("mp3"));
  EXPECT_FALSE(find_wire_format(""));
}

}  // namespace
}  // namespace imunoise::drivers
