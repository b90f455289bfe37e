// How much memory the program takes for long recordings: no more than it is allowed, whatever their
// length. Prints peaks and times.

#include <fcntl.h>
#include <gtest/gtest.h>
#include <hdf5.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>

#include <array>
#include <cstdint>
#include <fstream>
#include <iostream>
#include <span>
#include <string>
#include <vector>

#include "recording/hdf5/attributes.h"
#include "recording/hdf5/handle.h"
#include "tests/cli/program.h"

namespace imunoise::testing {
namespace {

constexpr std::size_t kBlock = std::size_t{1} << 20U;      // numbers written at once
constexpr std::size_t kAllowed = std::size_t{128} << 20U;  // bytes of large arrays

struct Peak {
  int status = -1;
  std::size_t bytes = 0;
  double seconds = 0.0;  // of all processors
};

class MemoryTest : public Program {
 protected:
  MemoryTest() : noise_(kBlock) {
    ::setenv("IMUNOISE_MEMORY_MIB", std::to_string(kAllowed >> 20U).c_str(), 1);
    std::uint64_t state = 88172645463325252U;  // xorshift64 (Marsaglia 2003)
    for (double& one : noise_) {
      state ^= state << 13U;
      state ^= state >> 7U;
      state ^= state << 17U;
      one = static_cast<double>(state >> 11U) * 0x1p-53 - 0.5;
    }
  }

  // No block is like another.
  std::vector<double> block(std::size_t number, std::size_t size) const {
    std::vector<double> out(size);
    for (std::size_t i = 0; i < size; ++i)
      out[i] = noise_[i] + noise_[(i * 7 + 31 * number) % kBlock];
    return out;
  }

  // Rows of so many channels.
  void write_npy(const std::string& name, std::size_t rows, std::size_t channels) const {
    std::ofstream file(folder_ / name, std::ios::binary);
    std::string head = "{'descr': '<f8', 'fortran_order': False, 'shape': (" +
                       std::to_string(rows) + ", " + std::to_string(channels) + "), }";
    head.resize(117, ' ');
    file << std::string("\x93NUMPY\x01\x00\x76\x00", 10) << head << '\n';
    for (std::size_t done = 0; done < rows * channels; done += kBlock) {
      const auto numbers = block(done / kBlock, std::min(kBlock, rows * channels - done));
      file.write(reinterpret_cast<const char*>(numbers.data()),
                 static_cast<std::streamsize>(numbers.size() * sizeof(double)));
    }
  }

  void write_hdf5(const std::string& name, std::size_t rows) const {
    using recording::Hdf5Handle;
    const Hdf5Handle file(
        H5Fcreate((folder_ / name).c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), H5Fclose);
    ASSERT_TRUE(recording::write_attribute(file.get(), "rate_hz", 100.0));
    const hsize_t all = rows;
    const Hdf5Handle space(H5Screate_simple(1, &all, nullptr), H5Sclose);
    const Hdf5Handle data(H5Dcreate2(file.get(), "x", H5T_IEEE_F64LE, space.get(), H5P_DEFAULT,
                                     H5P_DEFAULT, H5P_DEFAULT),
                          H5Dclose);
    for (hsize_t done = 0; done < all; done += kBlock) {
      const hsize_t size = std::min<hsize_t>(kBlock, all - done);
      const Hdf5Handle room(H5Screate_simple(1, &size, nullptr), H5Sclose);
      H5Sselect_hyperslab(space.get(), H5S_SELECT_SET, &done, nullptr, &size, nullptr);
      ASSERT_GE(H5Dwrite(data.get(), H5T_NATIVE_DOUBLE, room.get(), space.get(), H5P_DEFAULT,
                         block(done / kBlock, size).data()),
                0);
    }
  }

