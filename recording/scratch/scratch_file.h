#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <mutex>
#include <optional>

namespace imunoise::recording {

/// A mapped file without a name, from which pieces are taken as from a heap. Thread-safe. What is
/// in it leaves memory whenever the system, or shrink(), wants it to, and is read back when it is
/// used: nothing but time depends on it.
class ScratchFile {
 public:
  /// None where no file can be made or mapped. `folder` is made if it is missing.
  static std::optional<int> create(const std::filesystem::path& folder);

  /// Owns the file. At most so many bytes are taken from it.
  ScratchFile(int descriptor, std::size_t most);
  ~ScratchFile();
  ScratchFile(const ScratchFile&) = delete;
  ScratchFile& operator=(const ScratchFile&) = delete;

  /// At least so many bytes, of any content, at a multiple of the page size. Null: the disk has no
  /// room.
  void* take(std::size_t bytes);
  /// Precondition: take() gave it.
  void give_back(void* piece);
  bool holds(const void* at) const {
    return reinterpret_cast<std::uintptr_t>(at) - begin_ < reserved_;
  }
  /// Size of a piece that was taken.
  std::size_t size_of(const void* piece) const;

  /// Takes all out of this process's memory but the pieces that were taken last, up to so many
  /// bytes: those are most likely in use.
  void shrink(std::size_t bytes);

 private:
  struct Piece {
    std::size_t bytes = 0;
    std::uint64_t number = 0;  // rising from piece to piece
  };
  struct Gap {
    std::size_t bytes = 0;
    bool stored = false;  // has room on the disk
  };

  std::size_t offset_of(const void* piece) const {
    return reinterpret_cast<std::uintptr_t>(piece) - begin_;
  }
  void* address(std::size_t offset) const;
  // A place for so many bytes, by its offset.
  struct Place {
    std::size_t offset = 0;
    bool stored = false;
  };
  std::optional<Place> find_place(std::size_t bytes);
  std::optional<Place> from_gap(std::size_t bytes);
  std::optional<Place> from_end(std::size_t bytes);
  bool store(std::size_t offset, std::size_t bytes) const;
  void add_gap(std::size_t offset, Gap gap);
  void give_up(std::size_t offset, std::size_t bytes);

  int descriptor_;
  std::uintptr_t begin_ = 0;
  std::size_t reserved_ = 0;  // addresses
  mutable std::mutex mutex_;
  std::size_t end_ = 0;                 // of what was ever taken
  std::uint64_t count_ = 0;             // pieces taken so far
  std::map<std::size_t, Piece> taken_;  // by offset
  std::map<std::size_t, Gap> gaps_;     // between them, by offset; neighbours alike are joined
  std::size_t stored_gaps_ = 0;         // bytes
};

}  // namespace imunoise::recording
