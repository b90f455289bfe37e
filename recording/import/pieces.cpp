#include "recording/import/pieces.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <string>
#include <string_view>
#include <system_error>

namespace imunoise::recording {
namespace {

bool is_piece(const std::filesystem::path& path) {
  constexpr std::array endings = {".mcap", ".db3", ".mcap.zstd", ".db3.zstd"};
  const std::string name = path.filename().string();
  return std::any_of(endings.begin(), endings.end(),
                     [&](const char* ending) { return name.ends_with(ending); });
}

bool is_digit(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }

// Numbers within names count as numbers.
bool before(const std::string& a, const std::string& b) {
  std::size_t i = 0;
  std::size_t j = 0;
  while (i < a.size() && j < b.size()) {
    if (!is_digit(a[i]) || !is_digit(b[j])) {
      if (a[i] != b[j]) return a[i] < b[j];
      ++i;
      ++j;
      continue;
    }
    const auto number = [](const std::string& text, std::size_t& at) {
      while (at + 1 < text.size() && text[at] == '0' && is_digit(text[at + 1])) ++at;
      const std::size_t begin = at;
      while (at < text.size() && is_digit(text[at])) ++at;
      return std::string_view(text).substr(begin, at - begin);
    };
    const std::string_view x = number(a, i);
    const std::string_view y = number(b, j);
    if (x.size() != y.size()) return x.size() < y.size();
    if (x != y) return x < y;
  }
  return a.size() - i < b.size() - j;
}

}  // namespace

std::vector<std::filesystem::path> pieces_of(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> out;
  std::error_code wrong;
  for (std::filesystem::directory_iterator at(folder, wrong), end; !wrong && at != end;
       at.increment(wrong)) {
    std::error_code unknown;
    if (at->is_regular_file(unknown) && is_piece(at->path())) out.push_back(at->path());
  }
  std::sort(out.begin(), out.end(), [](const auto& a, const auto& b) {
    return before(a.filename().string(), b.filename().string());
  });
  return out;
}

}  // namespace imunoise::recording
