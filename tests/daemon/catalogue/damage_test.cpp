// Whatever byte of a catalogue's file is damaged, it never says what the recordings do not say.

#include "tests/support/damage.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iostream>
#include <iterator>
#include <map>
#include <random>

#include "core/support/utf8.h"
#include "daemon/catalogue/catalogue.h"
#include "tests/daemon/catalogue/bench_folder.h"

namespace imunoise::catalogue {
namespace {

class DamagedCatalogue : public testing::BenchFolder {
 protected:
  void SetUp() override {
    for (int day = 0; day < 3; ++day) {
      const std::string folder = "day" + std::to_string(day);
      add_recording(folder, day);
      add_calibration(folder, {});
    }
    auto catalogue = Catalogue::open(file_.string());
    ASSERT_TRUE(catalogue) << catalogue.error().message;
    ASSERT_TRUE(catalogue->refresh(files_, root_));
    truth_ = everything(*catalogue);
  }
  static std::string everything(Catalogue& catalogue) {
    const auto recordings = catalogue.recordings();
    const auto calibrations = catalogue.calibrations();
    const auto parameters = catalogue.parameters("simulated:0042");
    if (!recordings || !calibrations || !parameters) return "an error";
    std::string out = recordings->DebugString() + calibrations->DebugString();
    for (const v1::ParameterHistory& one : *parameters) out += one.DebugString();
    return out;
  }
  std::string bytes() const {
    std::ifstream in(file_, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  void write_bytes(const std::string& bytes) const {
    std::ofstream(file_, std::ios::binary | std::ios::trunc) << bytes;
  }
  struct Outcome {
    std::string said;  // "right", "wrong", or an error
    std::string repair;
  };
  Outcome outcome() {
    auto catalogue = Catalogue::open(file_.string());
    if (!catalogue) return {catalogue.error().message, ""};
    const auto changes = catalogue->refresh(files_, root_);
    if (!changes) return {changes.error().message, catalogue->repair()};
    return {everything(*catalogue) == truth_ ? "right" : "wrong", catalogue->repair()};
  }
  // As a disk may do it: a bit, a byte, or a sector of zeros.
  static std::string damaged(std::string bytes, std::uint32_t seed) {
    std::mt19937 random(seed);
    std::size_t at = random() % bytes.size();
    while (bytes[at] == '\0') at = random() % bytes.size();  // most of a page is empty
    damage(bytes, at, random, [&] { bytes.replace(at / 512 * 512, 512, 512, '\0'); });
    return bytes;
  }
  // What became of the seeds.
  std::map<std::string, int> trial(std::uint32_t first, std::uint32_t last) {
    const std::string good = bytes();
    std::map<std::string, int> out;
    for (std::uint32_t seed = first; seed < last; ++seed) {
      write_bytes(damaged(good, seed));
      const Outcome one = outcome();
      const bool known = one.said == "right" || one.said == "wrong";
      EXPECT_TRUE(is_utf8(one.said) && is_utf8(one.repair)) << "seed " << seed;
      if (one.said == "wrong") ADD_FAILURE() << "seed " << seed << ": " << one.repair;
      if (!known) std::cout << "seed " << seed << ": " << one.said << "\n";
      ++out[!known ? "refused" : one.repair.empty() ? one.said : one.said + ", repaired"];
    }
    for (const auto& [what, count] : out) std::cout << what << ": " << count << "\n";
    return out;
  }
  std::filesystem::path file_ = root_ / "catalogue.sqlite";
  std::string truth_;
};

TEST_F(DamagedCatalogue, SaysNothingWrong) {
  auto out = trial(0, IMUNOISE_DAMAGES);
  EXPECT_GT(out["right, repaired"], 10);
}

TEST_F(DamagedCatalogue, AChangedValueIsReadAgain) {
  const std::string good = bytes();
  std::string bad = good;
  const std::size_t at = bad.find("monthly");
  ASSERT_NE(at, std::string::npos);
  bad.replace(at, 7, "mouthly");
  write_bytes(bad);
  const Outcome got = outcome();
  EXPECT_EQ(got.said, "right");
  EXPECT_NE(got.repair.find("catalogue.sqlite: 1 damaged entries; imunoise reads"),
            std::string::npos)
      << got.repair;
  EXPECT_EQ(outcome().repair, "") << "mended";
}

TEST_F(DamagedCatalogue, ATornFileIsSetAsideAndMadeAgain) {
  const std::string good = bytes();
  std::string torn = good;
  torn.replace(4096, 4096, 4096, '\0');
  write_bytes(torn);
  const Outcome got = outcome();
  EXPECT_EQ(got.said, "right");
  EXPECT_NE(got.repair.find("renamed it to catalogue.sqlite.damaged"), std::string::npos)
      << got.repair;
  EXPECT_TRUE(std::filesystem::exists(root_ / "catalogue.sqlite.damaged"));
  EXPECT_EQ(outcome().repair, "");
}

TEST_F(DamagedCatalogue, WhatIsNoDatabaseIsSetAsideOnlyUnderTheNameOfACatalogue) {
  write_bytes("these are notes, and no database\n");
  EXPECT_EQ(outcome().said, "right");
  const std::filesystem::path notes = root_ / "notes.txt";
  std::ofstream(notes) << "these are notes, and no database\n";
  const auto refused = Catalogue::open(notes.string());
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("not a database"), std::string::npos);
  EXPECT_NE(refused.error().message.find("--catalogue"), std::string::npos);
  EXPECT_EQ(std::filesystem::file_size(notes), 33U);
}

}  // namespace
}  // namespace imunoise::catalogue
