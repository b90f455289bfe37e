// What is written comes back, in every format.

#include "recording/export/write_samples.h"

#include <gtest/gtest.h>

#include <bit>
#include <limits>
#include <random>

#include "tests/recording/files.h"

namespace imunoise::recording {
namespace {

class WriteSamples : public FileTest {
 protected:
  WriteSamples() {
    std::mt19937_64 random(11);
    for (std::size_t i = 0; i < 70000; ++i) {  // more than one HDF5 chunk and one block of text
      x_.push_back(static_cast<double>(random()) * 1e-19 - 0.5);
      y_.push_back(
          std::bit_cast<double>((random() & ~(0x7ffULL << 52U)) | (random() % 0x7ff) << 52U));
    }
  }
  std::vector<OutputChannel> channels() const {
    return {{"gyro, \"x\"", x_, *parse_unit("deg/s")}, {"y [raw]", y_, *parse_unit("1")}};
  }
  std::string error(std::string_view name, const std::vector<OutputChannel>& channels,
                    const Metadata& metadata = {}, double rate = 100.0) const {
    const auto written = write_samples(path(name), channels, Hertz{rate}, metadata);
    return written ? "no error" : written.error().message;
  }

  std::vector<double> x_;
  std::vector<double> y_;
};

TEST_F(WriteSamples, ComesBackBitForBit) {
  for (const char* name : {"a.h5", "a.hdf5", "a.csv", "a.npy"}) {
    for (int time = 0; time < 2; ++time) {  // the second time an older file is replaced
      ASSERT_EQ(error(name, channels(), {{"sensor", "none\nat all"}, {"seed", "7"}}, 819.2),
                "no error");
    }
    const auto got = import_one(path(name));
    ASSERT_TRUE(got) << got.error().message;
    EXPECT_EQ(got->front().rate.value, 819.2);
    ASSERT_EQ(got->front().channels.size(), 2U);
    const Channel& x = got->front().channels[0];
    EXPECT_EQ(x.name, "gyro, \"x\"");
    EXPECT_EQ(x.unit.symbol, "deg/s");
    EXPECT_EQ(got->front().channels[1].name, "y [raw]");
    EXPECT_EQ(got->front().channels[1].unit.quantity, Quantity::kUnknown);
    for (const auto& [channel, values] :
         {std::pair(x, x_), std::pair(got->front().channels[1], y_)}) {
      const std::vector<double> back = stored_doubles(channel);
      ASSERT_EQ(back.size(), values.size()) << name;
      EXPECT_EQ(std::memcmp(back.data(), values.data(), 8 * back.size()), 0) << name;
    }
  }
  std::size_t files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(path("a.h5").parent_path())) {
    EXPECT_EQ(entry.path().string().find(".part"), std::string::npos) << entry.path();
    ++files;
  }
  EXPECT_EQ(files, 5U);  // four and a sidecar
}

TEST_F(WriteSamples, WhatCannotBeWritten) {
  const Unit none = *parse_unit("1");
  expect_parts(error("a.xls", channels()), {"a.xls", "'.xls'", ".h5, .csv and .npy"});
  expect_parts(error("a.csv", {}), {"nothing to write"});
  expect_parts(error("a.csv", {{"x", x_, none}, {"x", y_, none}}), {"'x'", "not used twice"});
  expect_parts(error("a.csv", {{"", x_, none}}), {"cannot name a channel"});
  expect_parts(error("a.csv", {{"a\nb", x_, none}}), {"control characters"});
  expect_parts(error("a.csv", {{"a/b", x_, none}}), {"cannot name a channel"});
  expect_parts(error("a.csv", {{"x", x_, none}, {"y", std::span(y_).first(5), none}}),
               {"channel y has 5 samples"});
  std::vector<double> bad = x_;
  bad[9] = std::numeric_limits<double>::infinity();
  expect_parts(error("a.csv", {{"x", bad, none}}), {"channel x: sample 9 is not finite"});
  expect_parts(error("a.csv", channels(), {{"rate_hz", "5"}}), {"'rate_hz'"});
  expect_parts(error("a.csv", channels(), {}, 0.0), {"not a sampling rate"});
  for (const char* name : {"none/a.csv", "none/a.h5", "none/a.npy"}) {
    expect_parts(error(name, channels()), {name, "check the folder"});
  }
  EXPECT_TRUE(std::filesystem::is_empty(path("x").parent_path()));
}

}  // namespace
}  // namespace imunoise::recording
