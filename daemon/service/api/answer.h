#pragma once

// What a method of the API comes to.

#include <string>
#include <tl/expected.hpp>
#include <utility>

namespace imunoise::service {

/// Why a request is not done: a status of HTTP, and a sentence that says the way out.
struct Problem {
  unsigned status = 500;
  std::string sentence;
};

template <class T>
using Answer = tl::expected<T, Problem>;

inline tl::unexpected<Problem> refuse(unsigned status, std::string sentence) {
  return tl::unexpected<Problem>(Problem{status, std::move(sentence)});
}

}  // namespace imunoise::service
