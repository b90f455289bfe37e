// Files of every format that end too soon: an error that names the file, or the beginning of what
// the whole one holds. The trial (truncation_trial) cuts at each byte; here it is each of the first
// and last ones, and some between.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "tests/recording/files.h"
#include "tests/recording/hdf5_mutants.h"

namespace imunoise::recording {
namespace {

// What a format lets one see of its end.
struct Cuts {
  std::size_t step = 1;   // bytes from one length to the next
  std::size_t doubt = 0;  // last samples that may be wrong: the last number of a text may go on
  std::size_t most = 0;   // bytes of the file that are cut; 0: all
};

#ifdef IMUNOISE_EVERY_BYTE
constexpr bool kEveryByte = true;
#else
constexpr bool kEveryByte = false;
#endif
constexpr std::size_t kDense = 400;   // bytes at either end of a file that are all cut at
constexpr std::size_t kSparse = 200;  // cuts between them

// The lengths to cut a file of `size` bytes to.
std::vector<std::size_t> lengths(const Cuts& cuts, std::size_t size) {
  const std::size_t end = cuts.most > 0 ? std::min(cuts.most, size) : size;
  const std::size_t strides = end / cuts.step / kSparse + 1;
  std::vector<std::size_t> out;
  for (std::size_t length = 0; length < end;) {
    out.push_back(length);
    const bool dense = kEveryByte || length < kDense || length + kDense > size;
    length += cuts.step * (dense ? 1 : strides);
  }
  return out;
}

class Truncation : public FileTest {
 protected:
  // All samples of the pieces of a channel.
  static std::vector<double> samples_of(const std::vector<Replicate>& all,
                                        const std::string& channel) {
    std::vector<double> out;
    for (const Replicate& one : all) {
      for (const Channel& each : one.channels) {
        if (each.name != channel) continue;
        for (std::size_t i = 0; i < each.count; ++i) out.push_back(each.signal().value(i));
      }
    }
    return out;
  }

  // The number of lengths at which something was read.
  std::size_t read_of(const std::filesystem::path& original, const std::string& name,
                      const Cuts& cuts, const ImportOptions& options = {}) const {
    const std::string bytes = bytes_in(original);
    const auto whole = import_one(write(name, bytes), options);
    EXPECT_TRUE(whole) << whole.error().message;
    if (!whole) return 0;
    std::size_t readable = 0;
    for (const std::size_t length : lengths(cuts, bytes.size())) {
      SCOPED_TRACE(fmt::format("{} of {} bytes of {}", length, bytes.size(), name));
      const auto file = write(name, std::string_view(bytes).substr(0, length));
      const auto got = import_one(file, options);
      if (!got) {
        EXPECT_NE(got.error().message.find(file.string()), std::string::npos)
            << got.error().message;
        continue;
      }
      ++readable;
      for (const Channel& channel : got->front().channels) {
        const std::vector<double> all = samples_of(*whole, channel.name);
        const std::vector<double> here = samples_of(*got, channel.name);
        EXPECT_LE(here.size(), all.size()) << channel.name;
        const std::size_t sure =
            std::min(all.size(), here.size() - std::min(here.size(), cuts.doubt));
        EXPECT_TRUE(
            std::equal(here.begin(), here.begin() + static_cast<std::ptrdiff_t>(sure), all.begin()))
            << channel.name;
      }
      if (HasFailure()) break;
    }
    return readable;
  }

