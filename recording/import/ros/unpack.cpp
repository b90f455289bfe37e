#include "recording/import/ros/unpack.h"

#include <bzlib.h>
#include <fmt/core.h>
#include <lz4frame.h>
#include <zstd.h>

#include <algorithm>
#include <memory>

namespace imunoise::recording {
namespace {

// Memory grows with what comes out, not with what a header announces.
constexpr std::size_t kStep = std::size_t{1} << 20U;

// Calls `step(to, room)` for ever more room until it returns 0 bytes or `size` bytes are there.
template <class Step>
Unpacked grow(std::uint64_t size, const Step& step) {
  Unpacked out;
  while (out.bytes.size() < size) {
    const std::size_t old = out.bytes.size();
    const std::size_t room = std::min<std::size_t>(std::max(kStep, old), size - old);
    out.bytes.resize(old + room);
    const std::size_t got = step(out.bytes.data() + old, room);
    out.bytes.resize(old + got);
    if (got == 0) break;
  }
  out.whole = out.bytes.size() == size;
  return out;
}

Unpacked unpack_lz4(std::string_view packed, std::uint64_t size) {
  LZ4F_dctx* made = nullptr;
  if (LZ4F_isError(LZ4F_createDecompressionContext(&made, LZ4F_VERSION)) != 0) return {};
  const std::unique_ptr<LZ4F_dctx, decltype(&LZ4F_freeDecompressionContext)> context(
      made, &LZ4F_freeDecompressionContext);
  return grow(size, [&](char* to, std::size_t room) -> std::size_t {
    while (true) {
      std::size_t wrote = room;
      std::size_t read = packed.size();
      const std::size_t said =
          LZ4F_decompress(context.get(), to, &wrote, packed.data(), &read, nullptr);
      if (LZ4F_isError(said) != 0) return 0;
      packed.remove_prefix(read);
      if (wrote > 0 || read == 0) return wrote;
    }
  });
}

Unpacked unpack_zstd(std::string_view packed, std::uint64_t size) {
  const std::unique_ptr<ZSTD_DStream, decltype(&ZSTD_freeDStream)> stream(ZSTD_createDStream(),
                                                                          &ZSTD_freeDStream);
  if (!stream) return {};
  ZSTD_inBuffer in{packed.data(), packed.size(), 0};
  return grow(size, [&](char* to, std::size_t room) -> std::size_t {
    ZSTD_outBuffer out{to, room, 0};
    while (true) {
      const std::size_t before = in.pos;
      const std::size_t said = ZSTD_decompressStream(stream.get(), &out, &in);
      if (ZSTD_isError(said) != 0) return 0;
      if (out.pos > 0 || in.pos == before) return out.pos;
    }
  });
}

Unpacked unpack_bz2(std::string_view packed, std::uint64_t size) {
  bz_stream stream = {};
  if (BZ2_bzDecompressInit(&stream, 0, 0) != BZ_OK) return {};
  std::string source(packed);  // the library wants bytes that it might change
  stream.next_in = source.data();
  stream.avail_in = static_cast<unsigned>(source.size());
  bool ended = false;
  Unpacked out = grow(size, [&](char* to, std::size_t room) -> std::size_t {
    stream.next_out = to;
    stream.avail_out = static_cast<unsigned>(room);
    while (!ended && stream.avail_out == room) {
      const unsigned before = stream.avail_in;
      const int said = BZ2_bzDecompress(&stream);
      ended = said != BZ_OK || (stream.avail_in == before && stream.avail_out == room);
    }
    return room - stream.avail_out;
  });
  BZ2_bzDecompressEnd(&stream);
  return out;
}

}  // namespace

Result<Unpacked> unpack(std::string_view method, std::string_view packed, std::uint64_t size) {
  if (size > kLargestChunk || packed.size() > kLargestChunk) {
    return fail(fmt::format("a chunk of {} bytes, at most {} are read; record with smaller chunks",
                            std::max<std::uint64_t>(size, packed.size()), kLargestChunk));
  }
  if (method.empty() || method == "none") {
    return Unpacked{std::string(packed.substr(0, size)), packed.size() >= size};
  }
  if (method == "lz4") return unpack_lz4(packed, size);
  if (method == "zstd") return unpack_zstd(packed, size);
  if (method == "bz2") return unpack_bz2(packed, size);
  return fail(fmt::format("packed with '{}'; known are lz4, zstd and bz2: record without packing",
                          method.substr(0, 40)));
}

}  // namespace imunoise::recording
