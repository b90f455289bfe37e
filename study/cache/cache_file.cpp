#include "study/cache/cache_file.h"

#include <unistd.h>

#include <boost/interprocess/file_mapping.hpp>
#include <boost/interprocess/mapped_region.hpp>
#include <cstdint>
#include <cstring>
#include <string>

#include "core/support/parallel.h"
#include "recording/store/disk/file_system.h"
#include "recording/store/format/crc32c.h"

namespace imunoise::study {
namespace {

namespace ipc = boost::interprocess;

// A machine that orders bytes otherwise reads another number, and leaves the file alone.
constexpr std::uint64_t kMagic = 0x316e6565736e756dU;
constexpr std::size_t kAligned = 64;
constexpr std::size_t kMostHeader = 1U << 26U;  // bytes

struct Front {
  std::uint64_t magic = kMagic;
  std::uint32_t header_size = 0;
  std::uint32_t header_crc = 0;
};

std::size_t aligned(std::size_t size) { return (size + kAligned - 1) / kAligned * kAligned; }

std::string_view bytes_of(const SharedVector& array) {
  return {reinterpret_cast<const char*>(array.data()),
          static_cast<std::size_t>(array.size()) * sizeof(double)};
}

Result<void> write_all(recording::FileSystem& disk, const std::filesystem::path& path,
                       const v1::CacheHeader& header, const std::vector<SharedVector>& arrays) {
  auto out = disk.create(path);
  if (!out) return tl::unexpected(out.error());
  Result<void> done = (*out)->write(seen_front(header));
  for (std::size_t i = 0; done && i < arrays.size(); ++i) {
    const std::string_view bytes = bytes_of(arrays[i]);
    done = (*out)->write(bytes);
    if (done) done = (*out)->write(std::string(aligned(bytes.size()) - bytes.size(), '\0'));
  }
  return done;
}

// Where each array begins; none where they do not fit.
std::vector<std::size_t> places_of(const v1::CacheHeader& header, std::size_t begin,
                                   std::size_t end) {
  std::vector<std::size_t> out;
  for (const v1::CachedArray& one : header.arrays()) {
    if (begin > end || one.size() > (end - begin) / sizeof(double)) return {};
    out.push_back(begin);
    begin = aligned(begin + one.size() * sizeof(double));
  }
  return out;
}

}  // namespace

std::string seen_front(const v1::CacheHeader& header) {
  const std::string text = header.SerializeAsString();
  Front front;
  front.header_size = static_cast<std::uint32_t>(text.size());
  front.header_crc = recording::crc32c(text);
  std::string out(sizeof front, '\0');
  std::memcpy(out.data(), &front, sizeof front);
  out += text;
  out.resize(aligned(out.size()), '\0');
  return out;
}

Result<void> write_cache_file(const std::filesystem::path& path, CacheFile file) {
  v1::CacheHeader& header = file.header;
  const std::vector<SharedVector>& arrays = file.arrays;
  header.clear_arrays();
  for (const SharedVector& array : arrays) {
    v1::CachedArray& one = *header.add_arrays();
    one.set_size(static_cast<std::uint64_t>(array.size()));
  }
  for_each_index(arrays.size(), [&](std::size_t i) {
    header.mutable_arrays(static_cast<int>(i))->set_crc(recording::crc32c(bytes_of(arrays[i])));
  });
  const std::filesystem::path part = path.string() + "." + std::to_string(getpid()) + ".part";
  recording::FileSystem& disk = recording::posix_file_system();
  Result<void> done = write_all(disk, part, header, arrays);
  if (done) done = disk.rename(part, path);
  if (!done) (void)disk.remove(part);
  return done;
}

Result<CacheFile> parse_cache_file(std::string_view bytes, std::shared_ptr<const void> owner) {
  const auto damaged = [] { return fail("is damaged, or from another program"); };
  Front front;
  if (bytes.size() < sizeof front) return damaged();
  std::memcpy(&front, bytes.data(), sizeof front);
  if (front.magic != kMagic || front.header_size > kMostHeader ||
      front.header_size > bytes.size() - sizeof front)
    return damaged();
  const std::string_view text = bytes.substr(sizeof front, front.header_size);
  CacheFile out;
  if (recording::crc32c(text) != front.header_crc ||
      !out.header.ParseFromArray(text.data(), static_cast<int>(text.size())))
    return damaged();
  const std::vector<std::size_t> places =
      places_of(out.header, aligned(sizeof front + text.size()), bytes.size());
  const auto count = static_cast<std::size_t>(out.header.arrays_size());
  if (places.size() != count) return damaged();
  out.arrays.resize(count);
  std::vector<char> whole(count);
  for_each_index(count, [&](std::size_t i) {
    const v1::CachedArray& one = out.header.arrays(static_cast<int>(i));
    out.arrays[i] = SharedVector(owner, reinterpret_cast<const double*>(bytes.data() + places[i]),
                                 static_cast<Eigen::Index>(one.size()));
    whole[i] = recording::crc32c(bytes_of(out.arrays[i])) == one.crc() ? 1 : 0;
  });
  for (const char one : whole) {
    if (one == 0) return damaged();
  }
  return out;
}

Result<CacheFile> read_cache_file(const std::filesystem::path& path) try {
  const ipc::file_mapping file(path.c_str(), ipc::read_only);
  const auto region = std::make_shared<const ipc::mapped_region>(file, ipc::read_only);
  auto out = parse_cache_file({static_cast<const char*>(region->get_address()), region->get_size()},
                              region);
  if (!out) return fail(path.string() + ": " + out.error().message);
  return out;
} catch (const ipc::interprocess_exception& wrong) {
  return fail(path.string() + ": " + wrong.what());
}

}  // namespace imunoise::study
