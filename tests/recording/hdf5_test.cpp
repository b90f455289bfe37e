// HDF5 files as other programs write them, and those that must be refused.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "recording/hdf5/attributes.h"
#include "recording/import/hdf5/hdf5_process.h"
#include "tests/recording/files.h"

namespace imunoise::recording {
namespace {

// An HDF5 file under construction.
class Hdf5File {
 public:
  explicit Hdf5File(const std::filesystem::path& path)
      : file_(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), H5Fclose) {}

  hid_t id() const { return file_.get(); }
  template <class Number>
  Hdf5Handle dataset(const char* name, const std::vector<Number>& values, hid_t stored,
                     hid_t memory, std::vector<hsize_t> shape = {}) {
    if (shape.empty()) shape = {values.size()};
    const Hdf5Handle space(H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr),
                           H5Sclose);
    Hdf5Handle out(
        H5Dcreate2(id(), name, stored, space.get(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
        H5Dclose);
    EXPECT_GE(H5Dwrite(out.get(), memory, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), 0);
    return out;
  }

 private:
  Hdf5Handle file_;
};

class Hdf5 : public FileTest {
 protected:
  std::vector<std::int16_t> counts_ = std::vector<std::int16_t>(20, 7);
};

TEST_F(Hdf5, CountsStayCountsAndFloatsBecomeDoubles) {
  {
    Hdf5File file(path("a.h5"));
    ASSERT_TRUE(write_attribute(file.id(), "rate_hz", 12.5));
    const auto a = file.dataset("a", counts_, H5T_STD_I16BE, H5T_NATIVE_INT16);
    ASSERT_TRUE(write_attribute(a.get(), "scale_factor", 0.5));
    ASSERT_TRUE(write_attribute(a.get(), "add_offset", 3.0));
    ASSERT_TRUE(write_attribute(a.get(), "units", std::string_view("m s-2")));
    file.dataset("b", std::vector<std::int32_t>(20, -100000), H5T_STD_I32LE, H5T_NATIVE_INT32);
    file.dataset("c", std::vector<float>(20, 0.1F), H5T_IEEE_F32LE, H5T_NATIVE_FLOAT);
    file.dataset("d", std::vector<double>(20, 0.1), H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE);
    const Hdf5Handle group(H5Gcreate2(file.id(), "e", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
                           H5Gclose);
  }
  const auto got = import_one(path("a.h5"));
  ASSERT_TRUE(got) << got.error().message;
  const std::vector<Channel>& channels = got->front().channels;
  EXPECT_EQ(got->front().rate.value, 12.5);
  ASSERT_EQ(channels.size(), 4U);
  EXPECT_EQ(std::get<std::vector<std::int16_t>>(*channels[0].samples), counts_);
  EXPECT_DOUBLE_EQ(channels[0].signal().value(2), 6.5);
  EXPECT_EQ(channels[0].unit.symbol, "m/s^2");
  EXPECT_EQ(std::get<std::vector<std::int32_t>>(*channels[1].samples)[5], -100000);
  EXPECT_EQ(stored_doubles(channels[2])[5], static_cast<double>(0.1F));
  EXPECT_EQ(stored_doubles(channels[3])[5], 0.1);
  EXPECT_EQ(channels[3].unit.quantity, Quantity::kUnknown);
}

// As h5py users write them: times in the root, sensors in groups; or a rate and a unit by their
// shorter names.
TEST_F(Hdf5, SensorsInGroupsAndOtherNamesOfAttributes) {
  std::vector<double> times(20);
  for (std::size_t i = 0; i < times.size(); ++i) times[i] = 0.01 * static_cast<double>(i);
  {
    Hdf5File file(path("a.h5"));
    file.dataset("time", times, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE);
    const Hdf5Handle group(H5Gcreate2(file.id(), "imu", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
                           H5Gclose);
    file.dataset("imu/gyro_x", counts_, H5T_STD_I16LE, H5T_NATIVE_INT16);
  }
  const auto got = import_one(path("a.h5"));
  ASSERT_TRUE(got) << got.error().message;
  EXPECT_EQ(got->front().channels.at(0).name, "imu.gyro_x");
  EXPECT_EQ(got->front().rate.value, 100.0);
  {
    Hdf5File file(path("b.h5"));
    ASSERT_TRUE(write_attribute(file.id(), "fs", 50.0));
    const auto x = file.dataset("gyro_x", counts_, H5T_STD_I16LE, H5T_NATIVE_INT16);
    ASSERT_TRUE(write_attribute(x.get(), "unit", std::string_view("deg/s")));
  }
  const auto named = import_one(path("b.h5"));
  ASSERT_TRUE(named) << named.error().message;
  EXPECT_EQ(named->front().rate.value, 50.0);
  EXPECT_EQ(named->front().channels.at(0).unit.symbol, "deg/s");
}

TEST_F(Hdf5, WhatStandsBesideIsReadButNoTicks) {
  {
    Hdf5File file(path("a.h5"));
    ASSERT_TRUE(write_attribute(file.id(), "rate_hz", 12.5));
    for (const auto& [name, units] :
         {std::pair("a", "deg/s"), std::pair("b", "ticks"), std::pair("c", "K")}) {
      const auto dataset = file.dataset(name, counts_, H5T_STD_I16BE, H5T_NATIVE_INT16);
      ASSERT_TRUE(write_attribute(dataset.get(), "units", std::string_view(units)));
    }
  }
  ImportOptions options;
  options.channels = {"c"};
  options.beside = true;
  const auto got = import_one(path("a.h5"), options);
  ASSERT_TRUE(got) << got.error().message;
  ASSERT_EQ(got->front().channels.size(), 2U);
  EXPECT_EQ(got->front().channels[0].name, "c");
  EXPECT_EQ(got->front().channels[1].name, "a");
}

TEST_F(Hdf5, ATimeDatasetGivesTheRateAndIsNoChannel) {
  std::vector<std::int32_t> times(20);
  std::iota(times.begin(), times.end(), 1000);
  const auto make = [&] {
    Hdf5File file(path("a.h5"));
    file.dataset("x", counts_, H5T_STD_I16LE, H5T_NATIVE_INT16);
    const auto t = file.dataset("time", times, H5T_STD_I32LE, H5T_NATIVE_INT32);
    EXPECT_TRUE(write_attribute(t.get(), "units", std::string_view("ms")));
  };
  make();
  const auto got = import_one(path("a.h5"));
  ASSERT_TRUE(got) << got.error().message;
  EXPECT_EQ(got->front().rate.value, 1000.0);
  EXPECT_EQ(got->front().channels.size(), 1U);
  for (std::size_t i = 9; i < 20; ++i) times[i] += 5;
  make();
  expect_parts(error_of(path("a.h5")), {"a.h5: 11 samples", "gap", "sample 9"});
}

TEST_F(Hdf5, DatasetsOfTheWrongKind) {
  const auto message = [&](auto&& fill) {
    {
      Hdf5File file(path("a.h5"));
      EXPECT_TRUE(write_attribute(file.id(), "rate_hz", 100.0));
      fill(file);
    }
    return error_of(path("a.h5"));
  };
  expect_parts(message([](Hdf5File&) {}), {"a.h5", "no channel"});
  expect_parts(
      message([](Hdf5File& f) {
        f.dataset("x", std::vector<double>(40), H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, {20, 1, 2});
      }),
      {"a.h5: dataset x: has 3 dimensions", "--channel"});
  for (const auto& [stored, memory] :
       {std::pair{H5T_STD_I64LE, H5T_NATIVE_INT64}, {H5T_STD_U64BE, H5T_NATIVE_INT64}}) {
    EXPECT_EQ(
        message([&, stored = stored, memory = memory](Hdf5File& f) {
          f.dataset(
              "x", std::vector<std::int64_t>{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16},
              stored, memory);
        }),
        "no error");
  }
  expect_parts(message([](Hdf5File& f) {
                 std::vector<double> values(20, 1.0);
                 values[11] = std::numeric_limits<double>::quiet_NaN();
                 f.dataset("x", values, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE);
               }),
               {"a.h5: ", "channel x misses 1 value", "sample 11"});
  expect_parts(message([&](Hdf5File& f) {
                 std::vector<std::int16_t> counts = counts_;
                 counts[8] = -32768;
                 const auto x = f.dataset("x", counts, H5T_STD_I16LE, H5T_NATIVE_INT16);
                 EXPECT_TRUE(write_attribute(x.get(), "_FillValue", -32768.0));
               }),
               {"a.h5: 11 samples", "channel x misses 1 value", "sample 8"});
  expect_parts(message([&](Hdf5File& f) {
                 f.dataset("x", counts_, H5T_STD_I16LE, H5T_NATIVE_INT16);
                 f.dataset("y", std::vector<std::int16_t>(17), H5T_STD_I16LE, H5T_NATIVE_INT16);
               }),
               {"a.h5: channel y has 17 samples where x has 20", "--channel"});
  expect_parts(message([&](Hdf5File& f) {
                 const auto x = f.dataset("x", counts_, H5T_STD_I16LE, H5T_NATIVE_INT16);
                 EXPECT_TRUE(write_attribute(x.get(), "units", std::string_view("cubit")));
               }),
               {"a.h5: channel x", "'cubit'", "--unit"});
  expect_parts(message([&](Hdf5File& f) {
                 const auto x = f.dataset("x", counts_, H5T_STD_I16LE, H5T_NATIVE_INT16);
                 EXPECT_TRUE(write_attribute(x.get(), "scale_factor", 0.0));
               }),
               {"a.h5: dataset x", "scale_factor 0"});
  expect_parts(message([&](Hdf5File& f) {
                 const auto x = f.dataset("x", counts_, H5T_STD_I16LE, H5T_NATIVE_INT16);
                 EXPECT_TRUE(write_attribute(x.get(), "scale_factor", std::string_view("two")));
               }),
               {"a.h5: dataset x", "scale_factor must be a number"});
  expect_parts(message([&](Hdf5File& f) {
                 const auto x = f.dataset("x", counts_, H5T_STD_I16LE, H5T_NATIVE_INT16);
                 EXPECT_TRUE(write_attribute(x.get(), "units", 3.0));
               }),
               {"a.h5: dataset x", "units must be a string"});
}

// A title, parameters, a covariance a sample and the rate beside channels of one dimension, and
// beside channels in a matrix of one column.
TEST_F(Hdf5, WhatIsNoChannelIsLeftOut) {
  const auto beside = [](Hdf5File& f, bool with_title) {
    f.dataset("bias", std::vector<double>(3), H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE);
    f.dataset("covariance", std::vector<double>(80), H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, {20, 2, 2});
    f.dataset("rotation", std::vector<double>(9), H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, {3, 3});
    const Hdf5Handle scalar(H5Screate(H5S_SCALAR), H5Sclose);
    const Hdf5Handle fs(H5Dcreate2(f.id(), "fs", H5T_IEEE_F64LE, scalar.get(), H5P_DEFAULT,
                                   H5P_DEFAULT, H5P_DEFAULT),
                        H5Dclose);
    const double rate = 250.0;
    ASSERT_GE(H5Dwrite(fs.get(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, &rate), 0);
    if (!with_title) return;
    const Hdf5Handle text(H5Tcopy(H5T_C_S1), H5Tclose);
    const Hdf5Handle title(H5Dcreate2(f.id(), "title", text.get(), scalar.get(), H5P_DEFAULT,
                                      H5P_DEFAULT, H5P_DEFAULT),
                           H5Dclose);
    ASSERT_TRUE(title);
  };
  for (const bool matrix : {false, true}) {
    {
      Hdf5File file(path("a.h5"));
      const std::vector<hsize_t> shape =
          matrix ? std::vector<hsize_t>{20, 1} : std::vector<hsize_t>{20};
      file.dataset("gyro_x", counts_, H5T_STD_I16LE, H5T_NATIVE_INT16, shape);
      file.dataset("gyro_y", counts_, H5T_STD_I16LE, H5T_NATIVE_INT16, shape);
      beside(file, !matrix);
    }
    const auto got = import_one(path("a.h5"));
    ASSERT_TRUE(got) << got.error().message << ", in a matrix: " << matrix;
    ASSERT_EQ(got->front().channels.size(), 2U) << matrix;
    EXPECT_EQ(got->front().channels[1].name, "gyro_y");
    expect_parts(fmt::format("{}", fmt::join(got->front().preflight->recognised, "; ")),
                 {"bias, covariance, rotation", "left out"});
    EXPECT_EQ(got->front().rate.value, 250.0);
    ImportOptions options;
    options.channels = {"covariance"};
    expect_parts(error_of(path("a.h5"), options), {"covariance: has 3 dimensions"});
  }
}

// What was not written to its end may have been a channel: it is told, not left out.
TEST_F(Hdf5, ADamagedDatasetBesideChannelsIsAnError) {
  {
    Hdf5File file(path("a.h5"));
    file.dataset("gyro_x", counts_, H5T_STD_I16LE, H5T_NATIVE_INT16);
    const hsize_t size = 20;
    const Hdf5Handle space(H5Screate_simple(1, &size, nullptr), H5Sclose);
    const Hdf5Handle x(H5Dcreate2(file.id(), "gyro_y", H5T_IEEE_F64LE, space.get(), H5P_DEFAULT,
                                  H5P_DEFAULT, H5P_DEFAULT),
                       H5Dclose);
    ASSERT_TRUE(x);
  }
  expect_parts(error_of(path("a.h5"), at_rate(1)), {"a.h5: dataset gyro_y: claims 20 samples"});
}

// A structured array of numpy's: each of its numbers is a channel, or the time; texts are not.
TEST_F(Hdf5, RecordsHaveAChannelForEachNumber) {
  struct Row {
    double time = 0.0;
    std::int16_t gyro_x = 0;
    char state[4] = "ok";
    float gyro_y = 0.0F;
  };
  std::vector<Row> rows(20);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    rows[i].time = static_cast<double>(i) / 50.0;
    rows[i].gyro_x = static_cast<std::int16_t>(i * i);
    rows[i].gyro_y = 0.5F * static_cast<float>(i);
  }
  {
    Hdf5File file(path("a.h5"));
    const Hdf5Handle record(H5Tcreate(H5T_COMPOUND, sizeof(Row)), H5Tclose);
    const Hdf5Handle text(H5Tcopy(H5T_C_S1), H5Tclose);
    H5Tset_size(text.get(), sizeof rows[0].state);
    H5Tinsert(record.get(), "time", HOFFSET(Row, time), H5T_NATIVE_DOUBLE);
    H5Tinsert(record.get(), "gyro_x", HOFFSET(Row, gyro_x), H5T_NATIVE_INT16);
    H5Tinsert(record.get(), "state", HOFFSET(Row, state), text.get());
    H5Tinsert(record.get(), "gyro_y", HOFFSET(Row, gyro_y), H5T_NATIVE_FLOAT);
    file.dataset("imu", rows, record.get(), record.get());
  }
  const auto got = import_one(path("a.h5"));
  ASSERT_TRUE(got) << got.error().message;
  EXPECT_NEAR(got->front().rate.value, 50.0, 1e-9);
  const auto& channels = got->front().channels;
  ASSERT_EQ(channels.size(), 2U);
  EXPECT_EQ(channels[0].name, "imu.gyro_x");
  EXPECT_EQ(channels[1].name, "imu.gyro_y");
  EXPECT_EQ(std::get<std::vector<std::int16_t>>(*channels[0].samples)[7], 49);
  EXPECT_EQ(std::get<std::vector<double>>(*channels[1].samples)[7], 3.5);
}

// Read in pieces of a million numbers, or of whole chunks.
TEST_F(Hdf5, DatasetsOfSeveralPieces) {
  constexpr std::size_t kMany = 2'500'001;
  std::vector<std::int32_t> numbers(kMany);
  std::iota(numbers.begin(), numbers.end(), -7);
  std::vector<double> pairs(2 * kMany);
  std::iota(pairs.begin(), pairs.end(), 0.25);
  {
    Hdf5File file(path("long.h5"));
    ASSERT_TRUE(write_attribute(file.id(), "rate_hz", 100.0));
    file.dataset("a", numbers, H5T_STD_I32LE, H5T_NATIVE_INT32);
    const auto b = file.dataset("b", numbers, H5T_STD_I32LE, H5T_NATIVE_INT32);
    ASSERT_TRUE(write_attribute(b.get(), "_FillValue", static_cast<double>(kMany - 8)));  // last
    file.dataset("c", pairs, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, {kMany, 2});
    file.dataset("d", pairs, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, {2, kMany});
  }
  const auto got = import_one(path("long.h5"));
  ASSERT_TRUE(got) << got.error().message;
  const std::vector<Channel>& channels = got->front().channels;
  ASSERT_EQ(channels.size(), 6U);
  EXPECT_EQ(std::get<std::vector<std::int32_t>>(*channels[0].samples), numbers);
  const auto& missing = std::get<std::vector<double>>(*channels[1].samples);
  ASSERT_EQ(missing.size(), kMany);
  EXPECT_TRUE(std::equal(missing.begin(), missing.end() - 1, numbers.begin()));
  EXPECT_TRUE(std::isnan(missing.back()));
  for (std::size_t i = 0; i < kMany; i += 99'991) {
    const auto at = [&](std::size_t c) {
      return std::get<std::vector<double>>(*channels[c].samples)[i];
    };
    ASSERT_EQ(at(2), pairs[2 * i]);
    ASSERT_EQ(at(3), pairs[2 * i + 1]);
    ASSERT_EQ(at(4), pairs[i]);
    ASSERT_EQ(at(5), pairs[kMany + i]);
  }
}

TEST_F(Hdf5, NoRateAnywhere) {
  { Hdf5File(path("a.h5")).dataset("x", counts_, H5T_STD_I16LE, H5T_NATIVE_INT16); }
  expect_parts(error_of(path("a.h5")), {"a.h5", "rate_hz", "--rate HZ"});
  EXPECT_EQ(error_of(path("a.h5"), at_rate(1)), "no error");
}

// A dataset that was created and never written asks for 8 TB and holds nothing.
TEST_F(Hdf5, AClaimThatTheFileCannotHoldAllocatesNothing) {
  {
    Hdf5File file(path("a.h5"));
    const hsize_t size = hsize_t{1} << 40U;
    const hsize_t chunk = 1024;
    const Hdf5Handle space(H5Screate_simple(1, &size, nullptr), H5Sclose);
    const Hdf5Handle properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    ASSERT_GE(H5Pset_chunk(properties.get(), 1, &chunk), 0);
    const Hdf5Handle x(H5Dcreate2(file.id(), "x", H5T_IEEE_F64LE, space.get(), H5P_DEFAULT,
                                  properties.get(), H5P_DEFAULT),
                       H5Dclose);
    ASSERT_TRUE(x);
  }
  expect_parts(error_of(path("a.h5"), at_rate(1)),
               {"a.h5: dataset x: claims 1099511627776 samples"});
}

// Zeros deflate 1000 to 1, and each name for them costs a few bytes.
TEST_F(Hdf5, ManyNamesForOneDatasetFillNoMemory) {
  {
    Hdf5File file(path("a.h5"));
    const hsize_t size = hsize_t{1} << 20U;
    const Hdf5Handle space(H5Screate_simple(1, &size, nullptr), H5Sclose);
    const Hdf5Handle properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    ASSERT_GE(H5Pset_chunk(properties.get(), 1, &size), 0);
    ASSERT_GE(H5Pset_deflate(properties.get(), 9), 0);
    const std::vector<double> zeros(size);
    const Hdf5Handle x(H5Dcreate2(file.id(), "x", H5T_IEEE_F64LE, space.get(), H5P_DEFAULT,
                                  properties.get(), H5P_DEFAULT),
                       H5Dclose);
    ASSERT_GE(H5Dwrite(x.get(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, zeros.data()), 0);
    for (int i = 0; i < 100; ++i) {
      const std::string name = "y" + std::to_string(i);
      ASSERT_GE(H5Lcreate_hard(file.id(), "x", file.id(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT),
                0);
    }
  }
  if (kHdf5Apart) {  // which bounds them together
    expect_parts(error_of(path("a.h5"), at_rate(1)),
                 {"a.h5: its datasets claim more numbers than the file can hold", "--channel"});
  }
  ImportOptions one = at_rate(1);
  one.channels = {"y7"};
  EXPECT_EQ(error_of(path("a.h5"), one), "no error");
}

TEST_F(Hdf5, NumbersInAnotherFileAreNotFollowed) {
  write("secret", std::string(160, 's'));
  {
    Hdf5File file(path("a.h5"));
    const hsize_t size = 20;
    const Hdf5Handle space(H5Screate_simple(1, &size, nullptr), H5Sclose);
    const Hdf5Handle properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    ASSERT_GE(H5Pset_external(properties.get(), path("secret").c_str(), 0, 160), 0);
    const Hdf5Handle x(H5Dcreate2(file.id(), "x", H5T_IEEE_F64LE, space.get(), H5P_DEFAULT,
                                  properties.get(), H5P_DEFAULT),
                       H5Dclose);
    ASSERT_TRUE(x);
  }
  expect_parts(error_of(path("a.h5"), at_rate(1)), {"a.h5: dataset x", "in another file"});
}

}  // namespace
}  // namespace imunoise::recording
