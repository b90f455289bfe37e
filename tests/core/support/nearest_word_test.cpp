#include "core/support/nearest_word.h"

#include <gtest/gtest.h>

#include <vector>

namespace imunoise {
namespace {

const std::vector<std::string> kKnown = {"wv", "fit", "calibrate", "diagnose", "calibrations"};

TEST(NearestWord, CountsChangedAddedMissingAndSwappedLetters) {
  EXPECT_EQ(nearest_word("fti", kKnown), "fit");
  EXPECT_EQ(nearest_word("Fits", kKnown), "fit");
  EXPECT_EQ(nearest_word("calibarte", kKnown), "calibrate");
  EXPECT_EQ(nearest_word("clibration", kKnown), "calibrations");
  EXPECT_EQ(nearest_word("diagonse", kKnown), "diagnose");
}

TEST(NearestWord, TakesABeginningWhenNothingIsNearer) {
  EXPECT_EQ(nearest_word("cal", kKnown), "calibrate");
  EXPECT_EQ(nearest_word("ca", kKnown), "");
  EXPECT_EQ(nearest_word("diagn", kKnown), "diagnose");
}

TEST(NearestWord, IsSilentWhereNothingIsNear) {
  EXPECT_EQ(nearest_word("export", kKnown), "");
  EXPECT_EQ(nearest_word("", kKnown), "");
  EXPECT_EQ(nearest_word(std::string(65, 'f'), kKnown), "");
  EXPECT_EQ(nearest_word("fit", {}), "");
  EXPECT_EQ(did_you_mean("zzz", kKnown), "");
  EXPECT_EQ(did_you_mean("fot", kKnown), "did you mean 'fit'?");
}

}  // namespace
}  // namespace imunoise
