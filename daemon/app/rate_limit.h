#pragma once

// So that no device floods a log that is to be read in months.

#include <chrono>
#include <cstddef>
#include <map>
#include <optional>
#include <string>

namespace imunoise::app {

/// Each source may say so many lines in a while; what is more is counted. Not thread-safe.
class RateLimit {
 public:
  using Time = std::chrono::steady_clock::time_point;

  RateLimit(std::size_t lines, std::chrono::seconds window) : lines_(lines), window_(window) {}

  /// How many lines of the source were left out before this one; nothing: this one is left out.
  std::optional<std::size_t> pass(const std::string& source, Time now);

 private:
  struct Source {
    Time begin;
    std::size_t said = 0;
    std::size_t left_out = 0;
  };

  std::size_t lines_;
  std::chrono::seconds window_;
  std::map<std::string, Source> sources_;
};

}  // namespace imunoise::app
