#pragma once

// The program as a user runs it: in an empty folder, through the shell.

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

namespace imunoise::testing {

struct Outcome {
  int status;
  std::string out;     // standard output
  std::string errors;  // standard error
};

class Program : public ::testing::Test {
 protected:
  Program()
      : folder_(std::filesystem::temp_directory_path() /
                ("imunoise_cli_" + std::to_string(getpid()))) {
    std::filesystem::create_directories(folder_);
  }
  ~Program() override { std::filesystem::remove_all(folder_); }

  Outcome run(const std::string& arguments) const {
    const std::string errors = (folder_ / "stderr").string();
    const std::string command =
        "cd '" + folder_.string() + "' && '" IMUNOISE_BINARY "' " + arguments + " 2>" + errors;
    std::FILE* const pipe = popen(command.c_str(), "r");
    Outcome out{};
    std::array<char, 4096> buffer{};
    for (std::size_t n = 0; (n = std::fread(buffer.data(), 1, buffer.size(), pipe)) > 0;) {
      out.out.append(buffer.data(), n);
    }
    out.status = WEXITSTATUS(pclose(pipe));
    out.errors = read("stderr");
    return out;
  }

  std::string read(const std::string& name) const {
    std::ifstream file(folder_ / name);
    return {std::istreambuf_iterator<char>(file), {}};
  }

  std::filesystem::path folder_;
};

}  // namespace imunoise::testing
