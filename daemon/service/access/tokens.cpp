#include "daemon/service/access/tokens.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <cctype>
#include <fstream>
#include <iterator>
#include <sstream>

namespace imunoise::service {
namespace {

constexpr std::size_t kShortest = 32;
constexpr std::size_t kLongestToken = 256;
constexpr mode_t kTooOpen = S_IRWXO | S_IWGRP;

bool well_formed(std::string_view token) {
  return std::all_of(token.begin(), token.end(), [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 ||
           std::string_view("-._~+/=").find(c) != std::string_view::npos;
  });
}

}  // namespace

bool same_secret(std::string_view a, std::string_view b) {
  if (a.size() != b.size()) return false;
  unsigned differences = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    differences |= static_cast<unsigned>(a[i] ^ b[i]);
  }
  return differences == 0;
}

Result<Tokens> Tokens::parse(std::string_view text) {
  Tokens out;
  std::istringstream lines{std::string(text)};
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    std::istringstream words(line.substr(0, line.find('#')));
    std::string role;
    std::string token;
    if (!(words >> role)) continue;
    words >> token;
    const auto wrong = [&](std::string_view what) {
      return fail(fmt::format("{}: {}", number, what));
    };
    if (role != "viewer" && role != "operator")
      return wrong("begin the line with viewer or operator");
    if (!well_formed(token) || token.size() < kShortest || token.size() > kLongestToken)
      return wrong(
          "a token has 32 to 256 letters, digits and -._~+/=; openssl rand -hex 32 makes one");
    if (out.role_of(token)) return wrong("duplicate token; remove one");
    out.tokens_.push_back({token, role == "viewer" ? v1::viewer : v1::operator_});
  }
  if (out.tokens_.empty()) return fail("1: contains no token; write a line \"viewer TOKEN\"");
  return out;
}

Result<Tokens> Tokens::read(const std::filesystem::path& file) {
  struct stat found {};
  std::ifstream in(file);
  if (!in || ::stat(file.c_str(), &found) != 0)
    return fail(file.string() + ": cannot be read; check the path and its permissions");
  if ((found.st_mode & kTooOpen) != 0)
    return fail(file.string() + ": other users can read it, or its group can write it; chmod 640 " +
                file.string());
  const std::string text(std::istreambuf_iterator<char>(in), {});
  auto out = parse(text);
  if (!out) return fail(file.string() + ":" + out.error().message);
  return out;
}

std::optional<v1::Role> Tokens::role_of(std::string_view token) const {
  std::optional<v1::Role> out;
  for (const Token& one : tokens_) {
    if (same_secret(one.text, token)) out = one.role;
  }
  return out;
}

std::optional<std::string_view> bearer_token(std::string_view authorization) {
  constexpr std::string_view kScheme = "bearer ";
  if (authorization.size() < kScheme.size() ||
      !std::equal(kScheme.begin(), kScheme.end(), authorization.begin(), [](char a, char b) {
        return a == std::tolower(static_cast<unsigned char>(b));
      })) {
    return std::nullopt;
  }
  return authorization.substr(kScheme.size());
}

}  // namespace imunoise::service
