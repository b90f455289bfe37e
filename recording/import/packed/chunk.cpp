#include "recording/import/packed/chunk.h"

#include <fmt/core.h>

#include <algorithm>
#include <optional>

#include "recording/import/packed/unpacking.h"

namespace imunoise::recording {
namespace {

// Memory grows with what comes out, not with what a header announces.
constexpr std::size_t kStep = std::size_t{1} << 18U;

std::optional<Packing> packing_called(std::string_view method) {
  if (method == "lz4") return Packing::kLz4;
  if (method == "zstd") return Packing::kZstd;
  if (method == "bz2") return Packing::kBzip2;
  return std::nullopt;
}

}  // namespace

Result<Unpacked> unpack_chunk(std::string_view method, std::string_view packed,
                              std::uint64_t size) {
  if (size > kLargestChunk || packed.size() > kLargestChunk) {
    return fail(fmt::format("a chunk of {} bytes, at most {} are read; record with smaller chunks",
                            std::max<std::uint64_t>(size, packed.size()), kLargestChunk));
  }
  if (method.empty() || method == "none") {
    return Unpacked{std::string(packed.substr(0, size)), packed.size() >= size};
  }
  const std::optional<Packing> packing = packing_called(method);
  if (!packing) {
    return fail(fmt::format("packed with '{}'; known are lz4, zstd and bz2: record without packing",
                            method.substr(0, 40)));
  }
  const auto stream = unpacking(*packing, std::make_unique<MemoryStream>(packed), "");
  Unpacked out;
  while (stream && out.bytes.size() < size) {
    const std::size_t old = out.bytes.size();
    out.bytes.resize(old + std::min<std::uint64_t>(std::max(kStep, old), size - old));
    const Result<std::size_t> got = stream->read(std::span(out.bytes).subspan(old));
    out.bytes.resize(old + got.value_or(0));
    if (got.value_or(0) == 0) break;
  }
  out.whole = out.bytes.size() == size;
  return out;
}

}  // namespace imunoise::recording
