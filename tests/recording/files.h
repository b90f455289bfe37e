#pragma once

// What the tests of import and export share: a folder of their own, files in it, importing one.

#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>
#include <vector>

#include "recording/import/import.h"

namespace imunoise::recording {

/// Gives each test an empty folder and removes it afterwards.
class FileTest : public testing::Test {
 protected:
  FileTest() {
    std::string pattern = (std::filesystem::temp_directory_path() / "imunoise-XXXXXX").string();
    folder_ = ::mkdtemp(pattern.data());
  }
  ~FileTest() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path path(std::string_view name) const { return folder_ / name; }
  std::filesystem::path write(std::string_view name, std::string_view bytes) const {
    std::ofstream(path(name), std::ios::binary) << bytes;
    return path(name);
  }

 private:
  std::filesystem::path folder_;
};

inline Result<std::vector<Replicate>> import_one(const std::filesystem::path& path,
                                                 const ImportOptions& options = {}) {
  const std::vector<std::filesystem::path> paths = {path};
  return import_files(paths, options);
}

inline std::string bytes_in(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// Options that only state the rate.
inline ImportOptions at_rate(double hertz) {
  ImportOptions options;
  options.rate = Hertz{hertz};
  return options;
}

/// The message of a failed import of `path`; what was read instead when it did not fail.
inline std::string error_of(const std::filesystem::path& path, const ImportOptions& options = {}) {
  const auto imported = import_one(path, options);
  return imported ? "no error" : imported.error().message;
}

/// `rows` times the same line, for files whose other lines matter.
inline std::string repeated(std::string_view line, int rows = 20) {
  std::string out;
  for (int i = 0; i < rows; ++i) out += line;
  return out;
}

/// The bytes of numbers as they lie in memory.
template <class Number>
std::string bytes_of(const std::vector<Number>& numbers) {
  std::string out(numbers.size() * sizeof(Number), '\0');
  std::memcpy(out.data(), numbers.data(), out.size());
  return out;
}

/// A .npy file of version `major`.0 with this dictionary.
inline std::string npy(std::string dictionary, std::string_view numbers, int major = 1) {
  dictionary += '\n';
  std::string out = "\x93NUMPY";
  out += static_cast<char>(major);
  out += '\0';
  for (int i = 0; i < (major == 1 ? 2 : 4); ++i) {
    out += static_cast<char>(dictionary.size() >> (8 * i) & 0xff);
  }
  return out + dictionary + std::string(numbers);
}

inline void expect_parts(const std::string& message, const std::vector<std::string>& parts) {
  for (const std::string& part : parts) {
    EXPECT_NE(message.find(part), std::string::npos) << "'" << part << "' is not in: " << message;
  }
}

inline std::vector<double> stored_doubles(const Channel& channel) {
  return std::get<std::vector<double>>(*channel.samples);
}

}  // namespace imunoise::recording
