#pragma once

// Errors of files, devices and user input travel as values: Result<T> is either a T or an Error.

#include <string>
#include <tl/expected.hpp>
#include <utility>

namespace imunoise {

/// What went wrong, where, and the way out, in one readable message.
struct Error {
  std::string message;
};

/// Either a value or an Error. Unlike tl::expected it warns when ignored.
template <class T>
class [[nodiscard]] Result : public tl::expected<T, Error> {
 public:
  using tl::expected<T, Error>::expected;
  // NOLINTNEXTLINE(google-explicit-constructor): results of map() and and_then() convert silently.
  Result(tl::expected<T, Error> other) : tl::expected<T, Error>(std::move(other)) {}
};

/// The failing Result: `return fail("file.csv: row 7: ...")`.
inline tl::unexpected<Error> fail(std::string message) {
  return tl::unexpected<Error>(Error{std::move(message)});
}

}  // namespace imunoise
