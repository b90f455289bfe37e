#include "tests/layering/plain_english.h"

#include <gtest/gtest.h>

namespace imunoise::testing {
namespace {

TEST(PlainEnglish, GuidesAndMessagesHaveNoRiddles) {
  const Tree prose = read_prose(IMUNOISE_SOURCE_DIR);
  ASSERT_TRUE(prose.contains("docs/campaigns.md"));
  ASSERT_TRUE(prose.contains("cli/commands/study_command.cpp"));
  for (const std::string& found : riddles(prose)) ADD_FAILURE() << found;
}

TEST(PlainEnglish, GuidesBeginWithAHeading) {
  for (const std::string& found : without_heading(read_prose(IMUNOISE_SOURCE_DIR)))
    ADD_FAILURE() << found << ": the first line is no heading";
}

TEST(PlainEnglish, FindsAGuideThatWasFormattedAsCode) {
  Tree prose;
  prose["docs/good.md"] = "# docs/good\n";
  prose["docs/bad.md"] = "#docs / bad\n";
  prose["core/a.cpp"] = "";
  EXPECT_EQ(without_heading(prose), std::vector<std::string>{"docs/bad.md"});
}

TEST(PlainEnglish, ReadsNeitherCodeNorComments) {
  const std::string text = quoted_only("f(\"one\", nobody);  // \"two\"\ng('\"', \"three\");\n");
  EXPECT_EQ(text.find("nobody"), std::string::npos) << text;
  EXPECT_EQ(text.find("two"), std::string::npos) << text;
  EXPECT_NE(text.find("one"), std::string::npos) << text;
  EXPECT_NE(text.find("\n three "), std::string::npos) << text;
}

TEST(PlainEnglish, NamesTheLineAndTheRemedy) {
  Tree prose;
  prose["docs/a.md"] = "Degrees of freedom are fine.\nWhoever reads it, has\n5 freedoms.\n";
  const std::vector<std::string> found = riddles(prose);
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0], "docs/a.md:2: 'Whoever': say who does it");
  EXPECT_EQ(found[1], "docs/a.md:3: 'freedoms': degrees of freedom");
}

}  // namespace
}  // namespace imunoise::testing
