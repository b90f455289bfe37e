#include "drivers/can/codec/dbc.h"

#include <gtest/gtest.h>

#include <array>

namespace imunoise::drivers {
namespace {

constexpr std::string_view kFile = R"dbc(VERSION "1.0"

NS_ :
	NS_DESC_
	CM_
	BA_DEF_

BS_:

BU_: IMU HOST
	GATEWAY

VAL_TABLE_ Modes 1 "on; really" 0 "off" ;

BO_ 291 Mixed: 8 IMU
 SG_ Mode M : 0|2@1+ (1,0) [0|3] "" HOST,GATEWAY
 SG_ A m0 : 8|12@1- (0.25,-1.5e1) [-512|511.75] "deg/s" HOST
 SG_ B m1 : 8|12@1+ (.5,+10) [10|2057.5] "m/s2"  Vector__XXX
 SG_ F : 32|32@1- (1,0) [0|0] "" HOST
BO_ 2147483648 Extended: 2 IMU
 SG_ Big : 7|16@0- (1,0) [0|0] "" HOST
BO_ 3221225472 VECTOR__INDEPENDENT_SIG_MSG: 0 Vector__XXX
 SG_ Orphan : 0|8@1+ (1,0) [0|0] "" Vector__XXX

CM_ SG_ 291 A "a comment with ; and a \" quote
over two lines";
BA_DEF_ BO_ "GenMsgCycleTime" INT 0 65535;
BA_ "GenMsgCycleTime" BO_ 291 10;
VAL_ 291 Mode 0 "a" 1 "b" ;
SIG_VALTYPE_ 291 F : 1;
)dbc";

TEST(Dbc, ReadsMessagesAndSignals) {
  const auto database = parse_dbc(kFile, "x.dbc");
  ASSERT_TRUE(database) << database.error().message;
  ASSERT_EQ(database->messages().size(), 2U);
  const CanMessage& mixed = database->messages()[0];
  EXPECT_EQ(mixed.name, "Mixed");
  EXPECT_EQ(mixed.id, 291U);
  EXPECT_FALSE(mixed.extended);
  ASSERT_EQ(mixed.signals.size(), 4U);
  EXPECT_TRUE(mixed.signals[0].multiplexor);
  EXPECT_EQ(mixed.signals[1].factor, 0.25);
  EXPECT_EQ(mixed.signals[1].offset, -15.0);
  EXPECT_EQ(mixed.signals[1].type, SignalType::kSigned);
  EXPECT_EQ(mixed.signals[1].unit, "deg/s");
  EXPECT_EQ(mixed.signals[1].switched_by, 0U);
  EXPECT_EQ(mixed.signals[2].factor, 0.5);
  EXPECT_EQ(mixed.signals[2].offset, 10.0);
  EXPECT_EQ(mixed.signals[3].type, SignalType::kFloat32);
  EXPECT_NE(database->find(0, true), nullptr);
  EXPECT_EQ(database->find(0, false), nullptr);
  EXPECT_EQ(database->find("Extended")->signals[0].field.order, ByteOrder::kBig);
}

TEST(Dbc, MultiplexedSignalsAreThereWhenSwitchedOn) {
  const auto database = parse_dbc(kFile, "x.dbc");
  ASSERT_TRUE(database);
  const CanMessage& mixed = database->messages()[0];
  const auto names = [&](double mode) {
    const std::array values = {std::pair<std::string_view, double>{"Mode", mode}};
    const auto frame = encode_signals(mixed, values);
    std::vector<SignalValue> signals;
    Refusals refused;
    decode_signals(mixed, frame->data(), signals, refused);
    std::string out;
    for (const SignalValue& value : signals) out += value.signal->name + " ";
    return out;
  };
  EXPECT_EQ(names(0), "Mode A F ");
  EXPECT_EQ(names(1), "Mode B F ");
  EXPECT_EQ(names(2), "Mode F ");
}

TEST(Dbc, MultiplexorsMayBeSwitchedThemselves) {
  const auto database = parse_dbc(R"dbc(BO_ 1 Deep: 8 IMU
 SG_ Outer M : 0|8@1+ (1,0) [0|0] "" HOST
 SG_ Inner m3M : 8|8@1+ (1,0) [0|0] "" HOST
 SG_ Leaf m0 : 16|8@1+ (1,0) [0|0] "" HOST
SG_MUL_VAL_ 1 Inner Outer 3-3;
SG_MUL_VAL_ 1 Leaf Inner 5-6, 9-9;
)dbc",
                                  "deep.dbc");
  ASSERT_TRUE(database) << database.error().message;
  const auto count = [&](std::uint8_t outer, std::uint8_t inner) {
    std::vector<SignalValue> signals;
    Refusals refused;
    const std::array<std::uint8_t, 8> data = {outer, inner};
    decode_signals(database->messages()[0], data, signals, refused);
    return signals.size();
  };
  EXPECT_EQ(count(0, 5), 1U);  // Outer alone
  EXPECT_EQ(count(3, 4), 2U);
  EXPECT_EQ(count(3, 5), 3U);
  EXPECT_EQ(count(3, 6), 3U);
  EXPECT_EQ(count(3, 9), 3U);
}

TEST(Dbc, SignalsBeyondAShortFrameAreRefused) {
  const auto database = parse_dbc(kFile, "x.dbc");
  ASSERT_TRUE(database);
  std::vector<SignalValue> signals;
  Refusals refused;
  const std::array<std::uint8_t, 3> data = {0, 1, 2};
  decode_signals(database->messages()[0], data, signals, refused);
  EXPECT_EQ(signals.size(), 2U);
  EXPECT_EQ(refused.count(Refusal::kLength), 1U);
}

