#pragma once

// The filters of our datasets: shuffle, deflate, fletcher32, in this order, as HDF5 itself applies
// them, several times as fast. HDF5 gets and gives chunks as they are stored.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

struct libdeflate_compressor;
struct libdeflate_decompressor;

namespace imunoise::recording {

/// For chunks of `count` numbers of `width` bytes. One thread at a time.
class ChunkFilters {
 public:
  /// Precondition: supports(width).
  ChunkFilters(std::size_t count, std::size_t width);
  static bool supports(std::size_t width) { return width == 2 || width == 4 || width == 8; }

  /// The chunk as it is stored, where `numbers` may be fewer than a chunk's: zeros follow. Nothing
  /// where there is no memory.
  std::vector<std::uint8_t> encode(std::span<const std::uint8_t> numbers);
  /// The first bytes of a chunk, as many as `numbers` has room for. False: it is damaged.
  bool decode(std::span<const std::uint8_t> stored, std::span<std::uint8_t> numbers);

  /// Bytes that a stored chunk may have at most.
  std::size_t largest() const;

 private:
  struct Free {
    void operator()(libdeflate_compressor* compressor) const;
    void operator()(libdeflate_decompressor* decompressor) const;
  };

  std::size_t count_;
  std::size_t width_;
  std::unique_ptr<libdeflate_compressor, Free> compressor_;
  std::unique_ptr<libdeflate_decompressor, Free> decompressor_;
  std::vector<std::uint8_t> shuffled_;
};

}  // namespace imunoise::recording
