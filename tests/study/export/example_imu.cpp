#include "tests/study/export/example_imu.h"

#include <cctype>
#include <cstdlib>
#include <sstream>

namespace imunoise::testing {
namespace {

bool is_comment(const std::string& line) {
  const std::size_t first = line.find_first_not_of(' ');
  return first == std::string::npos || line[first] == '#' || line[first] == '%' ||
         line.compare(first, 2, "//") == 0;
}

bool in_word(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }

}  // namespace

std::vector<double> numbers_of(const std::string& file, const std::string& key) {
  std::istringstream lines(file);
  std::vector<double> out;
  bool inside_comment = false;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("<!--") || line.ends_with("\"comment\": [")) inside_comment = true;
    if (line.starts_with("-->") || line.ends_with("],")) inside_comment = false;
    if (inside_comment || is_comment(line)) continue;
    std::size_t at = line.find(key);
    if (at == std::string::npos || in_word(line[at + key.size()])) continue;
    if (at > 0 && in_word(line[at - 1])) continue;
    at += key.size();
    const std::size_t end = std::min(line.find_first_of("#%;", at), line.size());
    while (at < end) {
      char* stop = nullptr;
      const double value = std::strtod(line.c_str() + at, &stop);
      const auto next = static_cast<std::size_t>(stop - line.c_str());
      if (next > at) out.push_back(value);
      at = next > at ? next : at + 1;
    }
    return out;
  }
  return out;
}

}  // namespace imunoise::testing
