#include "recording/scratch/scratch_file.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cstdlib>
#include <functional>
#include <iterator>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

namespace imunoise::recording {
namespace {

constexpr std::size_t kUnit = std::size_t{64} << 10U;       // pieces are multiples of it
constexpr std::size_t kZeros = std::size_t{256} << 10U;     // bytes written at once
constexpr std::size_t kMostGaps = std::size_t{512} << 20U;  // bytes kept for the next piece

std::size_t rounded(std::size_t bytes) { return (bytes + kUnit - 1) / kUnit * kUnit; }

}  // namespace

std::optional<int> ScratchFile::create(const std::filesystem::path& folder) {
  std::error_code wrong;
  std::filesystem::create_directories(folder, wrong);
  int out = ::open(folder.c_str(), O_TMPFILE | O_RDWR | O_EXCL | O_CLOEXEC, S_IRUSR | S_IWUSR);
  if (out < 0) {  // some file systems have no files without a name
    std::string name = (folder / "scratch.XXXXXX").string();
    out = ::mkostemp(name.data(), O_CLOEXEC);
    if (out >= 0) ::unlink(name.c_str());
  }
  if (out < 0) return std::nullopt;
  return out;
}

ScratchFile::ScratchFile(int descriptor, std::size_t most) : descriptor_(descriptor) {
  void* const at =
      ::mmap(nullptr, most, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (at == MAP_FAILED) return;
  begin_ = reinterpret_cast<std::uintptr_t>(at);
  reserved_ = most;
}

ScratchFile::~ScratchFile() {
  if (reserved_ > 0) ::munmap(address(0), reserved_);
  ::close(descriptor_);
}

void* ScratchFile::address(std::size_t offset) const {
  return reinterpret_cast<void*>(begin_ + offset);
}

std::size_t ScratchFile::size_of(const void* piece) const {
  const std::lock_guard lock(mutex_);
  return taken_.at(offset_of(piece)).bytes;
}

// Zeros are written where a piece will lie: a page that the disk has no room for would end the
// process when it is first used, and pages that are mapped before they were written cost twice as
// much as memory does.
bool ScratchFile::store(std::size_t offset, std::size_t bytes) const {
  static const std::array<char, kZeros> zeros{};
  for (std::size_t done = 0; done < bytes;) {
    const ssize_t wrote = ::pwrite(descriptor_, zeros.data(), std::min(kZeros, bytes - done),
                                   static_cast<off_t>(offset + done));
    if (wrote <= 0) return false;
    done += static_cast<std::size_t>(wrote);
  }
  return true;
}

// The smallest gap that it fits in, of those with room on the disk if there is one.
std::optional<ScratchFile::Place> ScratchFile::from_gap(std::size_t bytes) {
  const auto better = [](const Gap& one, const Gap& other) {
    return one.stored != other.stored ? one.stored : one.bytes < other.bytes;
  };
  auto best = gaps_.end();
  for (auto one = gaps_.begin(); one != gaps_.end(); ++one) {
    if (one->second.bytes < bytes) continue;
    if (best == gaps_.end() || better(one->second, best->second)) best = one;
  }
  if (best == gaps_.end()) return std::nullopt;
  const auto [offset, gap] = *best;
  gaps_.erase(best);
  if (gap.bytes > bytes) gaps_.emplace(offset + bytes, Gap{gap.bytes - bytes, gap.stored});
  if (gap.stored) stored_gaps_ -= bytes;
  return Place{offset, gap.stored};
}

std::optional<ScratchFile::Place> ScratchFile::from_end(std::size_t bytes) {
  if (bytes > reserved_ - end_) return std::nullopt;
  void* const at = ::mmap(address(end_), bytes, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_FIXED,
                          descriptor_, static_cast<off_t>(end_));
  if (at == MAP_FAILED) return std::nullopt;
  end_ += bytes;
  return Place{end_ - bytes, false};
}

std::optional<ScratchFile::Place> ScratchFile::find_place(std::size_t bytes) {
  const std::lock_guard lock(mutex_);
  std::optional<Place> out = from_gap(bytes);
  if (!out) out = from_end(bytes);
  if (out) taken_.emplace(out->offset, Piece{bytes, ++count_});
  return out;
}

void* ScratchFile::take(std::size_t bytes) {
  const std::size_t wanted = rounded(bytes);
  const std::optional<Place> place = find_place(wanted);
  if (!place) return nullptr;
  // Without the lock: a busy disk takes its time, and shrink() must not wait for it.
  if (place->stored || store(place->offset, wanted)) return address(place->offset);
  {
    const std::lock_guard lock(mutex_);
    taken_.erase(place->offset);
  }
  give_up(place->offset, wanted);
  return nullptr;
}

void ScratchFile::give_back(void* piece) {
  const std::size_t offset = offset_of(piece);
  Gap gap;
  {
    const std::lock_guard lock(mutex_);
    const auto found = taken_.find(offset);
    assert(found != taken_.end());
    gap = {found->second.bytes, stored_gaps_ + found->second.bytes <= kMostGaps};
    taken_.erase(found);
    if (gap.stored) {
      stored_gaps_ += gap.bytes;
      return add_gap(offset, gap);
    }
  }
  give_up(offset, gap.bytes);
}

// Room on the disk. Nor are its pages written any more.
void ScratchFile::give_up(std::size_t offset, std::size_t bytes) {
  ::madvise(address(offset), bytes, MADV_REMOVE);
  const std::lock_guard lock(mutex_);
  add_gap(offset, {bytes, false});
}

void ScratchFile::add_gap(std::size_t offset, Gap gap) {
  const auto next = gaps_.find(offset + gap.bytes);
  if (next != gaps_.end() && next->second.stored == gap.stored) {
    gap.bytes += next->second.bytes;
    gaps_.erase(next);
  }
  const auto after = gaps_.lower_bound(offset);
  if (after != gaps_.begin()) {
    auto& [begin, before] = *std::prev(after);
    if (begin + before.bytes == offset && before.stored == gap.stored) {
      before.bytes += gap.bytes;
      return;
    }
  }
  gaps_.emplace(offset, gap);
}

void ScratchFile::shrink(std::size_t bytes) {
  const std::lock_guard lock(mutex_);
  std::vector<std::pair<std::uint64_t, std::size_t>> latest;  // number and offset
  for (const auto& [offset, piece] : taken_) latest.emplace_back(piece.number, offset);
  std::sort(latest.begin(), latest.end(), std::greater<>());
  std::size_t kept = 0;
  for (const auto& [number, offset] : latest) {
    const std::size_t size = taken_.at(offset).bytes;
    kept += size;
    if (kept > bytes) ::madvise(address(offset), size, MADV_DONTNEED);
  }
  for (const auto& [offset, gap] : gaps_) ::madvise(address(offset), gap.bytes, MADV_DONTNEED);
}

}  // namespace imunoise::recording