  // A file of a script that stands beside this test; empty where it cannot run.
  std::string written(const std::string& script, const std::string& arguments) const {
    const std::string command = "/usr/bin/python3 " IMUNOISE_SOURCE_DIR "/tests/recording/" +
                                script + " " + arguments + " 2> /dev/null";
    return std::system(command.c_str()) == 0 ? path("whole").string() : "";
  }
};

#define SKIP_WITHOUT(FILE, WRITER) \
  if ((FILE).empty()) GTEST_SKIP() << "no independent writer here: " << (WRITER)

// Records of MATLAB begin at multiples of 8 bytes.
TEST_F(Truncation, OfMatlab) {
  for (const std::string kind : {"matlab5", "matlab5-struct", "matlab5-packed"}) {
    const std::string file = written("write_arrays.py", kind + " " + path("whole").string());
    SKIP_WITHOUT(file, "SciPy");
    read_of(file, "cut.mat", {.step = 4});
  }
}

TEST_F(Truncation, OfArchivesOfArrays) {
  for (const std::string kind : {"npz", "npz-packed"}) {
    const std::string file = written("write_arrays.py", kind + " " + path("whole.npz").string());
    SKIP_WITHOUT(file, "NumPy");
    read_of(path("whole.npz"), "cut.npz", {.step = 3});
  }
}

// Records of HDF5 begin at multiples of 8 bytes, and a child reads them.
TEST_F(Truncation, OfHdf5) {
  for (const Hdf5Bounds bounds : {Hdf5Bounds::kEarliest, Hdf5Bounds::kV110}) {
    hdf5_like_h5py(path("whole"), bounds);
    read_of(path("whole"), "cut.h5", {.step = 8});
  }
}

TEST_F(Truncation, OfBagsOfRos1) {
  for (const std::string packing : {"none", "bz2"}) {
    const std::string file =
        written("write_bag.py", path("whole").string() + " " + packing + " 20");
    SKIP_WITHOUT(file, "Debian's python3-rosbag and python3-sensor-msgs");
    EXPECT_GT(read_of(file, "cut.bag", {}), 0U);
  }
}

TEST_F(Truncation, OfBagsInSqlite) {
  const std::string file = written("write_db3.py", path("whole").string() + " 20");
  SKIP_WITHOUT(file, "Python");
  read_of(file, "cut.db3", {});
}

TEST_F(Truncation, OfLogsOfPx4) {
  const std::string file = written("write_ulog.py", "combined " + path("whole").string());
  SKIP_WITHOUT(file, "Python");
  EXPECT_GT(read_of(file, "cut.ulg", {.most = 6000}), 0U);
}

TEST_F(Truncation, OfXbus) {
  const std::filesystem::path capture =
      std::filesystem::path(IMUNOISE_SOURCE_DIR) / "../shared/captures/xsens/capture1.bin";
  if (!std::filesystem::exists(capture))
    GTEST_SKIP() << capture << " is not here: captures of a real device";
  EXPECT_GT(read_of(capture, "cut.bin", {.most = 6000}), 0U);
}

TEST_F(Truncation, OfText) {
  std::string text = "t,gyro_x (deg/s),acc_z (m/s^2)\n";
  for (int i = 0; i < 60; ++i) text += fmt::format("{:.2f},{:.4f},9.81\n", 0.01 * i, 0.1 * i);
  write("whole", text);
  EXPECT_GT(read_of(path("whole"), "cut.csv", {.doubt = 1}), 0U);
}

TEST_F(Truncation, OfLogsOfACanBus) {
  ImportOptions options;
  options.dbc = write("imu.dbc",
                      "VERSION \"\"\nBU_: imu\nBO_ 291 Rates: 2 imu\n"
                      " SG_ GyroX : 0|16@1- (0.001,0) [-32|32] \"rad/s\" host\n")
                    .string();
  std::string log;
  for (int i = 0; i < 60; ++i)
    log += fmt::format("({:.6f}) can0 123#{:02X}00\n", 1700000000.0 + 0.01 * i, i);
  write("whole", log);
  EXPECT_GT(read_of(path("whole"), "cut.log", {.doubt = 1}, options), 0U);
}

TEST_F(Truncation, OfArrays) {
  std::vector<double> numbers(200);
  for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = static_cast<double>(i);
  write("whole",
        npy("{'descr': '<f8', 'fortran_order': False, 'shape': (200,), }", bytes_of(numbers)));
  read_of(path("whole"), "cut.npy", {}, at_rate(100.0));
}

TEST_F(Truncation, OfPackedFiles) {
  std::string text = "t,x\n";
  for (int i = 0; i < 200; ++i) text += fmt::format("{},{}\n", i * 10, i * i % 977);
  const auto plain = write("a.csv", text);
  for (const std::string program : {"gzip", "bzip2", "zstd", "lz4"}) {
    const std::string command = program + " < " + plain.string() + " > " + path("whole").string();
    if (std::system((command + " 2> /dev/null").c_str()) != 0)
      GTEST_SKIP() << "no " << program << " here";
    read_of(path("whole"), "cut.csv", {.doubt = 1});
  }
}

}  // namespace
}  // namespace imunoise::recording
