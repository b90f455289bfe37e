#include "drivers/can/codec/candump.h"

#include <gtest/gtest.h>

#include <random>

namespace imunoise::drivers {
namespace {

TEST(Candump, ReadsEveryKindOfFrame) {
  const auto standard = parse_candump_line("(1700000000.123456) can0 123#DEADbeef");
  ASSERT_TRUE(standard);
  EXPECT_EQ(standard->time_ns, 1'700'000'000'123'456'000);
  EXPECT_EQ(standard->interface, "can0");
  EXPECT_EQ(standard->frame.id, 0x123U);
  EXPECT_FALSE(standard->frame.extended);
  EXPECT_EQ(standard->frame.length, 4);
  EXPECT_EQ(standard->frame.bytes[3], 0xef);

  const auto extended = parse_candump_line("(0.5) vcan1 0CF02980#C7.AA T");
  ASSERT_TRUE(extended);
  EXPECT_EQ(extended->time_ns, 500'000'000);
  EXPECT_TRUE(extended->frame.extended);
  EXPECT_EQ(extended->frame.length, 2);
  EXPECT_EQ(extended->direction, CanDirection::kSent);

  const auto remote = parse_candump_line("(1.0) can0 7FF#R4 R");
  ASSERT_TRUE(remote);
  EXPECT_TRUE(remote->frame.remote);
  EXPECT_EQ(remote->frame.length, 4);
  EXPECT_TRUE(remote->frame.data().empty());
  EXPECT_EQ(remote->direction, CanDirection::kReceived);

  const auto fd = parse_candump_line("(1.0) can0 123##3000102030405060708090A0B");
  ASSERT_TRUE(fd);
  EXPECT_TRUE(fd->frame.fd);
  EXPECT_EQ(fd->frame.fd_flags, 3);
  EXPECT_EQ(fd->frame.length, 12);

  const auto error = parse_candump_line("(1.0) can0 20000080#0000000000000000");
  ASSERT_TRUE(error);
  EXPECT_TRUE(error->frame.error);
  EXPECT_EQ(error->frame.id, 0x80U);
  EXPECT_TRUE(parse_candump_line("(1.0) can0 123#"));
}

TEST(Candump, RefusesOtherLines) {
  for (const char* const line : {"",
                                 "(",
                                 "()",
                                 "(1.0)",
                                 "(1.0) can0",
                                 "(1.0) can0 ",
                                 "(1.0) can0 123",
                                 "(1.0) can0 #11",
                                 "(1) can0 123#11",
                                 "(a.0) can0 123#11",
                                 "(-1.0) can0 123#11",
                                 "(1.0000000000) can0 123#11",
                                 "(1.0) can0 12#11",
                                 "(1.0) can0 1234#11",
                                 "(1.0) can0 800#11",
                                 "(1.0) can0 80000000#11",
                                 "(1.0) can0 123#1",
                                 "(1.0) can0 123#1G",
                                 "(1.0) can0 123#.11",
                                 "(1.0) can0 123#112233445566778899",
                                 "(1.0) can0 123#R9",
                                 "(1.0) can0 123#Rx",
                                 "(1.0) can0 123##",
                                 "(1.0) can0 123##0112233445566778899",
                                 "(1.0) can0 20000080#R",
                                 "(1.0) can0 123#11 X",
                                 "(1.0)  123#11",
                                 "1.0 can0 123#11",
                                 "(1.0) a_name_too_long_ 123#11",
                                 "(1.0) can\xb0 123#11"}) {
    EXPECT_FALSE(parse_candump_line(line)) << line;
  }
}

TEST(Candump, FramesReturn) {
  constexpr std::uint64_t kSeed = 9;
  SCOPED_TRACE(kSeed);
  std::mt19937_64 random(kSeed);
  for (int round = 0; round < 5000; ++round) {
    CandumpLine line;
    line.time_ns = static_cast<std::int64_t>(random() % 4'000'000'000) * 1'000'000'000 +
                   static_cast<std::int64_t>(random() % 1'000'000) * 1000;
    line.interface = "can7";
    line.direction = static_cast<CanDirection>(random() % 3);
    CanFrame& frame = line.frame;
    const auto kind = random() % 4;
    frame.error = kind == 0;
    frame.remote = kind == 1;
    frame.fd = kind == 2;
    frame.extended = !frame.error && random() % 2 == 0;
    frame.id = static_cast<std::uint32_t>(random()) &
               (frame.extended || frame.error ? 0x1fffffffU : 0x7ffU);
    do {
      frame.length = static_cast<std::uint8_t>(random() % (frame.fd ? 65 : 9));
    } while (!is_fd_length(frame.length));
    if (frame.fd) frame.fd_flags = static_cast<std::uint8_t>(random() % 8);
    for (std::size_t i = 0; i < frame.length && !frame.remote; ++i) {
      frame.bytes[i] = static_cast<std::uint8_t>(random());
    }
    const std::string text = format_candump_line(line);
    const auto again = parse_candump_line(text);
    ASSERT_TRUE(again) << text;
    EXPECT_EQ(again->frame, frame) << text;
    EXPECT_EQ(again->time_ns, line.time_ns) << text;
    EXPECT_EQ(again->direction, line.direction) << text;
  }
}

}  // namespace
}  // namespace imunoise::drivers
