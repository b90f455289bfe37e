#pragma once

// Reference numbers and recordings that live beside the project, not in it. Tests that use them
// skip, loudly, when they are absent.

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace imunoise::testing {

inline std::filesystem::path shared(const std::string& name) {
  return std::filesystem::path(IMUNOISE_SHARED_DIR) / name;
}

inline nlohmann::json read_json(const std::string& name) {
  std::ifstream file(shared(name));
  return nlohmann::json::parse(file);
}

inline std::vector<double> read_doubles(const std::string& name) {
  std::ifstream file(shared(name), std::ios::binary | std::ios::ate);
  std::vector<double> out(static_cast<std::size_t>(file.tellg()) / sizeof(double));
  file.seekg(0);
  file.read(reinterpret_cast<char*>(out.data()),
            static_cast<std::streamsize>(out.size() * sizeof(double)));
  return out;
}

}  // namespace imunoise::testing

/// Ends the test as skipped, naming what is missing.
#define IMUNOISE_NEEDS(name)                                                        \
  if (!std::filesystem::exists(imunoise::testing::shared(name))) {                  \
    GTEST_SKIP() << "SKIPPED: " << imunoise::testing::shared(name) << " is absent"; \
  }
