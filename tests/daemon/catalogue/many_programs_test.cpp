// Many programs keep up one catalogue at the same time: each succeeds, and it says what it would
// say if there were only one.

#include <gtest/gtest.h>

#include <latch>
#include <thread>

#include "daemon/catalogue/catalogue.h"
#include "tests/daemon/catalogue/bench_folder.h"
#include "tests/daemon/catalogue/empty_place.h"

namespace imunoise::catalogue {
namespace {

constexpr int kPrograms = 20;

class ManyPrograms : public testing::BenchFolder {
 protected:
  void SetUp() override {
    const testing::EmptyPlace place = testing::empty_place(root_);
    if (!place.trouble.empty()) GTEST_SKIP() << place.trouble;
    where_ = place.where;
    for (int day = 0; day < 4; ++day) {
      const std::string folder = "day" + std::to_string(day);
      add_recording(folder, day);
      add_calibration(folder, {});
    }
  }
  // What one program does; its trouble, or nothing.
  std::string keep_up(const std::string& where, const std::string& bench) const {
    auto catalogue = Catalogue::open(where, bench);
    if (!catalogue) return catalogue.error().message;
    const auto changes = catalogue->refresh(files_, root_);
    return changes ? "" : changes.error().message;
  }
  // All at once, each with a connection of its own.
  void run_all(const std::string& bench_of_odd_ones) const {
    std::latch start(kPrograms);
    std::vector<std::string> troubles(kPrograms);
    std::vector<std::thread> programs;
    for (std::size_t i = 0; i < kPrograms; ++i) {
      programs.emplace_back([&, i] {
        start.arrive_and_wait();
        troubles[i] = keep_up(where_, i % 2 == 1 ? bench_of_odd_ones : "");
      });
    }
    for (std::thread& program : programs) program.join();
    for (const std::string& trouble : troubles) EXPECT_EQ(trouble, "");
  }
  static std::string everything(const std::string& where) {
    auto catalogue = Catalogue::open(where);
    EXPECT_TRUE(catalogue) << catalogue.error().message;
    std::string out =
        catalogue->recordings()->DebugString() + catalogue->calibrations()->DebugString();
    const auto parameters = catalogue->parameters("simulated:0042");
    for (const v1::ParameterHistory& one : *parameters) out += one.DebugString();
    return out;
  }
  // What a single program makes of the same benches.
  std::string expected(const std::vector<std::string>& benches) const {
    const std::string alone = (root_ / "alone.sqlite").string();
    for (const std::string& bench : benches) EXPECT_EQ(keep_up(alone, bench), "");
    return everything(alone);
  }
  std::string where_;
};

TEST_F(ManyPrograms, OnAnEmptyCatalogue) {
  run_all("");
  EXPECT_EQ(everything(where_), expected({""}));
}

TEST_F(ManyPrograms, OnAFullOneWhoseRecordingsChanged) {
  ASSERT_EQ(keep_up(where_, ""), "");
  for (int day = 0; day < 4; ++day)
    add_calibration("day" + std::to_string(day), {3e-4, 2.9e-4, 3.1e-4});
  std::filesystem::remove_all(root_ / "day2");
  run_all("");
  EXPECT_EQ(everything(where_), expected({""}));
}

TEST_F(ManyPrograms, OfTwoBenches) {
  run_all("south");
  EXPECT_EQ(everything(where_), expected({"", "south"}));
}

}  // namespace
}  // namespace imunoise::catalogue
