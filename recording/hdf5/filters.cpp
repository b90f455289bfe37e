#include "recording/hdf5/filters.h"

#include <libdeflate.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cstring>

namespace imunoise::recording {
namespace {

static_assert(std::endian::native == std::endian::little, "numbers are copied as they lie");

constexpr int kLevel = 1;
constexpr std::size_t kChecksumBytes = 4;
constexpr std::size_t kBlock = 4096;  // numbers that stay in the cache while their bytes are sorted

// All first bytes, then all second bytes, ...
template <class Word>
void shuffle(const std::uint8_t* numbers, std::size_t count, std::uint8_t* out) {
  std::array<Word, kBlock> block;
  for (std::size_t begin = 0; begin < count; begin += kBlock) {
    const std::size_t n = std::min(kBlock, count - begin);
    std::memcpy(block.data(), numbers + begin * sizeof(Word), n * sizeof(Word));
    for (std::size_t byte = 0; byte < sizeof(Word); ++byte) {
      std::uint8_t* const to = out + byte * count + begin;
      for (std::size_t i = 0; i < n; ++i) to[i] = static_cast<std::uint8_t>(block[i] >> (8 * byte));
    }
  }
}

// The first `wanted` of `count` numbers.
template <class Word>
void unshuffle(const std::uint8_t* bytes, std::size_t count, std::size_t wanted,
               std::uint8_t* numbers) {
  std::array<Word, kBlock> block;
  for (std::size_t begin = 0; begin < wanted; begin += kBlock) {
    const std::size_t n = std::min(kBlock, wanted - begin);
    for (std::size_t i = 0; i < n; ++i) block[i] = bytes[begin + i];
    for (std::size_t byte = 1; byte < sizeof(Word); ++byte) {
      const std::uint8_t* const from = bytes + byte * count + begin;
      for (std::size_t i = 0; i < n; ++i) {
        block[i] = static_cast<Word>(block[i] | static_cast<Word>(Word{from[i]} << (8 * byte)));
      }
    }
    std::memcpy(numbers + begin * sizeof(Word), block.data(), n * sizeof(Word));
  }
}

template <class Function>
void with_word(std::size_t width, Function&& function) {
  if (width == 2) return function(std::uint16_t{});
  if (width == 4) return function(std::uint32_t{});
  function(std::uint64_t{});
}

// Two sums of 16-bit words, the first byte of each the higher, modulo 65535; a last single byte is
// the higher of a word. Sums of 360 words do not overflow.
std::uint32_t fletcher32(std::span<const std::uint8_t> bytes) {
  constexpr std::size_t kWords = 360;
  std::uint32_t low = 0;
  std::uint32_t high = 0;
  const auto fold = [](std::uint32_t sum) { return (sum & 0xffffU) + (sum >> 16U); };
  std::size_t i = 0;
  while (i + 1 < bytes.size()) {
    const std::size_t end = std::min(bytes.size() - 1, i + 2 * kWords);
    for (; i < end; i += 2) {
      low += static_cast<std::uint32_t>(bytes[i] << 8U | bytes[i + 1]);
      high += low;
    }
    low = fold(low);
    high = fold(high);
  }
  if (i < bytes.size()) {
    low += static_cast<std::uint32_t>(bytes[i] << 8U);
    high += low;
    low = fold(low);
    high = fold(high);
  }
  return fold(high) << 16U | fold(low);
}

}  // namespace

void ChunkFilters::Free::operator()(libdeflate_compressor* compressor) const {
  libdeflate_free_compressor(compressor);
}
void ChunkFilters::Free::operator()(libdeflate_decompressor* decompressor) const {
  libdeflate_free_decompressor(decompressor);
}

ChunkFilters::ChunkFilters(std::size_t count, std::size_t width)
    : count_(count), width_(width), shuffled_(count * width) {
  assert(supports(width));
}

std::size_t ChunkFilters::largest() const {
  return libdeflate_zlib_compress_bound(nullptr, shuffled_.size()) + kChecksumBytes;
}

std::vector<std::uint8_t> ChunkFilters::encode(std::span<const std::uint8_t> numbers) {
  assert(numbers.size() <= shuffled_.size());
  if (!compressor_) compressor_.reset(libdeflate_alloc_compressor(kLevel));
  if (!compressor_) return {};
  std::vector<std::uint8_t> whole;
  if (numbers.size() < shuffled_.size()) {
    whole.resize(shuffled_.size());
    std::copy(numbers.begin(), numbers.end(), whole.begin());
    numbers = whole;
  }
  with_word(width_,
            [&]<class Word>(Word) { shuffle<Word>(numbers.data(), count_, shuffled_.data()); });
  std::vector<std::uint8_t> out(largest());
  const std::size_t size = libdeflate_zlib_compress(compressor_.get(), shuffled_.data(),
                                                    shuffled_.size(), out.data(), out.size());
  assert(size > 0);  // there is room for the worst case
  const std::uint32_t checksum = fletcher32(std::span(out).first(size));
  std::memcpy(out.data() + size, &checksum, kChecksumBytes);
  out.resize(size + kChecksumBytes);
  return out;
}

bool ChunkFilters::decode(std::span<const std::uint8_t> stored, std::span<std::uint8_t> numbers) {
  assert(numbers.size() <= shuffled_.size() && numbers.size() % width_ == 0);
  if (!decompressor_) decompressor_.reset(libdeflate_alloc_decompressor());
  if (!decompressor_ || stored.size() < kChecksumBytes) return false;
  const auto compressed = stored.first(stored.size() - kChecksumBytes);
  std::uint32_t checksum = 0;
  std::memcpy(&checksum, stored.data() + compressed.size(), kChecksumBytes);
  if (checksum != fletcher32(compressed)) return false;
  if (libdeflate_zlib_decompress(decompressor_.get(), compressed.data(), compressed.size(),
                                 shuffled_.data(), shuffled_.size(),
                                 nullptr) != LIBDEFLATE_SUCCESS) {
    return false;
  }
  with_word(width_, [&]<class Word>(Word) {
    unshuffle<Word>(shuffled_.data(), count_, numbers.size() / sizeof(Word), numbers.data());
  });
  return true;
}

}  // namespace imunoise::recording
