// The program's own malloc and new. All cases share one process and one file.

#include "recording/scratch/large_arrays.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <Eigen/Core>
#include <array>
#include <cstdlib>
#include <fstream>
#include <numeric>
#include <thread>
#include <vector>

namespace imunoise::recording {
namespace {

constexpr std::size_t kMiB = std::size_t{1} << 20U;
constexpr std::size_t kInMemory = 16 * kMiB;
constexpr std::size_t kMapped = 64 * kMiB;

// Bytes in memory: all, and those of mapped files.
struct Resident {
  std::size_t all;
  std::size_t mapped;
};
Resident resident() {
  std::ifstream statm("/proc/self/statm");
  std::size_t addresses = 0;
  std::size_t all = 0;
  std::size_t mapped = 0;
  statm >> addresses >> all >> mapped;
  const auto page = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
  return {all * page, mapped * page};
}

class LargeArraysTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    keep_large_arrays({std::filesystem::temp_directory_path(), kInMemory, kMapped});
  }
  void SetUp() override {
#ifdef IMUNOISE_SANITIZED
    GTEST_SKIP() << "sanitizers have their own malloc";
#endif
  }
};

std::vector<double> rising(std::size_t count, double first) {
  std::vector<double> out(count);
  std::iota(out.begin(), out.end(), first);
  return out;
}

bool rises(const double* at, std::size_t count, double first) {
  for (std::size_t i = 0; i < count; ++i) {
    if (at[i] != first + static_cast<double>(i)) return false;
  }
  return true;
}

TEST_F(LargeArraysTest, VectorsOfTenTimesTheBoundKeepTheirNumbersWithinIt) {
  constexpr std::size_t kEach = 4 * kMiB;  // 32 MiB
  std::vector<std::vector<double>> all;
  const std::size_t before = resident().all - resident().mapped;
  for (std::size_t k = 0; k < 20; ++k) all.push_back(rising(kEach, static_cast<double>(k)));
  EXPECT_LE(resident().all - resident().mapped, before + kInMemory + 4 * kMiB);
  for (std::size_t k = 0; k < all.size(); ++k)
    ASSERT_TRUE(rises(all[k].data(), kEach, static_cast<double>(k)));
  // A hundred looks, and more where the processors are busy.
  for (int wait = 0; wait < 50 && resident().mapped > kMapped; ++wait) usleep(200'000);
  EXPECT_LE(resident().mapped, kMapped);
}

TEST_F(LargeArraysTest, WhatFitsStaysInMemory) {
  const std::size_t before = resident().mapped;
  const std::vector<double> small = rising(kMiB, 1.0);  // 8 MiB
  EXPECT_LE(resident().mapped, before + kMiB);
  EXPECT_TRUE(rises(small.data(), small.size(), 1.0));
}

TEST_F(LargeArraysTest, MatricesGrowAndShrinkAcrossTheBound) {
  Eigen::VectorXd grown = Eigen::VectorXd::LinSpaced(1000, 0.0, 999.0);
  for (Eigen::Index size = 1000; size <= 16'000'000; size *= 4) {
    const Eigen::Index old = grown.size();
    grown.conservativeResize(size);
    for (Eigen::Index i = old; i < size; ++i) grown(i) = static_cast<double>(i);
    ASSERT_TRUE(rises(grown.data(), static_cast<std::size_t>(size), 0.0)) << size;
  }
  grown.conservativeResize(2000);
  EXPECT_TRUE(rises(grown.data(), 2000, 0.0));
}

TEST_F(LargeArraysTest, ZeroedMemoryIsZeroWhereOtherNumbersWere) {
  {
    std::vector<std::vector<char>> before;
    for (int k = 0; k < 8; ++k) before.emplace_back(64 * kMiB, 'x');
  }
  auto* const zeros = static_cast<char*>(std::calloc(64, kMiB));
  ASSERT_NE(zeros, nullptr);
  EXPECT_EQ(std::accumulate(zeros, zeros + 64 * kMiB, 0), 0);
  std::free(zeros);
}

TEST_F(LargeArraysTest, ThreadsTakeAndGiveAtTheSameTime) {
  std::array<bool, 4> sound{};
  std::vector<std::thread> threads;
  for (std::size_t thread = 0; thread < sound.size(); ++thread) {
    threads.emplace_back([thread, &sound] {
      bool good = true;
      for (std::size_t i = 0; i < 20; ++i) {
        const auto first = static_cast<double>(1000 * thread + i);
        const std::vector<double> own = rising(kMiB + 4096 * i, first);
        good = good && rises(own.data(), own.size(), first);
      }
      sound[thread] = good;
    });
  }
  for (std::thread& one : threads) one.join();
  for (const bool one : sound) EXPECT_TRUE(one);
}

// It shares the file with its parent: it must neither take from it nor give back.
TEST_F(LargeArraysTest, AForkedProcessLeavesTheFileAlone) {
  std::vector<double> parents = rising(8 * kMiB, 1e6);
  const pid_t child = fork();
  if (child == 0) {
    parents = {};
    bool sound = true;
    std::vector<std::vector<double>> own;
    for (int k = 0; k < 8; ++k) {  // one of them would lie where the parent's do
      own.push_back(rising(8 * kMiB, k));
      sound = sound && rises(own.back().data(), own.back().size(), k);
    }
    _exit(sound ? 0 : 1);
  }
  int status = 1;
  waitpid(child, &status, 0);
  EXPECT_EQ(status, 0);
  EXPECT_TRUE(rises(parents.data(), parents.size(), 1e6));
}

}  // namespace
}  // namespace imunoise::recording
