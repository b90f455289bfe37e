// HDF5 itself crashes on damaged files, works on others without an end, or asks for all memory:
// each is refused, and the program goes on.

#include "tests/recording/hdf5_mutants.h"

#include <sys/resource.h>

#include <atomic>
#include <map>
#include <stdexcept>
#include <thread>

#include "recording/hdf5/limited_child.h"
#include "recording/import/hdf5/hdf5_process.h"
#include "tests/recording/files.h"

namespace imunoise::recording {
namespace {

class Hdf5Mutants : public FileTest {
 protected:
  // What an import says of a mutant.
  std::string said_of(const std::string& good, std::uint32_t seed) {
    return error_of(write("mutant.h5", mutant(good, seed)));
  }
};

TEST_F(Hdf5Mutants, TheFileIsReadWhenNothingIsDamaged) {
  for (const Hdf5Bounds bounds : {Hdf5Bounds::kEarliest, Hdf5Bounds::kV110}) {
    hdf5_like_h5py(path("good.h5"), bounds);
    const auto got = import_one(path("good.h5"));
    ASSERT_TRUE(got) << got.error().message;
    EXPECT_DOUBLE_EQ(got->front().rate.value, 100.0);
    ASSERT_EQ(got->front().channels.size(), 2U);
    EXPECT_EQ(got->front().channels[1].unit.symbol, "deg/s");
  }
}

// Each of these killed the program before files were read apart, most in H5HG_read. Where the
// library's memory lies decides about single ones, hence not all have to.
TEST_F(Hdf5Mutants, AFileThatCrashesHdf5IsRefused) {
  if (!kHdf5Apart) GTEST_SKIP() << "a build with sanitizers reads HDF5 in its own process";
  std::size_t crashes = 0;
  for (const Hdf5Bounds bounds : {Hdf5Bounds::kEarliest, Hdf5Bounds::kV110}) {
    const std::string good = hdf5_like_h5py(path("good.h5"), bounds);
    for (const std::uint32_t seed : {4U, 9U, 41U, 42U, 44U, 88U, 110U, 111U}) {
      const std::string message = said_of(good, seed);
      const bool crashed = message.find("mutant.h5: HDF5 cannot read it (it ") != std::string::npos;
      if (crashed) expect_parts(message, {"damaged", "copy it again"});
      crashes += crashed ? 1 : 0;
    }
  }
  EXPECT_GE(crashes, 4U);
}

// What the limits do, whoever breaks them.
struct Misdeed {
  const char* what;
  void (*work)(const Line& line);
  const char* told;
};

class LimitedChildOf : public testing::TestWithParam<Misdeed> {};

TEST_P(LimitedChildOf, IsToldOfAndDoesNoHarm) {
  if (!kHdf5Apart) GTEST_SKIP() << "a child of a build with sanitizers may hang";
  auto child = LimitedChild::start(GetParam().work);
  ASSERT_TRUE(child) << child.error().message;
  char byte = 0;
  EXPECT_FALSE(child->line().receive({&byte, 1}));
  EXPECT_EQ(child->cause_of_death(), GetParam().told);
}

INSTANTIATE_TEST_SUITE_P(
    Each, LimitedChildOf,
    testing::Values(Misdeed{"Ends", [](const Line&) {}, "it ended early"},
                    Misdeed{"Throws", [](const Line&) { throw std::runtime_error("no"); },
                            "it ended early"},
                    Misdeed{"Aborts", [](const Line&) { std::abort(); }, "it crashed, signal 6"},
                    Misdeed{"AsksForTooMuch",
                            [](const Line&) {
                              limit_memory(std::uint64_t{64} << 20U);
                              std::vector<char> much(std::size_t{1} << 30U, 'x');
                              if (much[much.size() / 2] == 'x') std::abort();
                            },
                            "it ended early"},
                    Misdeed{"NeverEnds",
                            [](const Line&) {
                              limit_computing(0);
                              for (std::atomic<int> turns = 0;; ++turns) {
                              }
                            },
                            "it exceeded its computing time"}),
    [](const auto& one) { return one.param.what; });

// The parent stops waiting, and the child is gone with the object.
TEST(LimitedChild, IsStopped) {
  if (!kHdf5Apart) GTEST_SKIP() << "a child of a build with sanitizers may hang";
  auto child = LimitedChild::start([](const Line&) { ::pause(); });
  ASSERT_TRUE(child) << child.error().message;
  int asked = 0;
  char byte = 0;
  EXPECT_FALSE(child->line().receive({&byte, 1}, [&] { return ++asked == 3; }));
}

TEST(LimitedChild, IsEndedWhenItSleepsForEver) {
  if (!kHdf5Apart) GTEST_SKIP() << "a child of a build with sanitizers may hang";
  auto child = LimitedChild::start([](const Line&) { ::pause(); });
  ASSERT_TRUE(child) << child.error().message;
  char byte = 0;
  EXPECT_FALSE(child->line().receive({&byte, 1}, nullptr, std::chrono::milliseconds(100)));
  EXPECT_EQ(child->cause_of_death(), "it did nothing for too long");
}

// Both ends speak, while other threads are busy inside HDF5.
TEST(LimitedChild, AnswersWhileOthersAreInsideHdf5) {
  if (!kHdf5Apart) GTEST_SKIP() << "a child of a build with sanitizers may hang";
  std::atomic<bool> done = false;
  std::thread busy([&] {
    while (!done) {
      const Hdf5Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
    }
  });
  for (int round = 0; round < 50; ++round) {
    auto child = LimitedChild::start([](const Line& line) {
      char byte = 0;
      if (!line.receive({&byte, 1})) return;
      const Hdf5Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
      byte = static_cast<char>(type ? byte + 1 : 0);
      line.send({&byte, 1});
    });
    ASSERT_TRUE(child) << child.error().message;
    char byte = 'a';
    ASSERT_TRUE(child->line().send({&byte, 1}));
    ASSERT_TRUE(child->line().receive({&byte, 1}));
    ASSERT_EQ(byte, 'b');
  }
  done = true;
  busy.join();
}

}  // namespace
}  // namespace imunoise::recording
