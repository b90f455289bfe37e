#include "drivers/emulator/lines/pty.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <thread>

namespace imunoise::emulator {
namespace {

using namespace std::chrono_literals;

// A host that reads late, as on a busy machine, loses nothing of what came before it is unplugged.
TEST(Pty, IsCutOnlyWhenAllIsRead) {
  const auto link =
      std::filesystem::temp_directory_path() / ("imunoise_pty_" + std::to_string(::getpid()));
  std::optional<Pty> line(std::in_place, link);
  const int host = ::open(link.c_str(), O_RDWR | O_NOCTTY | O_CLOEXEC);
  ASSERT_GE(host, 0);
  std::size_t read = 0;
  std::jthread reader([&] {
    std::array<char, 256> bytes{};
    for (std::this_thread::sleep_for(1500ms);;) {
      const ssize_t count = ::read(host, bytes.data(), bytes.size());
      if (count <= 0) return;
      read += static_cast<std::size_t>(count);
    }
  });
  const std::array<std::uint8_t, 1000> sent{};
  line->write(sent);
  line->drain();
  line.reset();
  reader.join();
  ::close(host);
  EXPECT_EQ(read, sent.size());
}

// Only a link that leads nowhere is replaced.
TEST(Pty, LeavesTheFilesOfOthers) {
  std::string pattern = (std::filesystem::temp_directory_path() / "imunoise-XXXXXX").string();
  const std::filesystem::path folder = ::mkdtemp(pattern.data());
  const std::filesystem::path file = folder / "notes.csv";
  std::ofstream(file) << "mine";
  EXPECT_THROW(Pty{file}, std::system_error);
  EXPECT_TRUE(std::filesystem::is_regular_file(file));
  const std::filesystem::path link = folder / "line";
  {
    const Pty first(link);
    EXPECT_THROW(Pty{link}, std::system_error) << "it is in use";
    EXPECT_TRUE(std::filesystem::exists(link)) << "and goes on";
  }
  std::filesystem::create_symlink(folder / "gone", link);
  const Pty again(link);
  EXPECT_TRUE(std::filesystem::exists(link));
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace imunoise::emulator
