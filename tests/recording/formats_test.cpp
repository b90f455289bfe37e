// NumPy and raw files with their sidecars.

#include <gtest/gtest.h>

#include <limits>
#include <numeric>

#include "recording/import/binary/npy.h"
#include "tests/recording/files.h"

namespace imunoise::recording {
namespace {

class Binary : public FileTest {};

template <class Number>
std::vector<Number> counted(std::size_t size) {
  std::vector<Number> out(size);
  std::iota(out.begin(), out.end(), Number{0});
  return out;
}

std::string dictionary(const std::string& dtype, const std::string& shape, bool fortran = false) {
  return "{'descr': '" + dtype + "', 'fortran_order': " + (fortran ? "True" : "False") +
         ", 'shape': (" + shape + "), }";
}

TEST_F(Binary, NpyOfEveryVersionTypeAndOrder) {
  for (const int major : {1, 2, 3}) {
    const auto got = import_one(
        write("a.npy", npy(dictionary("<f8", "20,"), bytes_of(counted<double>(20)), major)),
        at_rate(5));
    ASSERT_TRUE(got) << got.error().message;
    EXPECT_EQ(stored_doubles(got->front().channels[0]), counted<double>(20)) << major;
    EXPECT_EQ(got->front().channels[0].name, "col1");
  }
  const auto rows = import_one(
      write("a.npy", npy(dictionary("<i2", "20, 3"), bytes_of(counted<std::int16_t>(60)))),
      at_rate(5));
  ASSERT_TRUE(rows) << rows.error().message;
  ASSERT_EQ(rows->front().channels.size(), 3U);
  EXPECT_EQ(std::get<std::vector<std::int16_t>>(*rows->front().channels[1].samples)[4], 13);
  ImportOptions options = at_rate(5);
  options.channels = {"col3", "col2"};
  const auto some = import_one(path("a.npy"), options);
  ASSERT_TRUE(some) << some.error().message;
  EXPECT_EQ(std::get<std::vector<std::int16_t>>(*some->front().channels[0].samples)[4], 14);
  const auto columns = import_one(
      write("a.npy", npy(dictionary("<i4", "20, 3", true), bytes_of(counted<std::int32_t>(60)))),
      options);
  ASSERT_TRUE(columns) << columns.error().message;
  ASSERT_EQ(columns->front().channels.size(), 2U);
  EXPECT_EQ(std::get<std::vector<std::int32_t>>(*columns->front().channels[0].samples)[4], 44);
  EXPECT_EQ(std::get<std::vector<std::int32_t>>(*columns->front().channels[1].samples)[19], 39);
  const auto floats = import_one(
      write("a.npy", npy(dictionary("<f4", "20,"), bytes_of(std::vector<float>(20, 0.1F)))),
      at_rate(5));
  ASSERT_TRUE(floats) << floats.error().message;
  EXPECT_EQ(stored_doubles(floats->front().channels[0])[19], static_cast<double>(0.1F));
}

// More rows than one block of the reader holds.
TEST_F(Binary, LongArraysComeInBlocks) {
  const auto numbers = counted<std::int32_t>(600000);
  for (const bool fortran : {false, true}) {
    const auto got =
        import_one(write("a.npy", npy(dictionary("<i4", "300000, 2", fortran), bytes_of(numbers))),
                   at_rate(5));
    ASSERT_TRUE(got) << got.error().message;
    for (std::size_t c = 0; c < 2; ++c) {
      const auto& values = std::get<std::vector<std::int32_t>>(*got->front().channels[c].samples);
      ASSERT_EQ(values.size(), 300000U);
      for (std::size_t r = 0; r < values.size(); ++r) {
        ASSERT_EQ(values[r], numbers[fortran ? c * 300000 + r : 2 * r + c]) << fortran << c << r;
      }
    }
  }
}

TEST_F(Binary, SidecarGivesRateNamesUnitsAndScale) {
  write("a.i16.json",
        R"({"rate_hz": 250, "channels": [{"name": "gyro_x", "units": "deg/s", "scale_factor": 0.05},
            {"name": "temp", "units": "degC", "scale_factor": 0.5, "add_offset": 25}]})");
  const auto got = import_one(write("a.i16", bytes_of(counted<std::int16_t>(40))));
  ASSERT_TRUE(got) << got.error().message;
  EXPECT_EQ(got->front().rate.value, 250.0);
  const Channel& gyro = got->front().channels[0];
  EXPECT_EQ(gyro.name, "gyro_x");
  EXPECT_DOUBLE_EQ(gyro.signal().value(3), 6 * 0.05 * 0.017453292519943295);
  EXPECT_DOUBLE_EQ(got->front().channels[1].signal().value(1), 3 * 0.5 + 25 + 273.15);
  EXPECT_TRUE(std::holds_alternative<std::vector<std::int16_t>>(*gyro.samples));
}

