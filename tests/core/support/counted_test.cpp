#include "core/support/counted.h"

#include <gtest/gtest.h>

namespace imunoise {
namespace {

TEST(Counted, OneIsSingularAndNothingIsMany) {
  EXPECT_EQ(counted(0, "sample"), "0 samples");
  EXPECT_EQ(counted(1, "sample"), "1 sample");
  EXPECT_EQ(counted(2U, "other message"), "2 other messages");
  EXPECT_EQ(counted(1L, "stretch"), "1 stretch");
  EXPECT_EQ(counted(3L, "stretch"), "3 stretches");
  EXPECT_EQ(plural(1, "chunk"), "chunk");
}

}  // namespace
}  // namespace imunoise
