// Any header before any numbers, with checksums that hold, as the file of a recording that was
// seen: refused, or something that can be judged by; and any bytes without.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <string>

#include "recording/store/format/crc32c.h"
#include "study/cache/cache_record.h"

namespace {

using namespace imunoise;

void require(bool holds) {
  if (!holds) std::abort();
}

// Copied to where a mapped file would lie.
Result<study::CacheFile> parsed(const std::string& bytes) {
  struct alignas(64) Line {
    char bytes[64];
  };
  const std::shared_ptr<Line[]> place(new Line[bytes.size() / sizeof(Line) + 1]);
  std::memcpy(place.get(), bytes.data(), bytes.size());
  return study::parse_cache_file({place[0].bytes, bytes.size()}, place);
}

volatile double read;  // all of it can be

void check(const study::CacheFile& file) {
  if (const auto channel = study::channel_of(file)) {
    const Subject& subject = *channel->subject;
    require(subject.replicates() > 0 && subject.replicates() == channel->moments.size());
    for (std::size_t k = 0; k < subject.replicates(); ++k) {
      require(subject.cosines[k].size() + 1 == subject.samples[k].size());
      read = subject.samples[k].sum() + subject.cosines[k].sum();
    }
  }
  if (const auto witness = study::witness_of(file))
    require(witness->samples.size() == witness->cosines.size());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string raw(static_cast<const char*>(static_cast<const void*>(data)), size);
  if (const auto file = parsed(raw)) check(*file);
  if (size < 2) return 0;
  // The first two bytes: how long the header is. Its numbers' checksums are put right.
  const std::size_t length = std::min(std::size_t{data[0]} + 256U * std::size_t{data[1]}, size - 2);
  v1::CacheHeader header;
  if (!header.ParseFromString(raw.substr(2, length))) return 0;
  std::string numbers = raw.substr(2 + length);
  std::size_t at = 0;
  for (v1::CachedArray& one : *header.mutable_arrays()) {
    const std::size_t bytes = std::min<std::size_t>(one.size(), numbers.size()) * sizeof(double);
    if (at + bytes > numbers.size()) break;
    one.set_crc(recording::crc32c(std::string_view(numbers).substr(at, bytes)));
    at = (at + bytes + 63) / 64 * 64;
    numbers.resize(std::max(numbers.size(), at));
  }
  if (const auto whole = parsed(study::seen_front(header) + numbers)) check(*whole);
  return 0;
}