  // Of the program and of every process that it started.
  Peak peak_of(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), IMUNOISE_BINARY);
    std::vector<char*> pointers;
    for (std::string& one : arguments) pointers.push_back(one.data());
    pointers.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addchdir_np(&actions, folder_.c_str());
    posix_spawn_file_actions_addopen(&actions, 1, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_addopen(&actions, 2, "/dev/null", O_WRONLY, 0);
    pid_t child = 0;
    Peak out;
    if (posix_spawn(&child, IMUNOISE_BINARY, &actions, nullptr, pointers.data(), environ) == 0) {
      int status = 0;
      rusage used{};
      wait4(child, &status, 0, &used);
      out = {WEXITSTATUS(status), static_cast<std::size_t>(used.ru_maxrss) * 1024,
             static_cast<double>(used.ru_utime.tv_sec + used.ru_stime.tv_sec) +
                 1e-6 * static_cast<double>(used.ru_utime.tv_usec + used.ru_stime.tv_usec)};
    }
    posix_spawn_file_actions_destroy(&actions);
    std::cout << arguments[1] << " " << arguments[2] << ": " << out.bytes / 1'000'000 << " MB, "
              << out.seconds << " s of processors\n";
    return out;
  }

  // What large arrays may take in ordinary memory and mapped, twice: files stay mapped until the
  // next look at them, and the heap keeps what was freed; and what the program takes for next to
  // nothing.
  std::size_t bound(std::vector<std::string> arguments) const {
    write_npy("short.npy", 1000, 3);
    arguments[1] = "short.npy";
    return peak_of(std::move(arguments)).bytes + 4 * kAllowed;
  }

  std::vector<double> noise_;
};

TEST_F(MemoryTest, WaveletVarianceOfEightHundredMegabytes) {
  constexpr std::size_t kRows = 100'000'000;
  write_npy("long.npy", kRows, 1);
  write_hdf5("long.h5", kRows);
  for (const std::string file : {"long.npy", "long.h5"}) {
    for (const std::vector<std::string>& more :
         {std::vector<std::string>{}, {"--allan"}, {"--robust", "0.6"}}) {
      if (file == "long.h5" && !more.empty()) continue;  // read as any other
      std::vector<std::string> arguments = {"wv", file, "--rate", "100"};
      arguments.insert(arguments.end(), more.begin(), more.end());
      const std::size_t most = bound(arguments);
      ASSERT_LT(most, kRows * sizeof(double));  // or the test could not fail
      const Peak peak = peak_of(arguments);
      EXPECT_EQ(peak.status, 0);
      EXPECT_LE(peak.bytes, most);
    }
  }
}

TEST_F(MemoryTest, FitOfEightHundredMegabytes) {
  write_npy("long.npy", 100'000'000, 1);
  const std::vector<std::string> arguments = {"fit", "long.npy", "--rate", "100", "--model", "WN"};
  const Peak peak = peak_of(arguments);
  EXPECT_EQ(peak.status, 0);
  EXPECT_LE(peak.bytes, bound(arguments));
}

// Of itself, an export takes 64 MiB of large arrays.
TEST_F(MemoryTest, ExportOfOneHundredSixtyMegabytes) {
  constexpr std::size_t kRows = 20'000'000;
  write_hdf5("long.h5", kRows);
  const std::vector<std::string> arguments = {"export", "long.h5", "--rate", "100",
                                              "--unit", "*=deg/s", "--to",   "csv"};
  const std::size_t most = bound(arguments) - 2 * kAllowed;
  ::unsetenv("IMUNOISE_MEMORY_MIB");
  const Peak peak = peak_of(arguments);
  EXPECT_EQ(peak.status, 0);
  EXPECT_LE(peak.bytes, most);
}

TEST_F(MemoryTest, DiagnosisOfThirtyMillionNumbers) {
  constexpr std::size_t kRows = 10'000'000;
  write_npy("long.npy", kRows, 3);
  const std::vector<std::string> arguments = {"diagnose",     "long.npy", "--rate",  "100",
                                              "--channel",    "col1",     "--model", "WN",
                                              "--split-into", "6"};
  const std::size_t most = bound(arguments);
  ASSERT_LT(most, 3 * 3 * kRows * sizeof(double));  // samples, their copies and their transforms
  const Peak peak = peak_of(arguments);
  EXPECT_EQ(peak.status, 0);
  EXPECT_LE(peak.bytes, most);
}

}  // namespace
}  // namespace imunoise::testing
