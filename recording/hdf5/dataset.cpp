#include "recording/hdf5/dataset.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <functional>
#include <span>
#include <utility>
#include <vector>

#include "core/support/counted.h"
#include "core/support/parallel.h"
#include "recording/hdf5/filters.h"

namespace imunoise::recording {
namespace {

constexpr hsize_t kChunk =
    65536;  // numbers: half a megabyte of doubles, HDF5's chunk cache holds two

// Numbers that lie in other files are not this file's recording (and may be any file of the disk).
bool stored_elsewhere(hid_t dataset) {
  const Hdf5Handle properties(H5Dget_create_plist(dataset), H5Pclose);
  return !properties || H5Pget_layout(properties.get()) == H5D_VIRTUAL ||
         H5Pget_external_count(properties.get()) != 0;
}

// Bytes of the file, which no dataset inside it can exceed: what lies in one piece claims any size.
std::uint64_t file_bytes(hid_t dataset) {
  const Hdf5Handle file(H5Iget_file_id(dataset), H5Fclose);
  hsize_t bytes = 0;
  return file && H5Fget_filesize(file.get(), &bytes) >= 0 ? bytes : 0;
}

// Chunks are filtered on all threads, group by group, so that memory stays bounded; HDF5 itself has
// one lock.
constexpr std::size_t kGroup = 16;

// The numbers of chunk `index`, of `size` bytes a chunk.
template <class Byte>
std::span<Byte> chunk_part(std::span<Byte> bytes, std::size_t index, std::size_t size) {
  return bytes.subspan(index * size, std::min(size, bytes.size() - index * size));
}

// Calls run(first chunk, chunks) for groups until one fails.
bool for_groups(std::size_t bytes, std::size_t chunk_bytes,
                const std::function<bool(std::size_t, std::size_t)>& run) {
  const std::size_t chunks = (bytes + chunk_bytes - 1) / chunk_bytes;
  for (std::size_t first = 0; first < chunks; first += kGroup) {
    if (!run(first, std::min(kGroup, chunks - first))) return false;
  }
  return true;
}

// Writes chunk by chunk, past HDF5's own filters. Precondition: numbers are stored as they lie.
bool write_chunks(hid_t dataset, hsize_t chunk, std::span<const std::uint8_t> bytes,
                  std::size_t width) {
  return for_groups(bytes.size(), chunk * width, [&](std::size_t first, std::size_t count) {
    std::vector<std::vector<std::uint8_t>> stored(count);
    for_each_index(count, [&](std::size_t i) {
      stored[i] = ChunkFilters(chunk, width).encode(chunk_part(bytes, first + i, chunk * width));
    });
    for (std::size_t i = 0; i < count; ++i) {
      const hsize_t offset = (first + i) * chunk;
      if (stored[i].empty() || H5Dwrite_chunk(dataset, H5P_DEFAULT, 0, &offset, stored[i].size(),
                                              stored[i].data()) < 0) {
        return false;
      }
    }
    return true;
  });
}

// Numbers in a chunk of a dataset that has our filters, and no others; 0 where it has not.
hsize_t chunk_of_ours(hid_t dataset, hid_t memory) {
  const Hdf5Handle properties(H5Dget_create_plist(dataset), H5Pclose);
  const Hdf5Handle type(H5Dget_type(dataset), H5Tclose);
  hsize_t chunk = 0;
  if (!properties || !type || H5Tequal(type.get(), memory) <= 0 ||
      H5Pget_layout(properties.get()) != H5D_CHUNKED ||
      H5Pget_chunk(properties.get(), 1, &chunk) != 1 || chunk > kChunk) {
    return 0;
  }
  constexpr std::array kOurs = {H5Z_FILTER_SHUFFLE, H5Z_FILTER_DEFLATE, H5Z_FILTER_FLETCHER32};
  if (H5Pget_nfilters(properties.get()) != static_cast<int>(kOurs.size())) return 0;
  for (unsigned i = 0; i < kOurs.size(); ++i) {
    unsigned flags = 0;
    std::size_t values = 0;
    if (H5Pget_filter2(properties.get(), i, &flags, &values, nullptr, 0, nullptr, nullptr) !=
        kOurs[i]) {
      return 0;
    }
  }
  return chunk;
}

// A chunk as it is stored; empty where something is unusual.
std::vector<std::uint8_t> stored_chunk(hid_t dataset, hsize_t offset, std::size_t largest) {
  hsize_t size = 0;
  std::uint32_t skipped = 0;
  if (H5Dget_chunk_storage_size(dataset, &offset, &size) < 0 || size > largest) return {};
  std::vector<std::uint8_t> out(size);
  if (size == 0 || H5Dread_chunk(dataset, H5P_DEFAULT, &offset, &skipped, out.data()) < 0)
    return {};
  if (skipped != 0) out.clear();
  return out;
}

// False: something is unusual; let HDF5 report it.
bool read_chunks(hid_t dataset, hsize_t chunk, std::span<std::uint8_t> bytes, std::size_t width) {
  const std::size_t largest = ChunkFilters(chunk, width).largest();
  return for_groups(bytes.size(), chunk * width, [&](std::size_t first, std::size_t count) {
    std::vector<std::vector<std::uint8_t>> stored(count);
    for (std::size_t i = 0; i < count; ++i) {
      stored[i] = stored_chunk(dataset, (first + i) * chunk, largest);
      if (stored[i].empty()) return false;
    }
    std::atomic<bool> good = true;
    for_each_index(count, [&](std::size_t i) {
      const auto numbers = chunk_part(bytes, first + i, chunk * width);
      if (!ChunkFilters(chunk, width).decode(stored[i], numbers)) good = false;
    });
    return good.load();
  });
}

}  // namespace

Result<OpenDataset> open_dataset(hid_t group, const std::string& name, int dimensions) {
  const auto trouble = [&](const std::string& what) {
    return fail(fmt::format("dataset {}: {}", name, what));
  };
  OpenDataset out;
  out.id = {H5Dopen2(group, name.c_str(), H5P_DEFAULT), H5Dclose};
  if (!out.id) return trouble("cannot be opened; the file is damaged");
  const Hdf5Handle space(H5Dget_space(out.id.get()), H5Sclose);
  const Hdf5Handle type(H5Dget_type(out.id.get()), H5Tclose);
  if (!space || !type) return trouble("cannot be described; the file is damaged");
  const int rank = H5Sget_simple_extent_ndims(space.get());
  if (rank < 1 || rank > dimensions) {
    return trouble(
        fmt::format("has {} dimensions where one{} needed; store each channel as a "
                    "dataset of its own, or choose others with --channel",
                    rank, dimensions > 1 ? " or two are" : " is"));
  }
  std::array<hsize_t, 2> extents = {1, 1};
  if (H5Sget_simple_extent_dims(space.get(), extents.data(), nullptr) != rank)
    return trouble("cannot be described; the file is damaged");
  out.columns = extents[1];
  out.type_class = H5Tget_class(type.get());
  out.has_sign = out.type_class == H5T_INTEGER && H5Tget_sign(type.get()) == H5T_SGN_2;
  out.width = H5Tget_size(type.get());
  const hssize_t points = H5Sget_simple_extent_npoints(space.get());
  if (points <= 0 || out.width == 0) return out;
  out.size = static_cast<std::uint64_t>(points);
  if (stored_elsewhere(out.id.get())) {
    return trouble("keeps its numbers in another file; copy them into this one (h5repack)");
  }
  const std::uint64_t stored =
      std::min<std::uint64_t>(H5Dget_storage_size(out.id.get()), file_bytes(out.id.get()));
  if (out.size / kBestCompression > stored / out.width || stored == 0) {
    return trouble(fmt::format("claims {}, but only {} stored; it was not written to its end",
                               counted(out.size, "sample"), counted(stored, "byte")));
  }
  return out;
}

Hdf5Handle write_dataset(hid_t group, const std::string& name, hid_t stored, hid_t memory,
                         const void* numbers, std::uint64_t size) {
  const hsize_t extent = size;
  const Hdf5Handle space(H5Screate_simple(1, &extent, nullptr), H5Sclose);
  const Hdf5Handle properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  if (!space || !properties) return {};
  if (size > 0) {  // HDF5 cannot filter what is empty
    const hsize_t chunk = std::min(extent, kChunk);
    if (H5Pset_chunk(properties.get(), 1, &chunk) < 0 || H5Pset_shuffle(properties.get()) < 0 ||
        H5Pset_deflate(properties.get(), 1) < 0 || H5Pset_fletcher32(properties.get()) < 0) {
      return {};
    }
  }
  Hdf5Handle dataset(H5Dcreate2(group, name.c_str(), stored, space.get(), H5P_DEFAULT,
                                properties.get(), H5P_DEFAULT),
                     H5Dclose);
  if (!dataset || size == 0) return dataset;
  const std::size_t width = H5Tget_size(memory);
  const bool as_they_lie = H5Tequal(stored, memory) > 0 && ChunkFilters::supports(width);
  const bool written =
      as_they_lie ? write_chunks(dataset.get(), std::min(extent, kChunk),
                                 {static_cast<const std::uint8_t*>(numbers), size * width}, width)
                  : H5Dwrite(dataset.get(), memory, H5S_ALL, H5S_ALL, H5P_DEFAULT, numbers) >= 0;
  if (!written) return {};
  return dataset;
}

bool read_dataset(const OpenDataset& dataset, hid_t memory, void* numbers) {
  if (dataset.size == 0) return true;
  const std::size_t width = H5Tget_size(memory);
  const hsize_t chunk = ChunkFilters::supports(width) ? chunk_of_ours(dataset.id.get(), memory) : 0;
  if (chunk > 0 &&
      read_chunks(dataset.id.get(), chunk,
                  {static_cast<std::uint8_t*>(numbers), dataset.size * width}, width)) {
    return true;
  }
  return H5Dread(dataset.id.get(), memory, H5S_ALL, H5S_ALL, H5P_DEFAULT, numbers) >= 0;
}

}  // namespace imunoise::recording
