// A file as a heap: what is in it stays, wherever it lies at the moment.

#include "recording/scratch/scratch_file.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <csignal>
#include <cstring>
#include <random>
#include <span>
#include <vector>

namespace imunoise::recording {
namespace {

constexpr std::size_t kPieceMiB = std::size_t{1} << 20U;

class ScratchFileTest : public testing::Test {
 protected:
  ScratchFileTest() {
    const auto descriptor = ScratchFile::create(std::filesystem::temp_directory_path());
    EXPECT_TRUE(descriptor);
    file_.emplace(*descriptor, 256 * kPieceMiB);
  }

  std::span<char> take(std::size_t bytes) {
    auto* const at = static_cast<char*>(file_->take(bytes));
    EXPECT_NE(at, nullptr);
    EXPECT_GE(file_->size_of(at), bytes);
    return {at, bytes};
  }

  std::optional<ScratchFile> file_;
};

TEST_F(ScratchFileTest, PiecesKeepWhatIsInThemAndDoNotMeet) {
  struct Held {
    std::span<char> bytes;
    char content;
  };
  std::vector<Held> held;
  std::mt19937 random(5);
  for (int step = 0; step < 400; ++step) {
    if (held.size() < 12 || random() % 2 == 0) {
      if (held.size() == 30) continue;
      const std::span<char> bytes = take(1 + random() % (4 * kPieceMiB));
      held.push_back({bytes, static_cast<char>(step)});
      std::memset(bytes.data(), held.back().content, bytes.size());
    } else {
      std::swap(held[random() % held.size()], held.back());
      file_->give_back(held.back().bytes.data());
      held.pop_back();
    }
    if (step % 50 == 0) file_->shrink(0);
    for (const Held& one : held)
      ASSERT_TRUE(one.bytes.front() == one.content && one.bytes.back() == one.content) << step;
  }
  for (const Held& one : held) {
    ASSERT_TRUE(std::all_of(one.bytes.begin(), one.bytes.end(),
                            [&](char byte) { return byte == one.content; }));
    EXPECT_TRUE(file_->holds(one.bytes.data()));
  }
  EXPECT_FALSE(file_->holds(&held));
}

TEST_F(ScratchFileTest, RoomIsUsedAgain) {
  const std::span<char> first = take(8 * kPieceMiB);
  const std::span<char> second = take(8 * kPieceMiB);
  take(kPieceMiB);
  file_->give_back(first.data());
  file_->give_back(second.data());
  EXPECT_EQ(take(16 * kPieceMiB).data(), first.data());  // the two were joined
}

TEST_F(ScratchFileTest, MoreThanItMayHoldIsRefused) {
  EXPECT_EQ(file_->take(257 * kPieceMiB), nullptr);
  EXPECT_NE(file_->take(255 * kPieceMiB), nullptr);
  EXPECT_EQ(file_->take(2 * kPieceMiB), nullptr);
}

// A full disk, as far as this process is concerned.
TEST_F(ScratchFileTest, WithoutRoomOnTheDiskThereIsNoPiece) {
  take(kPieceMiB);
  std::signal(SIGXFSZ, SIG_IGN);
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  const rlimit small{4 * kPieceMiB, before.rlim_max};
  setrlimit(RLIMIT_FSIZE, &small);
  void* const refused = file_->take(8 * kPieceMiB);
  void* const fits = file_->take(2 * kPieceMiB);
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, SIG_DFL);
  EXPECT_EQ(refused, nullptr);
  ASSERT_NE(fits, nullptr);
  std::memset(fits, 1, 2 * kPieceMiB);
}

TEST(ScratchFile, AFolderWhereNoFileCanBeIsNone) {
  EXPECT_FALSE(ScratchFile::create("/proc/none/here"));
}

}  // namespace
}  // namespace imunoise::recording
