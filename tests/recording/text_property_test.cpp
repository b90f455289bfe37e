// Any table of doubles, written as text in any dialect, comes back bit for bit.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <bit>
#include <random>

#include "recording/import/text/text_table.h"
#include "tests/recording/files.h"

namespace imunoise::recording {
namespace {

class TextProperty : public FileTest {};

// Any finite double, denormals and the largest included.
double any_double(std::mt19937_64& random) {
  while (true) {
    const double value = std::bit_cast<double>(random());
    if (std::isfinite(value)) return value;
  }
}

TEST_F(TextProperty, TablesComeBackBitForBit) {
  constexpr std::uint64_t seed = 20240607;
  std::mt19937_64 random(seed);
  const auto below = [&](std::size_t n) { return static_cast<std::size_t>(random() % n); };
  for (int trial = 0; trial < 300; ++trial) {
    const std::size_t columns = 1 + below(5);
    const std::size_t rows = 5 + below(60);
    const char delimiter = ",;\t "[below(4)];
    const char* const endings[] = {"\n", "\r\n", "\r"};
    const std::string ending = endings[below(3)];
    const bool header = below(2) == 0;
    std::vector<std::vector<double>> table(columns);
    std::string text = below(4) == 0 ? "\xef\xbb\xbf" : "";
    if (header) {
      for (std::size_t c = 0; c < columns; ++c) {
        text += fmt::format("{}name{} [g]", c == 0 ? "" : std::string(1, delimiter), c);
      }
      text += ending;
    }
    for (std::size_t r = 0; r < rows; ++r) {
      for (std::size_t c = 0; c < columns; ++c) {
        table[c].push_back(any_double(random));
        if (c > 0) text += delimiter;
        if (below(6) == 0) text += ' ';
        const char* const format[] = {"{}", "{:.16e}", "{:.17g}", "\"{}\""};
        text += fmt::format(fmt::runtime(format[below(4)]), table[c].back());
      }
      if (r + 1 < rows || below(2) == 0) text += ending;
      if (below(20) == 0 && text.ends_with(ending))
        text += "# a comment, with; delimiters" + ending;
    }
    const Progress progress;
    std::atomic<double> done = 0.0;
    FileProgress file_progress(progress, done, 1);
    const auto got =
        read_text_table(write("t.csv", text), at_rate(100), file_progress, 1 + below(300));
    ASSERT_TRUE(got) << "seed " << seed << " trial " << trial << ": " << got.error().message;
    ASSERT_EQ(got->columns.size(), columns) << "trial " << trial << "\n" << text;
    for (std::size_t c = 0; c < columns; ++c) {
      const auto& values = std::get<std::vector<double>>(got->columns[c].samples);
      ASSERT_EQ(values.size(), rows) << "trial " << trial;
      EXPECT_EQ(std::memcmp(values.data(), table[c].data(), rows * sizeof(double)), 0)
          << "seed " << seed << " trial " << trial << " column " << c;
      EXPECT_EQ(got->columns[c].unit, header ? "g" : "");
    }
  }
}

}  // namespace
}  // namespace imunoise::recording
