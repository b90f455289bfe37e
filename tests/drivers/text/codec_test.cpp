// Lines of text to rows of numbers.

#include <gtest/gtest.h>

#include "drivers/text/codec/arrival.h"
#include "drivers/text/codec/lines.h"
#include "drivers/text/codec/numbers.h"
#include "drivers/text/codec/row.h"

namespace imunoise::text {
namespace {

RowReader reader(const std::string& columns, const LineForm& form = {},
                 Separator separator = Separator::kComma) {
  return {*parse_columns(columns), separator, form};
}

TextRow row_of(RowReader& rows, std::string_view line) {
  const auto read = rows.read(line);
  if (const auto* const row = std::get_if<TextRow>(&read)) return *row;
  ADD_FAILURE() << line;
  return {};
}

NoRow no_row(RowReader& rows, std::string_view line) {
  const auto read = rows.read(line);
  if (const auto* const none = std::get_if<NoRow>(&read)) return *none;
  ADD_FAILURE() << line;
  return {};
}

TEST(TextColumns, HaveNamesUnitsAndRoles) {
  const auto columns = parse_columns("time[ms], counter ,gyro_x[deg/s],-,acc (m/s^2),temp");
  ASSERT_TRUE(columns) << columns.error().message;
  ASSERT_EQ(columns->size(), 6U);
  EXPECT_EQ((*columns)[0].nanoseconds, 1'000'000);
  EXPECT_EQ((*columns)[1].role, ColumnRole::kCounter);
  EXPECT_EQ((*columns)[2], (Column{ColumnRole::kValue, "gyro_x", "deg/s", 0}));
  EXPECT_EQ((*columns)[3].role, ColumnRole::kPassedOver);
  EXPECT_EQ((*columns)[4], (Column{ColumnRole::kValue, "acc", "m/s^2", 0}));
  EXPECT_EQ((*columns)[5].unit, "1");
  for (const char* const wrong :
       {"", "time[s]", "time,a", "time[h],a", "a,a", "a,,b", "a/b", "counter,counter,a", "[g]"})
    EXPECT_FALSE(parse_columns(std::string_view(wrong))) << wrong;
}

TEST(TextColumns, AreSeparatedByWhatTheLineHas) {
  using Fields = std::vector<std::string_view>;
  EXPECT_EQ(split("1, 2 ,3\r", separator_of("1, 2 ,3")), (Fields{"1", "2", "3"}));
  EXPECT_EQ(split("1;2,5;;", separator_of("1;2,5;;")), (Fields{"1", "2,5", "", ""}));
  EXPECT_EQ(split("  1 \t 2  3 ", separator_of("1 2")), (Fields{"1", "2", "3"}));
  EXPECT_TRUE(is_header({"time[s]", "x"}));
  EXPECT_FALSE(is_header({"x", "1"}));
  EXPECT_FALSE(is_header({"x", ""}));
}

TEST(TextNumbers, AreWholeFieldsWithOrWithoutALabel) {
  EXPECT_EQ(number_of("-1.5e3"), -1500.0);
  EXPECT_EQ(number_of("+2"), 2.0);
  EXPECT_EQ(number_of("ax=0.25"), 0.25);
  EXPECT_EQ(number_of("gx: -3"), -3.0);
  for (const char* const wrong : {"", "1x", "x", "12:30", "1 2", "--1", "0x"})
    EXPECT_FALSE(number_of(wrong)) << wrong;
}

TEST(TextNumbers, TimesAreExactToTheNanosecond) {
  constexpr std::int64_t kSecond = 1'000'000'000;
  EXPECT_EQ(time_of("1700000000.123456789", kSecond), 1'700'000'000'123'456'789);
  EXPECT_EQ(time_of("-0.5", kSecond), -500'000'000);
  EXPECT_EQ(time_of("12.25", 1'000'000), 12'250'000);
  EXPECT_EQ(time_of("7.9", 1), 7);
  EXPECT_EQ(time_of("1.7e9", kSecond), 1'700'000'000 * kSecond);
  for (const char* const wrong : {"", "x", "1.2.3", "99999999999", "1e99", "nan", "."})
    EXPECT_FALSE(time_of(wrong, kSecond)) << wrong;
}

TEST(TextRows, HoldValuesTimeAndCounter) {
  RowReader rows = reader("time[s],time[ns],counter,x,-,y");
  const TextRow row = row_of(rows, "12,500,7,1.5,anything,nan");
  EXPECT_EQ(row.time_ns, 12'000'000'500);
  EXPECT_EQ(row.counter, 7U);
  ASSERT_EQ(row.values.size(), 2U);
  EXPECT_EQ(row.values[0], 1.5);
  EXPECT_FALSE(row.values[1]);
  EXPECT_FALSE(row_of(rows, "12,500,7,,a,2").values[0]);
}

TEST(TextRows, WhatIsNoRowIsTold) {
  RowReader rows = reader("counter,x,y");
  for (const char* const passed : {"", "  ", "# 1,2,3", "%1,2,3", "counter,x,y", "ready"})
    EXPECT_EQ(no_row(rows, passed), NoRow::kPassedOver) << passed;
  for (const char* const bad : {"1,2", "1,2,3,4", "1,2,z", "-1,2,3", "1.5,2,3", "1,2,3 4"})
    EXPECT_EQ(no_row(rows, bad), NoRow::kMalformed) << bad;
}

TEST(TextRows, APrefixAndAChecksumFrameThem) {
  RowReader prefixed = reader("x,y", {.prefix = "IMU:"});
  EXPECT_EQ(row_of(prefixed, "IMU: 1, 2\r").values[1], 2.0);
  EXPECT_EQ(no_row(prefixed, "GPS: 1,2"), NoRow::kPassedOver);
  // The exclusive or of "I,1,2", by hand: 49 2c 31 2c 32 give 4a.
  RowReader nmea = reader("x,y", {.prefix = "$I,", .checksum = true});
  EXPECT_EQ(row_of(nmea, "$I,1,2*4A\r").values[0], 1.0);
  EXPECT_EQ(no_row(nmea, "$I,1,3*4A"), NoRow::kBadChecksum);
  EXPECT_EQ(no_row(nmea, "$I,1,2"), NoRow::kBadChecksum);
  EXPECT_EQ(no_row(nmea, "$I,1,2*"), NoRow::kBadChecksum);
}

TEST(TextRows, AClockOf32BitsGoesOn) {
  RowReader rows = reader("time[us],x", {.time_maximum = 4294967295.0});
  EXPECT_EQ(row_of(rows, "4294967290,0").time_ns, 4'294'967'290'000);
  EXPECT_EQ(row_of(rows, "4,0").time_ns, 4'294'967'300'000);
  EXPECT_EQ(no_row(rows, "4294967296,0"), NoRow::kMalformed);
  rows.restart();
  EXPECT_EQ(row_of(rows, "4,0").time_ns, 4'000);
}

TEST(TextLines, AreTheSameInPiecesOfAnySize) {
  const std::string text = "1,2\r\n\nlong " + std::string(100'000, 'x') + "\n3,4";
  const auto* const bytes = reinterpret_cast<const std::uint8_t*>(text.data());
  for (const std::size_t piece : {1U, 7U, 1000U, 200'000U}) {
    LineReader lines;
    std::vector<std::string> out;
    for (std::size_t at = 0; at < text.size(); at += piece)
      lines.push({bytes + at, std::min<std::size_t>(piece, text.size() - at)},
                 [&](std::string_view line) { out.emplace_back(line); });
    ASSERT_EQ(out.size(), 3U);
    EXPECT_EQ(out[0], "1,2\r");
    EXPECT_EQ(out[1], "");
    EXPECT_EQ(out[2].size(), LineReader::kLongestLine + 1);
    EXPECT_EQ(lines.rest(), "3,4");
  }
}

TEST(TextArrival, OfRowsThatCameTogetherOnlyTheLastCameNow) {
  std::vector<ArrivedRow> rows = {{{}, 50}, {{}, 100}, {{}, 100}, {{}, 100}};
  spread_in_time(rows, 10.0);
  EXPECT_EQ(rows[0].host_time_ns, 50);
  EXPECT_EQ(rows[1].host_time_ns, 80);
  EXPECT_EQ(rows[2].host_time_ns, 90);
  EXPECT_EQ(rows[3].host_time_ns, 100);
  std::vector<ArrivedRow> timed = {{{{}, 5, {}}, 100}, {{{}, 17, {}}, 100}, {{{}, 3, {}}, 100}};
  spread_in_time(timed, 10.0);
  EXPECT_EQ(timed[1].host_time_ns, 90);  // its clock began anew: the rate tells
  EXPECT_EQ(timed[0].host_time_ns, 78);
}

}  // namespace
}  // namespace imunoise::text
