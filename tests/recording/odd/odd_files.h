#pragma once

// Odd files, each of which the table of docs/importing.md tells in its words.

#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "recording/import/table/options.h"

namespace imunoise::recording::odd {

inline constexpr int kOddRows = 400;  // at 100 Hz

using OddRow = std::function<std::string(int)>;

inline std::string odd_table(const std::string& head, const OddRow& row, int rows = kOddRows) {
  std::string out = head;
  for (int i = 0; i < rows; ++i) out += row(i) + "\n";
  return out;
}

// Times of 100 Hz in s.
inline std::string t(int i) { return fmt::format("{:.2f}", 0.01 * i); }
inline std::string x(int i) { return fmt::format("{:.4f}", 0.01 * std::sin(0.7 * i * i)); }

struct OddFile {
  std::string what;  // as docs/importing.md says it
  std::string gets;
  std::string name;
  std::string content;
  double rate = 100.0;  // 0: refused
  std::size_t channels = 1;
  std::size_t stretches = 1;
  std::size_t used = kOddRows;
  std::string told;  // in what is recognised, found or refused
  ImportOptions options = {};
};

/// A list of odd files that grows.
class OddFiles {
 public:
  OddFile& good(const std::string& what, const std::string& gets, const std::string& content,
                const std::string& told) {
    return all.emplace_back(OddFile{what, gets, "odd.csv", content, 100.0, 1, 1, kOddRows, told});
  }
  OddFile& refused(const std::string& what, const std::string& gets, const std::string& content,
                   const std::string& told) {
    return all.emplace_back(OddFile{what, gets, "odd.csv", content, 0.0, 0, 0, 0, told});
  }

  std::vector<OddFile> all;
};

/// Those with odd times.
std::vector<OddFile> odd_times();

}  // namespace imunoise::recording::odd
