#pragma once

// Who may do what over TCP: bearer tokens with roles.

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/support/result.h"
#include "imunoise/v1/http.pb.h"

namespace imunoise::service {

/// Thread-safe.
class Tokens {
 public:
  /// Lines "viewer TOKEN" and "operator TOKEN", anything after them being for people; '#' begins a
  /// comment. A token has 32 to 256 letters, digits and -._~+/= (RFC 6750). Errors give the line
  /// and never the token: another role, a token that is none or too short, or comes twice; no
  /// token at all.
  static Result<Tokens> parse(std::string_view text);
  /// Error: also a file that others than its owner and group may read, or its group write.
  static Result<Tokens> read(const std::filesystem::path& file);

  /// Takes the same time for all texts of one length.
  std::optional<v1::Role> role_of(std::string_view token) const;

 private:
  struct Token {
    std::string text;
    v1::Role role;
  };
  std::vector<Token> tokens_;
};

/// Whether two texts are equal; looks at every byte, whatever the first ones say.
bool same_secret(std::string_view a, std::string_view b);

/// The token of "Bearer TOKEN"; nothing where the header says something else.
std::optional<std::string_view> bearer_token(std::string_view authorization);

}  // namespace imunoise::service
