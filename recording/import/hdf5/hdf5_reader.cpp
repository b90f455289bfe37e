#include "recording/import/hdf5/hdf5_reader.h"

#include <algorithm>
#include <utility>

#include "recording/hdf5/attributes.h"
#include "recording/import/hdf5/hdf5_dataset.h"
#include "recording/import/table/select.h"

namespace imunoise::recording {
namespace {

// Names of the datasets in the root group, sorted. Links to elsewhere are not followed: an external
// one could name any file of the disk.
std::vector<std::string> dataset_names(hid_t file) {
  std::vector<std::string> names;
  const auto visit = [](hid_t group, const char* name, const H5L_info_t* link,
                        void* out) -> herr_t {
    auto& found = *static_cast<std::vector<std::string>*>(out);
    H5O_info_t object = {};
    if (link->type == H5L_TYPE_HARD && found.size() <= kMaximumColumns &&
        H5Oget_info_by_name2(group, name, &object, H5O_INFO_BASIC, H5P_DEFAULT) >= 0 &&
        object.type == H5O_TYPE_DATASET) {
      found.emplace_back(name);
    }
    return 0;
  };
  H5Literate(file, H5_INDEX_NAME, H5_ITER_NATIVE, nullptr, visit, &names);
  std::sort(names.begin(), names.end());
  return names;
}

Hdf5Column column_of(hid_t file, const std::string& name) {
  Hdf5Column out;
  out.name = name;
  const Result<Hdf5Dataset> dataset = Hdf5Dataset::open(file, name);
  if (!dataset) {
    out.trouble = dataset.error().message;
    return out;
  }
  out.size = dataset->size();
  out.scale = read_number_attribute(dataset->id(), "scale_factor");
  out.offset = read_number_attribute(dataset->id(), "add_offset");
  out.unit = read_string_attribute(dataset->id(), "units");
  return out;
}

}  // namespace

Result<std::unique_ptr<Hdf5Source>> Hdf5Source::open(const std::filesystem::path& path) {
  const QuietHdf5 quiet;
  auto out = std::make_unique<Hdf5Source>();
  out->file_ = {H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose};
  if (!out->file_) {
    return fail("HDF5 cannot open it: truncated, damaged or still being written; copy it again");
  }
  out->facts_.rate = read_number_attribute(out->file_.get(), "rate_hz");
  for (const std::string& name : dataset_names(out->file_.get()))
    out->facts_.datasets.push_back(column_of(out->file_.get(), name));
  return out;
}

Result<Samples> Hdf5Source::read(std::size_t dataset) {
  const QuietHdf5 quiet;
  const auto opened = Hdf5Dataset::open(file_.get(), facts_.datasets.at(dataset).name);
  if (!opened) return tl::make_unexpected(opened.error());
  return opened->read();
}

}  // namespace imunoise::recording
