// The header of a .npy file is a Python dictionary: {'descr': '<f8', 'fortran_order': False,
// 'shape': (1000, 3), }. This reads exactly that and nothing more of Python.

#include <charconv>
#include <optional>

#include "recording/import/binary/npy.h"

namespace imunoise::recording {
namespace {

class Scanner {
 public:
  explicit Scanner(std::string_view text) : text_(text) {}

  // True, and past it, when `token` comes next.
  bool take(std::string_view token) {
    skip_blanks();
    if (!text_.starts_with(token)) return false;
    text_.remove_prefix(token.size());
    return true;
  }
  bool at_end() {
    skip_blanks();
    return text_.empty();
  }
  std::optional<std::string> string() {
    skip_blanks();
    if (text_.empty() || (text_.front() != '\'' && text_.front() != '"')) return std::nullopt;
    const std::size_t close = text_.find(text_.front(), 1);
    if (close == std::string_view::npos) return std::nullopt;
    std::string out(text_.substr(1, close - 1));
    text_.remove_prefix(close + 1);
    return out;
  }
  std::optional<std::uint64_t> integer() {
    skip_blanks();
    std::uint64_t value = 0;
    const auto [stop, error] = std::from_chars(text_.data(), text_.data() + text_.size(), value);
    if (error != std::errc{}) return std::nullopt;
    text_.remove_prefix(static_cast<std::size_t>(stop - text_.data()));
    take("L");  // Python 2 wrote long integers so
    return value;
  }

 private:
  void skip_blanks() {
    while (!text_.empty() && (text_.front() == ' ' || text_.front() == '\n'))
      text_.remove_prefix(1);
  }
  std::string_view text_;
};

bool read_shape(Scanner& scanner, std::vector<std::uint64_t>& shape) {
  if (!scanner.take("(")) return false;
  while (!scanner.take(")")) {
    const std::optional<std::uint64_t> extent = scanner.integer();
    if (!extent || shape.size() == 32) return false;  // NumPy's own limit of dimensions
    shape.push_back(*extent);
    if (!scanner.take(",")) return scanner.take(")");
  }
  return true;
}

}  // namespace

Result<NpyHeader> parse_npy_header(std::string_view text) {
  const auto broken = [] {
    return fail("the .npy header cannot be read; write the file again with numpy.save");
  };
  Scanner scanner(text);
  NpyHeader header;
  bool descr = false;
  bool order = false;
  bool shape = false;
  if (!scanner.take("{")) return broken();
  while (!scanner.take("}")) {
    const std::optional<std::string> key = scanner.string();
    if (!key || !scanner.take(":")) return broken();
    if (*key == "descr" && !descr) {
      if (scanner.take("[")) {
        return fail("the array has named fields; save each channel, or an array of one type");
      }
      const std::optional<std::string> dtype = scanner.string();
      if (!dtype) return broken();
      header.dtype = *dtype;
      descr = true;
    } else if (*key == "fortran_order" && !order) {
      header.fortran_order = scanner.take("True");
      if (!header.fortran_order && !scanner.take("False")) return broken();
      order = true;
    } else if (*key == "shape" && !shape) {
      if (!read_shape(scanner, header.shape)) return broken();
      shape = true;
    } else {
      return broken();
    }
    if (!scanner.take(",")) {
      if (!scanner.take("}")) return broken();
      break;
    }
  }
  if (!descr || !order || !shape || !scanner.at_end()) return broken();
  return header;
}

}  // namespace imunoise::recording
