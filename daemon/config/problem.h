#pragma once

// What is wrong with a file of settings, and where.

#include <cstdint>
#include <string>
#include <vector>

namespace imunoise::config {

/// Both from 1; a column counts characters as toml++ does.
struct Place {
  std::uint32_t line = 1;
  std::uint32_t column = 1;
};

struct Problem {
  Place place;
  std::string key;      ///< As "schedule.every"; empty where it is none.
  std::string message;  ///< What is wrong, and what would be right.
};

/// "config/array.toml:12:5: schedule.every: ..."
std::string describe(const std::string& file, const Problem& problem);

}  // namespace imunoise::config
