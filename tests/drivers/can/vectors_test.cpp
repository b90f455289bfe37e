// Lines and signals decoded by others, from a database beside the project.

#include <gtest/gtest.h>

#include <fstream>
#include <set>

#include "drivers/can/codec/candump.h"
#include "drivers/can/codec/dbc.h"
#include "tests/drivers/wire.h"
#include "tests/support/golden.h"

namespace imunoise::drivers {
namespace {

using imunoise::testing::read_json;
using imunoise::testing::shared;
using nlohmann::json;

TEST(CanVectors, EveryLineDecodesToItsValuesAndBack) {
  IMUNOISE_NEEDS("vectors/imu.dbc");
  IMUNOISE_NEEDS("vectors/wire.json");
  std::ifstream file(shared("vectors/imu.dbc"));
  const std::string text(std::istreambuf_iterator<char>(file), {});
  const auto database = parse_dbc(text, "imu.dbc");
  ASSERT_TRUE(database) << database.error().message;
  const json entries = read_json("vectors/wire.json")["can"];
  ASSERT_GE(entries.size(), 23U);
  std::size_t compared = 0;
  for (const json& entry : entries) {
    const std::string line = entry["line"];
    SCOPED_TRACE(line);
    const auto seen = parse_candump_line(line);
    ASSERT_TRUE(seen);
    EXPECT_EQ(format_candump_line(*seen), line);
    EXPECT_EQ(seen->frame.id, entry["id"]);
    EXPECT_EQ(seen->frame.extended, entry["extended"]);
    const auto data = testing::from_hex(entry["data"].get<std::string>());
    EXPECT_TRUE(
        std::equal(data.begin(), data.end(), seen->frame.data().begin(), seen->frame.data().end()));

    const CanMessage* const message = database->find(seen->frame.id, seen->frame.extended);
    ASSERT_NE(message, nullptr);
    EXPECT_EQ(message->name, entry["message"]);
    std::vector<SignalValue> signals;
    Refusals refused;
    decode_signals(*message, seen->frame.data(), signals, refused);
    EXPECT_TRUE(refused.none());
    EXPECT_EQ(signals.size(), entry["decoded"].size());
    std::vector<std::pair<std::string_view, double>> values;
    for (const SignalValue& value : signals) {
      ASSERT_TRUE(entry["decoded"].contains(value.signal->name)) << value.signal->name;
      EXPECT_NEAR(value.physical, entry["decoded"][value.signal->name].get<double>(), 5.1e-10)
          << value.signal->name;  // printed with nine decimals
      values.emplace_back(value.signal->name, value.physical);
      ++compared;
    }
    // Encoding gives the same bits back, wherever a signal lies.
    const auto frame = encode_signals(*message, values);
    ASSERT_TRUE(frame);
    for (const SignalValue& value : signals) {
      EXPECT_EQ(extract_bits(frame->data(), value.signal->field), value.bits);
    }
  }
  EXPECT_GT(compared, 45U);
}

}  // namespace
}  // namespace imunoise::drivers
