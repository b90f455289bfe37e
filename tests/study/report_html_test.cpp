#include <gtest/gtest.h>

#include <set>

#include "study/report/html/fit_page.h"
#include "study/report/view/verdict.h"
#include "tests/study/markup_check.h"
#include "tests/study/sample_report.h"

namespace imunoise::report {
namespace {

v1::FitReports several() {
  v1::FitReports reports;
  for (const v1::FitReport& report : {good_gyro(), misfit_gyro(), bounded_gyro(), accelerometer(),
                                      dense_unknown_unit(), broken_arrays(), hostile_names()}) {
    *reports.add_channels() = report;
  }
  return reports;
}

TEST(HtmlPage, IsWellFormedWithUniqueIds) {
  for (const v1::FitReports& reports : {several(), v1::FitReports{}}) {
    const Markup markup = read_markup(html_page(reports));
    ASSERT_EQ(markup.error, "");
    std::set<std::string> ids;
    for (const Element& element : markup.elements) {
      const auto id = element.attributes.find("id");
      if (id != element.attributes.end()) {
        EXPECT_TRUE(ids.insert(id->second).second) << id->second;
      }
    }
  }
}

TEST(HtmlPage, HostileNamesStayText) {
  const std::string page = html_page(hostile_names());
  EXPECT_EQ(page.find("<script>"), page.rfind("<script>"));  // the page's own
  EXPECT_FALSE(contains(page, "<img"));
  EXPECT_FALSE(contains(page, "<b>"));
  EXPECT_FALSE(contains(page, "\x1b"));
  EXPECT_FALSE(contains(page, "\u202E"));
  EXPECT_TRUE(contains(page, "&lt;img src=x onerror=alert(1)&gt;"));
  for (const Element& element : read_markup(page).elements) {
    EXPECT_FALSE(element.attributes.contains("onerror"));
  }
}

TEST(HtmlPage, NeedsNoNetwork) {
  const std::string page = html_page(several());
  for (const Element& element : read_markup(page).elements) {
    EXPECT_FALSE(element.attributes.contains("src"));
    const auto href = element.attributes.find("href");
    if (href != element.attributes.end()) {
      EXPECT_TRUE(href->second.starts_with("#")) << href->second;
    }
  }
  EXPECT_FALSE(contains(page, "@import"));
  EXPECT_FALSE(contains(page, "fetch("));
}

TEST(HtmlPage, TableHasARowForEveryColumnOfTheFigure) {
  const Markup markup = read_markup(html_page(good_gyro()));
  std::size_t columns = 0;
  bool in_scales = false;
  std::size_t rows = 0;
  for (const Element& element : markup.elements) {
    const auto css = element.attributes.find("class");
    if (css != element.attributes.end() && css->second == "column") ++columns;
    if (element.name == "table")
      in_scales = css != element.attributes.end() && css->second == "scales";
    if (element.name == "tr" && in_scales) ++rows;
  }
  EXPECT_EQ(columns, 2U * 18U);  // desk and phone
  EXPECT_EQ(rows, 1U + 18U);
}

TEST(HtmlPage, SaysWhatToRecord) {
  const std::string page = html_page(bounded_gyro());
  EXPECT_TRUE(contains(page, "below 3.2×10⁻¹⁶"));
  EXPECT_TRUE(contains(page, "record 5.0× longer to see it"));
}

TEST(Verdict, Words) {
  EXPECT_EQ(verdict(good_gyro()), Verdict::kFits);
  EXPECT_EQ(verdict(bounded_gyro()), Verdict::kDoubtful);
  EXPECT_EQ(verdict(misfit_gyro()), Verdict::kFails);
  EXPECT_EQ(verdict(broken_arrays()), Verdict::kUntested);  // its p-value is NaN
  EXPECT_EQ(verdict({}), Verdict::kUntested);
  EXPECT_TRUE(contains(verdict_sentence(misfit_gyro()), "fewer than 1 of 10 000 recordings"));
  const BudgetView view = budget_view(misfit_gyro());
  ASSERT_EQ(misfits(view).size(), 1U);
  EXPECT_TRUE(contains(misfit_words(view, misfits(view)[0]), "from 20 s to 41 s: variance 3"));
}

}  // namespace
}  // namespace imunoise::report