TEST_F(Binary, SidecarOfANumpyFile) {
  write("a.npy.json",
        R"({"rate_hz": 8, "dtype": "<f8", "channels": [{"name": "x", "units": "g"}]})");
  const auto got =
      import_one(write("a.npy", npy(dictionary("<f8", "20,"), bytes_of(counted<double>(20)))));
  ASSERT_TRUE(got) << got.error().message;
  EXPECT_EQ(got->front().channels[0].name, "x");
  EXPECT_DOUBLE_EQ(got->front().channels[0].signal().value(2), 2 * 9.80665);
  write("a.npy.json", R"({"rate_hz": 8, "dtype": "<f4"})");
  expect_parts(error_of(path("a.npy")), {"a.npy", "<f8", "a.npy.json says <f4"});
}

TEST_F(Binary, EveryRawExtensionAndBin) {
  const std::string sidecar = R"({"rate_hz": 8, "channels": [{"name": "x"}]})";
  const std::vector<std::pair<std::string, std::string>> files = {
      {"a.f64", bytes_of(counted<double>(20))},
      {"a.f32", bytes_of(counted<float>(20))},
      {"a.i16", bytes_of(counted<std::int16_t>(20))},
      {"a.i32", bytes_of(counted<std::int32_t>(20))}};
  for (const auto& [name, bytes] : files) {
    write(name + ".json", sidecar);
    const auto got = import_one(write(name, bytes));
    ASSERT_TRUE(got) << got.error().message;
    EXPECT_EQ(got->front().channels[0].signal().value(19), 19.0) << name;
  }
  write("a.bin.json", R"({"rate_hz": 8, "dtype": "<i4", "channels": [{"name": "x"}]})");
  const auto got = import_one(write("a.bin", bytes_of(counted<std::int32_t>(20))));
  ASSERT_TRUE(got) << got.error().message;
  EXPECT_EQ(got->front().channels[0].signal().value(19), 19.0);
}

