// Files of every format with bytes changed, cut out, repeated: an error that names the file, or
// finite numbers. Never a crash, a hang, or much memory.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <random>
#include <string>

#include "tests/recording/files.h"

namespace imunoise::recording {
namespace {

std::string mutated(std::string bytes, std::mt19937& random) {
  const auto below = [&](std::size_t count) {
    return std::uniform_int_distribution<std::size_t>(0, count - 1)(random);
  };
  for (std::size_t k = 1 + below(4); k > 0; --k) {
    const std::size_t at = below(bytes.size());
    switch (below(4)) {
      case 0:
        bytes[at] = static_cast<char>(below(256));
        break;
      case 1:
        bytes[at] = static_cast<char>(bytes[at] ^ (1 << below(8)));
        break;
      case 2:
        bytes.erase(at, below(16));
        if (bytes.empty()) bytes = "x";
        break;
      default:
        bytes.insert(at, bytes.substr(below(bytes.size()), below(32)));
    }
  }
  return bytes;
}

class Mutants : public FileTest {
 protected:
  void expect_sound(const std::string& original, const std::string& name, int count) const {
    constexpr unsigned seed = 20261124;
    std::mt19937 random(seed);
    const std::string bytes = bytes_in(original);
    for (int i = 0; i < count; ++i) {
      const auto file = write(name, mutated(bytes, random));
      const auto got = import_one(file);
      if (!got) {
        EXPECT_NE(got.error().message.find(file.parent_path().string()), std::string::npos)
            << got.error().message;
        continue;
      }
      for (const Replicate& one : *got) {
        for (const Channel& channel : one.channels) {
          for (std::size_t s = 0; s < channel.count; ++s)
            ASSERT_TRUE(std::isfinite(channel.signal().value(s))) << "seed " << seed << " " << i;
        }
      }
    }
  }
  std::string written(const std::string& script, const std::string& kind,
                      const std::string& name) const {
    const std::string file = path(name).string();
    const std::string command = "/usr/bin/python3 " IMUNOISE_SOURCE_DIR "/tests/recording/" +
                                script + " " + kind + " " + file + " 2> /dev/null";
    return std::system(command.c_str()) == 0 ? file : "";
  }
};

TEST_F(Mutants, OfMatlab) {
  for (const std::string kind : {"matlab5", "matlab5-packed", "matlab5-struct"}) {
    const std::string file = written("write_arrays.py", kind, "a.mat");
    if (file.empty()) GTEST_SKIP() << "no SciPy here";
    expect_sound(file, "b.mat", 700);
  }
}

TEST_F(Mutants, OfArchives) {
  for (const std::string kind : {"npz", "npz-packed", "npz-odd"}) {
    const std::string file = written("write_arrays.py", kind, "a.npz");
    if (file.empty()) GTEST_SKIP() << "no NumPy here";
    expect_sound(file, "b.npz", 700);
  }
}

TEST_F(Mutants, OfUlog) {
  for (const std::string kind : {"fifo", "increments"})
    expect_sound(written("write_ulog.py", kind, "a.ulg"), "b.ulg", 300);
}

TEST_F(Mutants, OfPackedFiles) {
  std::string text = "t,x\n";
  for (int i = 0; i < 200; ++i)
    text += std::to_string(i * 10) + "," + std::to_string(i * i % 977) + "\n";
  const auto plain = write("a.csv", text);
  for (const std::string program : {"gzip", "bzip2", "zstd", "lz4"}) {
    const std::string file = path("a.csv." + program).string();
    const std::string command = program + " < " + plain.string() + " > " + file;
    if (std::system((command + " 2> /dev/null").c_str()) != 0)
      GTEST_SKIP() << "no " << program << " here";
    expect_sound(file, "b.csv", 500);
  }
}

}  // namespace
}  // namespace imunoise::recording