TEST(Dbc, EncodingSaysWhatDoesNotFit) {
  const auto database = parse_dbc(kFile, "x.dbc");
  ASSERT_TRUE(database);
  const auto error = [&](std::string_view name, double value) {
    const std::array values = {std::pair(name, value)};
    return encode_signals(database->messages()[0], values).error().message;
  };
  EXPECT_NE(error("Mode", 4).find("Mode"), std::string::npos);
  EXPECT_NE(error("Missing", 0).find("Missing"), std::string::npos);
}

TEST(Dbc, UnitsInLatin1BecomeUtf8) {
  const auto database = parse_dbc(
      "BO_ 1 M: 8 I\n SG_ S : 0|8@1+ (1,0) [0|0] \"\xb0/s\" H\n"
      " SG_ T : 8|8@1+ (1,0) [0|0] \"\xc2\xb0/s\" H\n",
      "x.dbc");
  ASSERT_TRUE(database);
  EXPECT_EQ(database->messages()[0].signals[0].unit, "\xc2\xb0/s");
  EXPECT_EQ(database->messages()[0].signals[1].unit, "\xc2\xb0/s");
}

TEST(Dbc, ErrorsPointAtLineAndColumn) {
  struct Case {
    const char* text;
    const char* place;
    const char* words;
  };
  const std::vector<Case> cases = {
      {"BO_ x M: 8 I", "f.dbc:1:5:", "expected identifier"},
      {"BO_ 1 M 8 I", "f.dbc:1:9:", "expected ':'"},
      {"BO_ 1 M: 8", "f.dbc:1:11:", "end of the file"},
      {"BO_ 4096 M: 8 I", "f.dbc:1:5:", "11 bits"},
      {"BO_ 1 M: 8 I\nBO_ 1 N: 8 I", "f.dbc:2:5:", "defined twice"},
      {"BO_ 1 M: 8 I\n SG_ S : 0|65@1+ (1,0) [0|0] \"\" H", "f.dbc:2:12:", "at most 64"},
      {"BO_ 1 M: 8 I\n SG_ S : 0|0@1+ (1,0) [0|0] \"\" H", "f.dbc:2:12:", "at least one bit"},
      {"BO_ 1 M: 8 I\n SG_ S : 60|8@1+ (1,0) [0|0] \"\" H", "f.dbc:2:6:", "needs 9 bytes"},
      {"BO_ 1 M: 8 I\n SG_ S : 0|8@2+ (1,0) [0|0] \"\" H", "f.dbc:2:14:", "byte order"},
      {"BO_ 1 M: 8 I\n SG_ S : 0|8@1 (1,0) [0|0] \"\" H", "f.dbc:2:16:", "'+' or '-'"},
      {"BO_ 1 M: 8 I\n SG_ S : 0|8@1+ (0,0) [0|0] \"\" H", "f.dbc:2:18:", "factor of 0"},
      {"BO_ 1 M: 8 I\n SG_ S : 0|8@1+ (1e999,0) [0|0] \"\" H", "f.dbc:2:18:", "not a number"},
      {"BO_ 1 M: 8 I\n SG_ S : 0|8@1+ (1,0) [0|0] \"deg", "f.dbc:2:29:", "closing quote"},
      {"BO_ 1 M: 8 I\n SG_ S x1 : 0|8@1+ (1,0) [0|0] \"\" H", "f.dbc:2:8:", "multiplexing mark"},
      {"BO_ 1 M: 8 I\n SG_ S m1 : 0|8@1+ (1,0) [0|0] \"\" H",
       "f.dbc:2:36:", "0 signals are marked M"},
      {"BO_ 1 M: 8 I\n SG_ S : 0|8@1+ (1,0) [0|0] \"\" H\n SG_ S : 8|8@1+ (1,0) [0|0] \"\" H",
       "f.dbc:3:6:", "two signals S"},
      {"SIG_VALTYPE_ 7 S : 1;", "f.dbc:1:14:", "identifier 7"},
      {"BO_ 1 M: 8 I\n SG_ S : 0|8@1+ (1,0) [0|0] \"\" H\nSIG_VALTYPE_ 1 S : 1;",
       "f.dbc:3:14:", "a float has 32"},
      {"BO_ 1 M: 8 I\n SG_ S M : 0|8@1+ (1,0) [0|0] \"\" H\nSG_MUL_VAL_ 1 S S 0-1;",
       "f.dbc:3:17:", "no other multiplexor"},
      {"BO_ 1 M: 8 I\n SG_ S M : 0|8@1+ (1,0) [0|0] \"\" H\n SG_ T M : 8|8@1+ (1,0) [0|0] \"\" H\n"
       "SG_MUL_VAL_ 1 S T 0-1;\nSG_MUL_VAL_ 1 T S 0-1;",
       "f.dbc:5:23:", "circle"},
      {"CM_ \"no end\"", "f.dbc:1:1:", "no closing ';'"},
      {"BOGUS 1", "f.dbc:1:1:", "unknown section 'BOGUS'"},
  };
  for (const Case& bad : cases) {
    const auto database = parse_dbc(bad.text, "f.dbc");
    ASSERT_FALSE(database) << bad.text;
    const std::string& message = database.error().message;
    EXPECT_EQ(message.rfind(bad.place, 0), 0U) << message << "\n" << bad.text;
    EXPECT_NE(message.find(bad.words), std::string::npos) << message << "\n" << bad.text;
  }
}

}  // namespace
}  // namespace imunoise::drivers
