#pragma once

// One HDF5 dataset as a column of numbers.

#include <string>

#include "core/support/result.h"
#include "recording/hdf5/handle.h"
#include "recording/import/table/channel.h"

namespace imunoise::recording {

/// An open dataset that is known to be readable: one dimension, int16, int32, float32 or float64
/// (any byte order), stored in the file itself, and not larger than the file can hold.
class Hdf5Dataset {
 public:
  /// Error, without the file's name: what the dataset is instead.
  static Result<Hdf5Dataset> open(hid_t file, const std::string& name);

  std::size_t size() const { return size_; }
  hid_t id() const { return dataset_.get(); }
  /// All samples; integers keep their type. One that equals the attribute _FillValue (CF: a missing
  /// sample) is a NaN, integers are then doubles. Error: a chunk that cannot be read.
  Result<Samples> read() const;

 private:
  enum class Kind { kInt16, kInt32, kFloat };

  Hdf5Dataset(std::string name, Hdf5Handle dataset, std::size_t size, Kind kind)
      : name_(std::move(name)), dataset_(std::move(dataset)), size_(size), kind_(kind) {}
  template <class Number>
  Result<Samples> read_as(hid_t memory_type) const;

  std::string name_;
  Hdf5Handle dataset_;
  std::size_t size_;
  Kind kind_;
};

}  // namespace imunoise::recording
