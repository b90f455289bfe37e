#include "recording/hdf5/memory_file.h"

namespace imunoise::recording {
namespace {

constexpr std::size_t kIncrement = std::size_t{4} << 20U;  // bytes by which a file in memory grows

// The name is not looked up anywhere.
constexpr const char* kName = "memory.h5";

Hdf5Handle memory_access() {
  Hdf5Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  const bool keep_on_disk = false;
  if (!access || H5Pset_fapl_core(access.get(), kIncrement, keep_on_disk) < 0 ||
      H5Pset_libver_bounds(access.get(), H5F_LIBVER_V110, H5F_LIBVER_V110) < 0) {
    return {};
  }
  return access;
}

}  // namespace

Hdf5Handle create_memory_file() {
  const Hdf5Handle access = memory_access();
  if (!access) return {};
  return {H5Fcreate(kName, H5F_ACC_TRUNC, H5P_DEFAULT, access.get()), H5Fclose};
}

std::optional<std::string> file_image(hid_t file) {
  if (H5Fflush(file, H5F_SCOPE_LOCAL) < 0) return std::nullopt;
  const ssize_t size = H5Fget_file_image(file, nullptr, 0);
  if (size <= 0) return std::nullopt;
  std::string out(static_cast<std::size_t>(size), '\0');
  if (H5Fget_file_image(file, out.data(), out.size()) != size) return std::nullopt;
  return out;
}

Hdf5Handle open_memory_file(std::string_view bytes) {
  const Hdf5Handle access = memory_access();
  // The library copies the bytes and does not change them; its signature predates const.
  if (bytes.empty() || !access ||
      H5Pset_file_image(access.get(), const_cast<char*>(bytes.data()), bytes.size()) < 0) {
    return {};
  }
  return {H5Fopen(kName, H5F_ACC_RDONLY, access.get()), H5Fclose};
}

}  // namespace imunoise::recording
