// Captures of other programs: no handshake before them, other messages between, rubbish.

#include <fmt/format.h>

#include "drivers/xsens/codec/items.h"
#include "drivers/xsens/codec/messages.h"
#include "drivers/xsens/codec/number.h"
#include "tests/drivers/replay/wire/capture.h"

namespace imunoise::testing {
namespace {

using drivers::XsensItem;
using drivers::XsensMessage;

// A message of MTData2 with counter, time (50 Hz) and, every second time, a rate.
std::vector<std::uint8_t> message(std::uint16_t index) {
  std::vector<std::uint8_t> payload;
  const auto item = [&](XsensItem kind, std::size_t bytes) {
    drivers::append_big_endian(payload, static_cast<std::uint16_t>(kind));
    payload.push_back(static_cast<std::uint8_t>(bytes));
  };
  item(XsensItem::kPacketCounter, 2);
  drivers::append_big_endian(payload, index);
  item(XsensItem::kSampleTimeFine, 4);
  drivers::append_big_endian(payload, static_cast<std::uint32_t>(index * 200));
  item(XsensItem::kAcceleration, 12);
  for (int axis = 0; axis < 3; ++axis)
    drivers::append_big_endian(payload, std::uint32_t{0x3f800000});
  if (index % 2 == 0) {
    item(XsensItem::kRateOfTurn, 12);
    for (int axis = 0; axis < 3; ++axis) {
      drivers::append_big_endian(payload, std::uint32_t{0x40000000});
    }
  }
  return drivers::encode_message(XsensMessage::kMtData2, payload);
}

std::string dump(std::uint16_t messages) {
  std::string out = "rubbish\xfa";
  for (std::uint16_t i = 0; i < messages; ++i) {
    const auto bytes = message(i);
    out.append(bytes.begin(), bytes.end());
  }
  return out;
}

TEST_F(Capture, AnXbusDumpWithoutItsBeginningTellsItsOutputs) {
  write(dump(400));
  const auto session = replay({}, "xbus");
  ASSERT_NE(session, nullptr);
  ASSERT_EQ(session->info().streams.size(), 2U);
  EXPECT_EQ(session->info().streams[0].nominal_rate_hz, 50.0);
  EXPECT_EQ(session->info().streams[0].channels[0].name, "acc_x");
  EXPECT_EQ(session->info().streams[1].nominal_rate_hz, 25.0);
  ASSERT_TRUE(session->read_rows(400));
  ASSERT_TRUE(session->read_rows(200, 1));
  EXPECT_EQ(session->rows()[3].numbers, (std::vector<double>{1.0, 1.0, 1.0}));
  EXPECT_EQ(session->rows(1)[3].numbers, (std::vector<double>{2.0, 2.0, 2.0}));
  EXPECT_EQ(session->rows()[50].host_time_ns - session->rows()[0].host_time_ns, 1'000'000'000);
}

// What looks like the beginning of a long frame hides no frame behind it, even where the capture
// ends.
TEST_F(Capture, AFalseBeginningNearTheEndHidesNoFrame) {
  const auto last = message(20);
  write(dump(20) + std::string("\xfa\xff\x36\xff\x07\x00", 6) +
        std::string(last.begin(), last.end()));
  const auto session = replay({{"rate", "50"}}, "xbus");
  ASSERT_NE(session, nullptr);
  ASSERT_TRUE(session->read_rows(21)) << session->failure();
  EXPECT_EQ(session->rows()[20].counter, 20U);
}

// Six numbers in all, but not where they belong: acceleration in float32, rate in fixed point.
TEST_F(Capture, AnMtiMessageWithNumbersInTheWrongItemIsRefused) {
  const auto mixed = [](std::uint16_t index, std::size_t accelerations, std::size_t rates) {
    std::vector<std::uint8_t> payload;
    const auto item = [&](std::uint16_t id, std::size_t bytes) {
      drivers::append_big_endian(payload, id);
      payload.push_back(static_cast<std::uint8_t>(bytes));
      payload.resize(payload.size() + bytes);
    };
    item(static_cast<std::uint16_t>(XsensItem::kPacketCounter), 2);
    payload.back() = static_cast<std::uint8_t>(index);
    item(static_cast<std::uint16_t>(XsensItem::kSampleTimeFine), 4);
    payload.back() = static_cast<std::uint8_t>(index);
    item(drivers::id_of(XsensItem::kAcceleration, drivers::XsensFormat::kFloat32),
         4 * accelerations);
    item(drivers::id_of(XsensItem::kRateOfTurn, drivers::XsensFormat::kFixed12_20), 4 * rates);
    const auto bytes = drivers::encode_message(XsensMessage::kMtData2, payload);
    return std::string(bytes.begin(), bytes.end());
  };
  write(mixed(0, 3, 3) + mixed(1, 4, 2) + mixed(2, 2, 4) + mixed(3, 3, 3));
  const auto session = replay({{"rate", "100"}}, "xbus");
  ASSERT_NE(session, nullptr);
  ASSERT_TRUE(session->read_rows(2)) << session->failure();
  EXPECT_EQ(session->rows()[1].counter, 3U);
  EXPECT_EQ(session->refused(IMUNOISE_REFUSED_MALFORMED), 2U);
}

TEST_F(Capture, CandumpLinesOfOthersArePassedOver) {
  std::string log = "what is this\n(1700000000.000000) can0 7FF#00\n";
  for (int i = 0; i < 100; ++i) {
    log += fmt::format("({:.6f}) can0 034#{:04X}00000000\r\n", 1.7e9 + 0.01 * i, i);
  }
  write(log);
  const auto session = replay({{"preset", "mti600"}}, "candump");
  ASSERT_NE(session, nullptr);
  ASSERT_EQ(session->info().streams.size(), 1U);
  EXPECT_EQ(session->info().streams[0].name, "Acceleration");
  EXPECT_EQ(session->info().streams[0].nominal_rate_hz, 100.0);
  ASSERT_TRUE(session->read_rows(100));
  EXPECT_EQ(session->rows()[77].numbers[0], 77.0);
}

TEST_F(Capture, ACandumpMessageThatComesOnceIsNamed) {
  std::string log = "(1700000000.000000) can0 032#000000000000\n";
  for (int i = 0; i < 100; ++i)
    log += fmt::format("({:.6f}) can0 034#{:04X}00000000\n", 1.7e9 + 0.01 * i, i);
  write(log);
  const auto session = replay({{"preset", "mti600"}}, "candump");
  ASSERT_NE(session, nullptr);
  EXPECT_EQ(session->info().streams.size(), 1U);
  EXPECT_NE(session->notes().find("RateOfTurn comes once"), std::string::npos) << session->notes();
}

TEST_F(Capture, BurstsEndWithTheLastWholeOne) {
  write(std::string(26 * 5 + 13, '\0'));  // nothing in them is new
  const auto session = replay({}, "adis16405");
  ASSERT_NE(session, nullptr);
  drivers::SampleBlock block = session->device().make_block(10);
  std::uint64_t refused = 0;
  for (;;) {
    const auto outcome = session->device().read(std::chrono::milliseconds(100), block);
    ASSERT_TRUE(outcome) << outcome.error().message;
    if (*outcome == drivers::ReadOutcome::kEnd) break;
    if (block.stream_index() == 0) refused += block.refused(IMUNOISE_REFUSED_STALE, 0);
  }
  EXPECT_EQ(refused, 5U);
}

TEST_F(Capture, SaysWhatItCannotReplay) {
  expect_refused({}, "xbus", "cannot be read; check the path");
  write("nothing of the kind");
  expect_refused({}, "xbus", "no Xbus frame of MTData2");
  expect_refused({}, "candump", "choose one of preset=NAME and dbc=FILE");
  expect_refused({{"preset", "mti600"}}, "candump",
                 "no line of candump -L with a message of mti600");
  expect_refused({{"rate", "700"}}, "adis16405", "cannot sample at 700 Hz");
  const auto legacy = drivers::encode_message(XsensMessage::kMtData, std::vector<std::uint8_t>(20));
  write(std::string(legacy.begin(), legacy.end()));
  expect_refused({}, "xbus", "Configuration message before legacy");
}

}  // namespace
}  // namespace imunoise::testing