TEST_F(Binary, DamagedNpyIsRefused) {
  const std::string good = npy(dictionary("<f8", "20,"), bytes_of(counted<double>(20)));
  const auto message = [&](const std::string& bytes) {
    return error_of(write("a.npy", bytes), at_rate(1));
  };
  EXPECT_EQ(message(good), "no error");
  for (const std::size_t length : {6U, 8U, 11U, 30U}) {
    expect_parts(message(good.substr(0, length)), {"a.npy", "ends within its .npy header"});
  }
  expect_parts(message(good.substr(0, good.size() - 1)),
               {"20 x 1 numbers", "159 bytes follow", "truncated"});
  expect_parts(message(good + "x"), {"161 bytes follow"});
  expect_parts(message(npy(dictionary("<f8", "18446744073709551615, 8"), "12345678")),
               {"truncated"});
  expect_parts(message(npy(dictionary("<f8", "4611686018427387904, 4"), "")), {"truncated"});
  expect_parts(message(npy(std::string(100'000, ' ') + dictionary("<f8", "0,"), "", 2)),
               {"a .npy header of 1000", "at most 65536", "numpy.save"});
  expect_parts(message(npy(dictionary("<f8", "0,"), "")), {"no samples"});
  expect_parts(message(npy(dictionary(">f8", "20,"), bytes_of(counted<double>(20)))),
               {"'>f8'", "astype('<f8')"});
  expect_parts(message(npy(dictionary("<f8", "5, 2, 2"), bytes_of(counted<double>(20)))),
               {"3 dimensions", "(samples, channels)"});
  expect_parts(
      message(npy("{'descr': [('a', '<f8')], 'fortran_order': False, 'shape': (1,)}", "12345678")),
      {"named fields"});
  expect_parts(
      message(npy(dictionary("<i2", "400, 5000"), bytes_of(counted<std::int16_t>(2'000'000)))),
      {"5000 columns", "transposed"});
  for (const char* text : {"", "{", "{}", "{'descr': '<f8'}", "{'descr': <f8, 'shape': (1,)}",
                           "{'descr': '<f8', 'fortran_order': False, 'shape': (-1,), }",
                           "{'descr': '<f8', 'fortran_order': False, 'shape': (1,), 'x': 1}"}) {
    expect_parts(message(npy(text, "12345678")), {"a.npy", ".npy header cannot be read"});
  }
  std::string version = good;
  version[6] = 9;
  expect_parts(message(version), {".npy version 9"});
  expect_parts(error_of(write("a.npy", good)), {"no sampling rate", "--rate", "a.npy.json"});
}

TEST_F(Binary, NumbersThatAreNone) {
  std::vector<double> numbers = counted<double>(40);
  numbers[13] = std::numeric_limits<double>::quiet_NaN();
  expect_parts(
      error_of(write("a.npy", npy(dictionary("<f8", "20, 2"), bytes_of(numbers))), at_rate(1)),
      {"a.npy: 13 samples", "col2 misses 1 value", "sample 6"});
  std::vector<float> floats(20, 1.0F);
  floats[19] = std::numeric_limits<float>::infinity();
  ImportOptions strict = at_rate(1);
  strict.strict = true;
  expect_parts(error_of(write("a.npy", npy(dictionary("<f4", "20,"), bytes_of(floats))), strict),
               {"sample 19", "col1"});
}

TEST_F(Binary, RawFilesThatTheirSidecarDoesNotFit) {
  const auto message = [&](const std::string& name, const std::string& sidecar, std::size_t bytes) {
    write(name + ".json", sidecar);
    return error_of(write(name, std::string(bytes, '\1')));
  };
  expect_parts(error_of(write("b.f64", "12345678")),
               {"b.f64", "need a sidecar", "b.f64.json", "rate_hz"});
  const std::string two = R"({"rate_hz": 1, "channels": [{"name": "x"}, {"name": "y"}]})";
  expect_parts(message("a.i16", two, 81), {"a.i16", "81 bytes", "rows of 4 bytes", "truncated"});
  expect_parts(message("a.i16", two, 0), {"a.i16", "empty"});
  expect_parts(message("a.bin", two, 80), {"dtype ''", "<f8"});
  expect_parts(
      message("a.f64", R"({"rate_hz": 1, "dtype": "<f4", "channels": [{"name": "x"}]})", 80),
      {"extension says <f8", "says <f4"});
  expect_parts(message("a.f64", R"({"rate_hz": 1})", 80), {"names no channels"});
  expect_parts(message("a.f64", R"({"channels": [{"name": "x"}]})", 160), {"no sampling rate"});
  expect_parts(message("a.f64", R"({"rate": 1})", 80),
               {"a.f64.json", "rate", "a sidecar reads like"});
  expect_parts(message("a.f64", "{", 80), {"a.f64.json"});
  expect_parts(message("a.f64", R"({"rate_hz": "NaN"})", 80), {"rate_hz", "not a sampling rate"});
  expect_parts(message("a.f64", R"({"rate_hz": 1, "channels": [{}]})", 80), {"has no name"});
  expect_parts(
      message("a.f64", R"({"rate_hz": 1, "channels": [{"name": "x", "scale_factor": 0}]})", 80),
      {"channel x", "scale_factor 0"});
  expect_parts(
      message("a.f64", R"({"rate_hz": 1, "channels": [{"name": "x", "units": "ell"}]})", 160),
      {"channel x", "'ell'"});
}

}  // namespace
}  // namespace imunoise::recording
