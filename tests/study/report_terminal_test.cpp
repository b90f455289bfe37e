#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

#include "study/figure/canvas.h"
#include "study/report/terminal/fit_text.h"
#include "study/report/terminal/table.h"
#include "study/words/text.h"
#include "tests/study/sample_report.h"

namespace imunoise::report {
namespace {

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> out;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) out.push_back(line);
  return out;
}

std::string without_colour(std::string text) {
  for (auto at = text.find("\x1b["); at != std::string::npos; at = text.find("\x1b[")) {
    text.erase(at, text.find('m', at) - at + 1);
  }
  return text;
}

TEST(Terminal, NoLineIsWiderThanTheTerminal) {
  for (const int width : {40, 61, 80, 120, 200}) {
    for (const bool unicode : {true, false}) {
      for (const bool colour : {true, false}) {
        const TerminalStyle style{width, colour, unicode};
        std::vector<std::string> texts = {wv_text(measured_gyro(), style), wv_text({}, style)};
        for (const v1::FitReport& report :
             {good_gyro(), misfit_gyro(), bounded_gyro(), accelerometer(), dense_unknown_unit(),
              hostile_names(), broken_arrays(), v1::FitReport{}}) {
          texts.push_back(fit_text(report, style));
        }
        for (const std::string& text : texts) {
          for (const std::string& line : lines_of(without_colour(text))) {
            EXPECT_LE(display_width(line), static_cast<std::size_t>(width)) << line;
          }
        }
      }
    }
  }
}

TEST(Terminal, WithoutUnicodeAllIsAscii) {
  for (const v1::FitReport& report : {misfit_gyro(), hostile_names(), bounded_gyro()}) {
    const std::string text = fit_text(report, {80, false, false});
    EXPECT_TRUE(std::all_of(text.begin(), text.end(),
                            [](char c) { return c == '\n' || (c >= ' ' && c <= '~'); }));
  }
  EXPECT_NE(fit_text(good_gyro(), {80, false, false}).find("deg/sqrt(h)"), std::string::npos);
}

TEST(Terminal, NamesCannotSendEscapeSequences) {
  EXPECT_EQ(fit_text(hostile_names(), {80, false, true}).find('\x1b'), std::string::npos);
  const std::string coloured = fit_text(hostile_names(), {80, true, true});
  EXPECT_EQ(without_colour(coloured).find('\x1b'), std::string::npos);
}

TEST(Terminal, ShowsEveryTestedMisfit) {
  const std::string text = fit_text(misfit_gyro(), {100, false, true});
  std::size_t marks = 0;
  for (auto at = text.find("◆"); at != std::string::npos; at = text.find("◆", at + 1)) ++marks;
  EXPECT_EQ(marks, 2U + 1U);  // two scales and the key
  EXPECT_EQ(std::count(text.begin(), text.end(), '#'), 2 + 1)
      << "both beyond 9 standard deviations";
}

TEST(Terminal, EmptyReportsSaySo) {
  EXPECT_NE(fit_text({}, {}).find("nothing to draw"), std::string::npos);
  EXPECT_NE(wv_text({}, {}).find("nothing to draw"), std::string::npos);
}

TEST(TerminalCanvas, DotsFollowUnicodesNumbering) {
  figure::TerminalCanvas canvas(2, 1, {});
  canvas.line(0, 0, 0, 0);
  canvas.line(3, 3, 3, 3);
  EXPECT_EQ(canvas.lines().at(0), "⠁⢀");
  canvas.mark(0, 0, "●", Ink::kMeasured);
  EXPECT_EQ(canvas.lines().at(0), "●⢀");
  canvas.mark(9, 9, "x", Ink::kAlarm);  // outside: passed over
  EXPECT_EQ(canvas.lines().size(), 1U);
}

TEST(TerminalTable, CellsContinueBelowThemselves) {
  const std::string table =
      terminal_table({"a", "b"}, {{"x", "one two three four five six seven"}}, {40, false, true});
  EXPECT_EQ(table, "  a  b\n  x  one two three four five six seven\n");
  const std::string narrow =
      terminal_table({"a", "b"}, {{"1.1e-9 (0.9e-9 … 1.2e-9)", "one two three four"}, {"y", "z"}},
                     {40, false, true});
  EXPECT_EQ(narrow,
            "  a                     b\n"
            "  1.1e-9 (0.9e-9 …      one two three\n"
            "  1.2e-9)               four\n"
            "  y                     z\n");
}

TEST(TerminalTable, WordsThatAreTooLongAreCutWhereTheyHaveJoints) {
  EXPECT_EQ(terminal_table({"effect", "b"}, {{"replicate_change", "a_word_of_twenty_four_x"}},
                           {34, false, true}),
            "  effect          b\n"
            "  replicate_      a_word_of_\n"
            "  change          twenty_four_x\n");
}

}  // namespace
}  // namespace imunoise::report
