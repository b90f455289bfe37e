// Several files, and one file cut into several.

#include <gtest/gtest.h>

#include <algorithm>
#include <mutex>
#include <stop_token>

#include "tests/recording/files.h"

namespace imunoise::recording {
namespace {

class Replicates : public FileTest {
 protected:
  // A table in which sample i is `first` + i.
  std::filesystem::path numbered(const std::string& name, int rows, int first = 0,
                                 const std::string& head = "x [g],y\n") const {
    std::string text = head;
    for (int i = 0; i < rows; ++i) text += std::to_string(first + i) + ",1\n";
    return write(name, text);
  }
};

using Paths = std::vector<std::filesystem::path>;

TEST_F(Replicates, SplittingSharesTheSamplesAndDropsTheRemainder) {
  ImportOptions options = at_rate(10);
  options.split_into = 3;
  const auto got = import_one(numbered("run.csv", 101), options);
  ASSERT_TRUE(got) << got.error().message;
  ASSERT_EQ(got->size(), 3U);
  for (std::size_t part = 0; part < 3; ++part) {
    const Replicate& run = (*got)[part];
    EXPECT_EQ(run.name, "run#" + std::to_string(part + 1));
    const Channel& x = run.channels[0];
    EXPECT_EQ(x.samples, (*got)[0].channels[0].samples);
    ASSERT_EQ(x.signal().size(), 33U);
    EXPECT_DOUBLE_EQ(x.signal().value(0), 9.80665 * 33.0 * static_cast<double>(part));
    EXPECT_DOUBLE_EQ(x.signal().value(32), 9.80665 * (33.0 * static_cast<double>(part) + 32.0));
  }
  options.split_into = 7;
  expect_parts(error_of(path("run.csv"), options),
               {"run.csv", "14 samples in each of 7 parts", "fewer"});
}

TEST_F(Replicates, TellWhereTheyLieInWhatWasRecorded) {
  std::string text = "time [s],x [g]\n";
  for (int i = 0; i < 400; ++i) {
    if (i < 20 || (i >= 100 && i < 150)) continue;  // lost, but for the first row
    text += std::to_string(i) + "e-2," + (i == 230 ? "nan" : std::to_string(i % 7)) + "\n";
  }
  const std::filesystem::path gap = write("gap.csv", text);
  const auto got = import_files(Paths{gap, gap}, {});
  ASSERT_TRUE(got) << got.error().message;
  std::vector<std::pair<std::size_t, std::uint64_t>> origins;
  for (const Replicate& one : *got) origins.emplace_back(one.origin.recording, one.origin.first);
  EXPECT_EQ(origins, (std::vector<std::pair<std::size_t, std::uint64_t>>{
                         {0, 0}, {0, 130}, {0, 211}, {1, 0}, {1, 130}, {1, 211}}));
  ImportOptions options;
  options.from = 1.5;
  options.split_into = 2;
  const auto later = import_one(gap, options);
  ASSERT_TRUE(later) << later.error().message;
  ASSERT_EQ(later->size(), 4U);
  EXPECT_EQ((*later)[0].origin.first, 0U);
  EXPECT_EQ((*later)[1].origin.first, 30U);
  EXPECT_EQ((*later)[3].origin.recording, 0U);
}

TEST_F(Replicates, SeveralFilesComeInTheOrderNamed) {
  std::filesystem::create_directory(path("a"));
  std::filesystem::create_directory(path("b"));
  Paths paths;
  for (int i = 0; i < 6; ++i) {
    paths.push_back(numbered((i % 2 == 0 ? "a/run" : "b/run") + std::to_string(i / 2) + ".csv",
                             20 + i, 100 * i));
  }
  const auto got = import_files(paths, at_rate(10));
  ASSERT_TRUE(got) << got.error().message;
  ASSERT_EQ(got->size(), 6U);
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_EQ((*got)[i].source, paths[i]);
    EXPECT_EQ(stored_doubles((*got)[i].channels[0])[0], 100.0 * static_cast<double>(i));
  }
  EXPECT_EQ((*got)[0].name, "a/run0.csv");
  EXPECT_EQ((*got)[1].name, "b/run0.csv");
}

TEST_F(Replicates, ColumnsInAnotherOrderAreTheSameChannels) {
  const Paths paths = {write("a.csv", "x,y,z\n" + repeated("1,2,3\n")),
                       write("b.csv", "z,x,y\n" + repeated("3,1,2\n"))};
  const auto got = import_files(paths, at_rate(10));
  ASSERT_TRUE(got) << got.error().message;
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_EQ((*got)[1].channels[c].name, (*got)[0].channels[c].name);
    EXPECT_EQ(stored_doubles((*got)[1].channels[c])[0], static_cast<double>(c + 1));
  }
}

TEST_F(Replicates, FilesThatDisagreeAreRefused) {
  const auto message = [&](const std::string& head, const ImportOptions& options = at_rate(10)) {
    const Paths paths = {numbered("one.csv", 20), numbered("two.csv", 20, 0, head)};
    const auto got = import_files(paths, options);
    return got ? "no error" : got.error().message;
  };
  expect_parts(message("x [mg],y\n"),
               {"two.csv: channel x is in mg", "one.csv it is in g", "--unit"});
  expect_parts(message("x [g],z\n"), {"two.csv: no channel 'y'", "one.csv", "--channel"});
  ImportOptions options = at_rate(10);
  options.channels = {"y"};
  expect_parts(message("x [g],z\n", options), {"two.csv: no channel 'y' (it has: x, z)"});
  const auto more = import_files(
      Paths{numbered("one.csv", 20), write("three.csv", "x [g],y,z\n" + repeated("1,2,3\n"))},
      at_rate(10));
  ASSERT_FALSE(more);
  expect_parts(more.error().message, {"three.csv: has channel 'z'", "one.csv has not"});
}

TEST_F(Replicates, RatesMayDifferAsClocksDo) {
  const auto rates = [&](const std::string& first, const std::string& second) {
    return import_files(Paths{numbered("a.csv", 20, 0, "# rate_hz: " + first + "\nx,y\n"),
                              numbered("b.csv", 20, 0, "# rate_hz: " + second + "\nx,y\n")});
  };
  const auto close = rates("100", "100.01");
  ASSERT_TRUE(close) << close.error().message;
  EXPECT_EQ((*close)[1].rate.value, 100.0);
  EXPECT_EQ((*close)[1].channels[0].signal().rate().value, 100.0);
  const auto far = rates("100", "101");
  ASSERT_FALSE(far);
  expect_parts(far.error().message, {"b.csv: sampled at 101 Hz", "a.csv at 100 Hz", "--rate"});
}

TEST_F(Replicates, ProgressReachesTheEndAndAStopIsHeeded) {
  // Files are read side by side: what is told comes from several threads, in any order.
  std::mutex told;
  double last = 0.0;
  const Progress progress([&](double fraction) {
    const std::scoped_lock lock(told);
    last = std::max(last, fraction);
  });
  const Paths paths = {numbered("a.csv", 20), numbered("b.csv", 20)};
  ASSERT_TRUE(import_files(paths, at_rate(10), progress));
  EXPECT_NEAR(last, 1.0, 1e-9);
  std::stop_source source;
  source.request_stop();
  const auto stopped =
      import_files(Paths{numbered("c.csv", 5000)}, at_rate(10), Progress({}, source.get_token()));
  ASSERT_FALSE(stopped);
  expect_parts(stopped.error().message, {"c.csv", "stopped"});
}

}  // namespace
}  // namespace imunoise::recording
