// Arrays that independent programs wrote: SciPy, NumPy, h5py.

#include <gtest/gtest.h>

#include <cstdlib>
#include <string>

#include "tests/recording/files.h"

namespace imunoise::recording {
namespace {

class Arrays : public FileTest {
 protected:
  // A file that tests/recording/write_arrays.py wrote; empty where Python has no such library.
  std::string written(const std::string& kind, const std::string& extension) const {
    const std::string file = path(kind + extension).string();
    const std::string command = "/usr/bin/python3 " IMUNOISE_SOURCE_DIR
                                "/tests/recording/write_arrays.py " +
                                kind + " " + file + " 2> /dev/null";
    return std::system(command.c_str()) == 0 ? file : "";
  }
};

#define SKIP_UNWRITTEN(FILE) \
  if ((FILE).empty()) GTEST_SKIP() << "no independent writer here: Debian's python3-scipy, -h5py"

const Channel* channel_named(const Replicate& one, const std::string& name) {
  for (const Channel& channel : one.channels) {
    if (channel.name == name) return &channel;
  }
  return nullptr;
}

// What write_arrays.py wrote, under the array names `gyro` and `acc`.
void expect_written(const std::string& file, const std::string& gyro, const std::string& acc) {
  const auto got = import_one(file);
  ASSERT_TRUE(got) << got.error().message;
  const Replicate& one = got->front();
  EXPECT_DOUBLE_EQ(one.rate.value, 200.0) << file;
  ASSERT_EQ(one.channels.size(), 6U) << file;
  const Channel* const x = channel_named(one, gyro + "_x");
  const Channel* const y = channel_named(one, gyro + "_y");
  const Channel* const z = channel_named(one, acc + "_z");
  ASSERT_TRUE(x != nullptr && y != nullptr && z != nullptr) << file;
  ASSERT_EQ(x->count, 400U) << file;
  for (std::size_t i = 0; i < x->count; ++i) {
    const auto number = static_cast<double>(i);
    ASSERT_EQ(stored_doubles(*x)[i], number) << file;
    ASSERT_EQ(stored_doubles(*y)[i], number + 0.25) << file;
    ASSERT_NEAR(stored_doubles(*z)[i], 9.8 + number / 400, 1e-6) << file;
  }
  EXPECT_EQ(z->unit.symbol, "m/s^2") << file;
}

TEST_F(Arrays, MatlabOfEveryKind) {
  for (const std::string kind :
       {"matlab5", "matlab5-packed", "matlab5-rows", "matlab5-rate", "matlab5-rate-packed"}) {
    const std::string file = written(kind, ".mat");
    SKIP_UNWRITTEN(file);
    expect_written(file, "gyro", "acc");
  }
  const std::string file = written("matlab5-struct-packed", ".mat");
  SKIP_UNWRITTEN(file);
  expect_written(file, "imu.gyro", "imu.raw.acc");
}

TEST_F(Arrays, Hdf5OfTwoDimensions) {
  const std::string matlab = written("matlab73", ".mat");
  SKIP_UNWRITTEN(matlab);
  expect_written(matlab, "gyro", "acc");
  expect_written(written("matlab73-struct", ".mat"), "imu.gyro", "imu.acc");
  expect_written(written("hdf5", ".h5"), "gyro", "acc");
}

TEST_F(Arrays, SingleColumnsKeepTheirNames) {
  const std::string file = written("matlab5-counts", ".mat");
  SKIP_UNWRITTEN(file);
  const auto got = import_one(file);
  ASSERT_TRUE(got) << got.error().message;
  ASSERT_EQ(got->front().channels.size(), 2U);
  EXPECT_EQ(got->front().channels[0].name, "gyro");
  EXPECT_EQ(stored_doubles(got->front().channels[0])[399], 399.0);
}

TEST_F(Arrays, ArchivesOfNumpy) {
  for (const std::string kind : {"npz", "npz-packed"}) {
    const std::string file = written(kind, ".npz");
    SKIP_UNWRITTEN(file);
    expect_written(file, "gyro", "acc");
  }
  const std::string odd = written("npz-odd", ".npz");
  SKIP_UNWRITTEN(odd);
  const auto got = import_one(odd);
  ASSERT_TRUE(got) << got.error().message;
  EXPECT_DOUBLE_EQ(got->front().rate.value, 200.0);
  const Channel* const x = channel_named(got->front(), "gyro_x");
  ASSERT_NE(x, nullptr);
  EXPECT_EQ(stored_doubles(*x)[300], 300.0);
}

TEST_F(Arrays, AFirstColumnThatRisesIsTheTime) {
  const std::string file = written("npz-matrix", ".npz");
  SKIP_UNWRITTEN(file);
  const auto got = import_one(file);
  ASSERT_TRUE(got) << got.error().message;
  EXPECT_DOUBLE_EQ(got->front().rate.value, 200.0);
  ASSERT_EQ(got->front().channels.size(), 6U);
  EXPECT_EQ(got->front().channels[0].name, "data_2");
  EXPECT_EQ(stored_doubles(got->front().channels[0])[7], 7.0);
}

TEST_F(Arrays, AnArrayOfNumpyMayBeTransposed) {
  const std::string file = written("npy", ".npy");
  SKIP_UNWRITTEN(file);
  const auto got = import_one(file);
  ASSERT_TRUE(got) << got.error().message;
  EXPECT_DOUBLE_EQ(got->front().rate.value, 200.0);
  ASSERT_EQ(got->front().channels.size(), 6U);
  EXPECT_EQ(got->front().channels[0].name, "col2");
  EXPECT_EQ(stored_doubles(got->front().channels[0])[7], 7.0);
  EXPECT_EQ(stored_doubles(got->front().channels[2])[7], 7.5);
}

// Wherever a file ends: an error that names it, or whole columns of what it holds.
void expect_sound_beginnings(const std::string& file, const std::filesystem::path& cut,
                             std::size_t step) {
  const std::string bytes = bytes_in(file);
  for (std::size_t length = 1; length < bytes.size(); length += step) {
    std::ofstream(cut, std::ios::binary) << bytes.substr(0, length);
    const auto got = import_one(cut);
    if (!got) {
      EXPECT_NE(got.error().message.find(cut.filename().string()), std::string::npos) << length;
      continue;
    }
    const Channel* const x = channel_named(got->front(), "gyro_x");
    if (x == nullptr) continue;
    ASSERT_EQ(x->count, 400U) << length;
    ASSERT_EQ(stored_doubles(*x)[399], 399.0) << length;
  }
}

TEST_F(Arrays, CutAnywhere) {
  for (const std::string kind : {"matlab5", "matlab5-packed"}) {
    const std::string file = written(kind, ".mat");
    SKIP_UNWRITTEN(file);
    expect_sound_beginnings(file, path("cut.mat"), 211);
  }
  for (const std::string kind : {"npz", "npz-packed"}) {
    const std::string file = written(kind, ".npz");
    SKIP_UNWRITTEN(file);
    expect_sound_beginnings(file, path("cut.npz"), 211);
  }
}

class Packed : public FileTest {
 protected:
  // A table of 400 rows, and the same packed by a program of its own.
  bool packed_by(const std::string& command, const std::string& name) const {
    std::string text = "t,x\n";
    for (int i = 0; i < 400; ++i)
      text += std::to_string(i * 10) + "," + std::to_string(i * i % 977) + "\n";
    const auto plain = write("imu.csv", text);
    return std::system(
               (command + " < " + plain.string() + " > " + path(name).string() + " 2> /dev/null")
                   .c_str()) == 0;
  }
};

TEST_F(Packed, ByEveryProgram) {
  for (const auto& [command, name] : {std::pair<std::string, std::string>{"gzip", "a.csv.gz"},
                                      {"bzip2", "a.csv.bz2"},
                                      {"zstd", "a.csv.zst"},
                                      {"lz4", "a.csv.lz4"},
                                      {"gzip", "named_wrongly.csv"}}) {
    if (!packed_by(command, name)) GTEST_SKIP() << "no " << command << " here";
    const auto plain = import_one(path("imu.csv"));
    const auto got = import_one(path(name));
    ASSERT_TRUE(plain && got) << got.error().message;
    EXPECT_EQ(stored_doubles(got->front().channels[0]), stored_doubles(plain->front().channels[0]));
    EXPECT_EQ(got->front().preflight->file, path(name).string());
  }
}

TEST_F(Packed, InSeveralPiecesAndCut) {
  ASSERT_TRUE(packed_by("gzip", "a.csv.gz"));
  const std::string whole = bytes_in(path("a.csv.gz"));
  const auto twice = import_one(write("twice.csv.gz", whole + whole));
  ASSERT_TRUE(twice) << twice.error().message;
  EXPECT_EQ(twice->front().preflight->samples, 800U);
  const auto cut = import_one(write("cut.csv.gz", whole.substr(0, whole.size() * 3 / 4)));
  ASSERT_TRUE(cut) << cut.error().message;
  EXPECT_LT(cut->front().preflight->samples, 400U);
  EXPECT_NE(cut->front().preflight->findings.front().text.find("truncated"), std::string::npos);
  std::string damaged = whole;
  damaged[whole.size() / 2] = static_cast<char>(damaged[whole.size() / 2] ^ 0x55);
  EXPECT_FALSE(import_one(write("damaged.csv.gz", damaged)));
}

}  // namespace
}  // namespace imunoise::recording
