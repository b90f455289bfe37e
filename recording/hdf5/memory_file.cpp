#include "recording/hdf5/memory_file.h"

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <utility>

namespace imunoise::recording {
namespace {

// Bytes by which a file in memory grows. HDF5 clears them each time: a chunk of a short replicate
// has a few thousand.
constexpr std::size_t kIncrement = std::size_t{64} << 10U;

// The name is not looked up on any disk, but HDF5 takes two open files in memory of one name for
// one file: it refuses to make the second, and opens the first instead of it.
std::string unique_name() {
  static std::atomic<std::uint64_t> made = 0;
  return "memory-" + std::to_string(++made) + ".h5";
}

Hdf5Handle memory_access() {
  Hdf5Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  const bool keep_on_disk = false;
  if (!access || H5Pset_fapl_core(access.get(), kIncrement, keep_on_disk) < 0 ||
      // What HDF5 itself leaves open of a damaged file goes with the file.
      H5Pset_fclose_degree(access.get(), H5F_CLOSE_STRONG) < 0 ||
      H5Pset_libver_bounds(access.get(), H5F_LIBVER_V110, H5F_LIBVER_V110) < 0) {
    return {};
  }
  return access;
}

}  // namespace

// The memory of a file, kept when HDF5 frees it on closing. (H5Fget_file_image of an open file
// clears a flag in the superblock and leaves its checksum as it was: 1.10.8 cannot open the
// result.)
struct NewMemoryFile::Memory {
  void* bytes = nullptr;
  std::size_t size = 0;      // that HDF5 asked for
  std::size_t capacity = 0;  // doubles: a long file moves seldom

  ~Memory() { std::free(bytes); }

  static void* allocate(std::size_t size, H5FD_file_image_op_t, void*) { return std::malloc(size); }
  static void* copy(void* to, const void* from, std::size_t size, H5FD_file_image_op_t, void*) {
    return std::memcpy(to, from, size);
  }
  static void* resize(void* bytes, std::size_t size, H5FD_file_image_op_t, void* self) {
    auto& memory = *static_cast<Memory*>(self);
    if (size > memory.capacity) {
      const std::size_t capacity = std::max(size, 2 * memory.capacity);
      bytes = std::realloc(bytes, capacity);
      if (bytes == nullptr) return nullptr;
      memory.capacity = capacity;
    }
    memory.size = size;
    return bytes;
  }
  static herr_t release(void* bytes, H5FD_file_image_op_t operation, void* self) {
    if (operation == H5FD_FILE_IMAGE_OP_FILE_CLOSE) {
      static_cast<Memory*>(self)->bytes = bytes;
    } else {
      std::free(bytes);
    }
    return 0;
  }
  static void* share(void* self) { return self; }
  static herr_t forget(void*) { return 0; }
};

NewMemoryFile::NewMemoryFile() : memory_(std::make_unique<Memory>()) {
  const Hdf5Handle access = memory_access();
  H5FD_file_image_callbacks_t callbacks = {Memory::allocate, Memory::copy,  Memory::resize,
                                           Memory::release,  Memory::share, Memory::forget,
                                           memory_.get()};
  if (access && H5Pset_file_image_callbacks(access.get(), &callbacks) >= 0) {
    file_ = {H5Fcreate(unique_name().c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access.get()), H5Fclose};
  }
}

NewMemoryFile::~NewMemoryFile() = default;

std::optional<std::string> NewMemoryFile::finish() {
  if (!file_.close_now() || memory_->bytes == nullptr) return std::nullopt;
  // The memory is longer than the file, whose end is in its superblock (versions 2 and 3: the
  // eight bytes after the signature, four single bytes and two addresses).
  constexpr std::size_t end_of_file = 8 + 4 + 2 * 8;
  std::uint64_t size = 0;
  if (memory_->size < end_of_file + sizeof size) return std::nullopt;
  const auto* const bytes = static_cast<const char*>(memory_->bytes);
  std::memcpy(&size, bytes + end_of_file, sizeof size);
  if (size > memory_->size) return std::nullopt;
  return std::string(bytes, size);
}

Hdf5Handle open_memory_file(std::string_view bytes) {
  const Hdf5Handle access = memory_access();
  // The library copies the bytes and does not change them; its signature predates const.
  if (bytes.empty() || !access ||
      H5Pset_file_image(access.get(), const_cast<char*>(bytes.data()), bytes.size()) < 0) {
    return {};
  }
  return {H5Fopen(unique_name().c_str(), H5F_ACC_RDONLY, access.get()), H5Fclose};
}

}  // namespace imunoise::recording
