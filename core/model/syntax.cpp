#include "core/model/syntax.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>

namespace imunoise {
namespace {

bool is_blank(char c) { return std::isspace(static_cast<unsigned char>(c)) != 0; }
bool is_digit(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }
bool is_of_a_name(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }

// Without blanks around it; what is all blank ends where it ended.
std::string_view without_blanks(std::string_view text) {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

Argument argument_in(std::string_view text) {
  const std::size_t sign = text.find_first_of("=~");
  Argument out{without_blanks(text), without_blanks(text.substr(0, sign)), {}, {}};
  if (sign == std::string_view::npos) return out;
  out.sign = text.substr(sign, 1);
  out.value = without_blanks(text.substr(sign + 1));
  return out;
}

// Recursive descent over the text; every failure names the place.
class Splitter {
 public:
  explicit Splitter(std::string_view text) : text_(text) {}

  Result<std::vector<WrittenTerm>> model() {
    std::vector<WrittenTerm> out;
    do {
      auto one = term();
      if (!one) return tl::unexpected(one.error());
      out.push_back(std::move(*one));
    } while (accept('+'));
    if (at_ < text_.size()) return error("expected '+' and another term, or the end");
    return out;
  }

 private:
  Result<WrittenTerm> term() {
    WrittenTerm out;
    skip_blanks();
    const std::size_t begin = at_;
    if (at_ < text_.size() && is_digit(text_[at_])) {
      const char* const end = text_.data() + text_.size();
      const auto [stop, code] = std::from_chars(text_.data() + at_, end, out.count);
      if (code != std::errc()) return error("expected a whole number of reasonable size");
      if (out.count < 1) return error("a term is counted from 1");
      at_ = static_cast<std::size_t>(stop - text_.data());
      if (!accept('*')) return error("expected '*' between the count and the name");
    }
    skip_blanks();
    const std::size_t name = at_;
    while (at_ < text_.size() && is_of_a_name(text_[at_])) ++at_;
    out.name = text_.substr(name, at_ - name);
    if (accept('(') && !accept(')')) {
      if (auto done = arguments(out.arguments); !done) return tl::unexpected(done.error());
    }
    if (accept('[')) {
      const std::size_t from = at_;
      at_ = std::min(text_.find(']', at_), text_.size());
      out.sharing = without_blanks(text_.substr(from, at_ - from));
      if (!accept(']')) return error("expected ']'");
    }
    out.text = text_.substr(begin, at_ - begin);
    return out;
  }

  Result<void> arguments(std::vector<Argument>& out) {
    do {
      const std::size_t begin = at_;
      skip_argument();
      out.push_back(argument_in(text_.substr(begin, at_ - begin)));
    } while (accept(','));
    if (!accept(')')) return error("expected ',' or ')'");
    return {};
  }

  void skip_argument() {
    int depth = 0;
    for (; at_ < text_.size(); ++at_) {
      const char c = text_[at_];
      if (depth == 0 && (c == ',' || c == ')')) return;
      if (c == '(' || c == '[') ++depth;
      if (c == ')' || c == ']') --depth;
    }
  }

  bool accept(char c) {
    skip_blanks();
    if (at_ >= text_.size() || text_[at_] != c) return false;
    ++at_;
    return true;
  }

  void skip_blanks() {
    while (at_ < text_.size() && is_blank(text_[at_])) ++at_;
  }

  tl::unexpected<Error> error(const std::string& what) const {
    return tl::unexpected(model_error(text_, text_.substr(at_), what));
  }

  std::string_view text_;
  std::size_t at_ = 0;
};

}  // namespace

Result<std::vector<WrittenTerm>> split_model(std::string_view text) {
  return Splitter(text).model();
}

Error model_error(std::string_view text, std::string_view place, const std::string& what) {
  const auto column = static_cast<std::size_t>(place.data() - text.data());
  std::string shown(text);
  for (char& c : shown) c = std::iscntrl(static_cast<unsigned char>(c)) != 0 ? ' ' : c;
  return {fmt::format("model: {}\n  {}\n  {}^", what, shown, std::string(column, ' '))};
}

std::optional<double> number_in(std::string_view text) {
  double out = 0.0;
  const char* const end = text.data() + text.size();
  const auto [stop, code] = std::from_chars(text.data(), end, out);
  if (code != std::errc() || stop != end || !std::isfinite(out)) return std::nullopt;
  return out;
}

}  // namespace imunoise
