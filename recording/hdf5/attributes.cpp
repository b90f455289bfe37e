#include "recording/hdf5/attributes.h"

#include <fmt/core.h>

#include <algorithm>

namespace imunoise::recording {
namespace {

constexpr std::size_t kMaximumString = 4096;

struct OpenAttribute {
  Hdf5Handle attribute;
  Hdf5Handle type;
  H5T_class_t type_class = H5T_NO_CLASS;
};

// Opens an attribute of one element. netCDF writes arrays of one, h5py scalars: both count.
Result<std::optional<OpenAttribute>> open_one(hid_t object, const char* name) {
  const htri_t exists = H5Aexists(object, name);
  if (exists == 0) return std::optional<OpenAttribute>();
  OpenAttribute out{{H5Aopen(object, name, H5P_DEFAULT), H5Aclose}, {}};
  if (exists < 0 || !out.attribute) return fail(fmt::format("attribute {} cannot be opened", name));
  out.type = {H5Aget_type(out.attribute.get()), H5Tclose};
  const Hdf5Handle space(H5Aget_space(out.attribute.get()), H5Sclose);
  if (!out.type || !space || H5Sget_simple_extent_npoints(space.get()) != 1) {
    return fail(fmt::format("attribute {} must hold one value", name));
  }
  out.type_class = H5Tget_class(out.type.get());
  return std::optional(std::move(out));
}

bool write_scalar(hid_t object, const std::string& name, hid_t stored, hid_t memory,
                  const void* value) {
  const Hdf5Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  const Hdf5Handle attribute(
      H5Acreate2(object, name.c_str(), stored, space.get(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  return attribute && H5Awrite(attribute.get(), memory, value) >= 0;
}

}  // namespace

Result<std::optional<double>> read_number_attribute(hid_t object, const char* name) {
  const auto opened = open_one(object, name);
  if (!opened) return tl::make_unexpected(opened.error());
  if (!*opened) return std::optional<double>();
  double value = 0.0;
  const bool number = (*opened)->type_class == H5T_INTEGER || (*opened)->type_class == H5T_FLOAT;
  if (!number || H5Aread((*opened)->attribute.get(), H5T_NATIVE_DOUBLE, &value) < 0) {
    return fail(fmt::format("attribute {} must be a number", name));
  }
  return std::optional(value);
}

Result<std::optional<std::uint64_t>> read_count_attribute(hid_t object, const char* name) {
  const auto opened = open_one(object, name);
  if (!opened) return tl::make_unexpected(opened.error());
  if (!*opened) return std::optional<std::uint64_t>();
  const hid_t attribute = (*opened)->attribute.get();
  const bool whole = (*opened)->type_class == H5T_INTEGER;
  const bool has_sign = whole && H5Tget_sign((*opened)->type.get()) != H5T_SGN_NONE;
  std::int64_t sign = 0;
  std::uint64_t value = 0;
  if (!whole || (has_sign && H5Aread(attribute, H5T_NATIVE_INT64, &sign) < 0) || sign < 0 ||
      H5Aread(attribute, H5T_NATIVE_UINT64, &value) < 0) {
    return fail(fmt::format("attribute {} is not a count", name));
  }
  return std::optional(value);
}

Result<std::optional<std::string>> read_string_attribute(hid_t object, const char* name) {
  const auto opened = open_one(object, name);
  if (!opened) return tl::make_unexpected(opened.error());
  if (!*opened) return std::optional<std::string>();
  const auto broken = [&] { return fail(fmt::format("attribute {} must be a string", name)); };
  const hid_t attribute = (*opened)->attribute.get();
  const hid_t type = (*opened)->type.get();
  if ((*opened)->type_class != H5T_STRING) return broken();
  std::string text;
  if (H5Tis_variable_str(type) > 0) {
    char* value = nullptr;
    const Hdf5Handle memory(H5Tcopy(H5T_C_S1), H5Tclose);
    if (!memory || H5Tset_size(memory.get(), H5T_VARIABLE) < 0 ||
        H5Tset_cset(memory.get(), H5Tget_cset(type)) < 0 ||
        H5Aread(attribute, memory.get(), &value) < 0) {
      return broken();
    }
    if (value != nullptr) {
      const std::string_view all(value);
      text = all.substr(0, kMaximumString + 1);
      H5free_memory(value);
    }
  } else {
    text.resize(std::min(H5Tget_size(type), kMaximumString + 1));
    if (text.size() <= kMaximumString && H5Aread(attribute, type, text.data()) < 0) return broken();
  }
  if (text.size() > kMaximumString) {
    return fail(fmt::format("attribute {} is longer than {} bytes", name, kMaximumString));
  }
  text.resize(std::min(text.size(), text.find('\0')));
  while (!text.empty() && text.back() == ' ') text.pop_back();  // padding of Fortran strings
  return std::optional(std::move(text));
}

std::vector<std::string> attribute_names(hid_t object) {
  std::vector<std::string> out;
  const auto visit = [](hid_t, const char* name, const H5A_info_t*, void* names) -> herr_t {
    static_cast<std::vector<std::string>*>(names)->emplace_back(name);
    return 0;
  };
  H5Aiterate2(object, H5_INDEX_NAME, H5_ITER_INC, nullptr, visit, &out);
  return out;
}

bool write_attribute(hid_t object, const std::string& name, double value) {
  return write_scalar(object, name, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, &value);
}

bool write_attribute(hid_t object, const std::string& name, std::uint64_t value) {
  return write_scalar(object, name, H5T_STD_U64LE, H5T_NATIVE_UINT64, &value);
}

bool write_attribute(hid_t object, const std::string& name, std::string_view value) {
  const std::string text(value.empty() ? std::string_view("\0", 1) : value);
  const Hdf5Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  const Hdf5Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  if (!type || H5Tset_size(type.get(), text.size()) < 0 ||
      H5Tset_strpad(type.get(), H5T_STR_NULLPAD) < 0 ||
      H5Tset_cset(type.get(), H5T_CSET_UTF8) < 0) {
    return false;
  }
  const Hdf5Handle attribute(
      H5Acreate2(object, name.c_str(), type.get(), space.get(), H5P_DEFAULT, H5P_DEFAULT),
      H5Aclose);
  return attribute && H5Awrite(attribute.get(), type.get(), text.data()) >= 0;
}

}  // namespace imunoise::recording
