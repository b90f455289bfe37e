#pragma once

// Numbers of one HDF5 dataset as columns.

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/support/result.h"
#include "recording/hdf5/handle.h"
#include "recording/import/table/array_columns.h"
#include "recording/import/table/channel.h"

namespace imunoise::recording {

/// An open dataset that is known to be readable: one or two dimensions of integers or floats (any
/// byte order), stored in the file itself, and not larger than the file can hold.
class Hdf5Dataset {
 public:
  /// `member`: of records (structured arrays), which numbers; else empty. Error, without the file's
  /// name: what the dataset is instead.
  static Result<Hdf5Dataset> open(hid_t file, const std::string& name,
                                  const std::string& member = "");

  /// What a dataset is by its form, readable or not.
  struct Form {
    bool known = false;                ///< false: it cannot be opened
    bool numbers = false;              ///< integers or floats
    int dimensions = 0;                ///< 0: one number
    std::optional<double> single;      ///< that number
    std::vector<std::string> members;  ///< of records in one dimension: those that are numbers
    /// A damaged one may have been.
    bool may_be_channels() const {
      return !known || (numbers && (dimensions == 1 || dimensions == 2));
    }
  };
  static Form form(hid_t file, const std::string& name);

  /// As the file has it: the second dimension runs faster.
  const Shape& shape() const { return shape_; }
  hid_t id() const { return dataset_.get(); }
  /// Column `column`; `across`: row `column`, where time is the second dimension. int16 and int32
  /// keep their type, all others become doubles. A number that equals the attribute _FillValue (CF:
  /// a missing sample) is a NaN, integers are then doubles. In pieces of whole chunks, about a
  /// million numbers each, all of one type, until `take` says false. Error: a chunk that cannot be
  /// read.
  Result<void> read(std::uint64_t column, bool across,
                    const std::function<bool(Samples piece)>& take) const;

 private:
  enum class Kind { kInt16, kInt32, kOther };

  Hdf5Dataset(std::string name, std::string member, Hdf5Handle dataset, Shape shape, Kind kind)
      : name_(std::move(name)),
        member_(std::move(member)),
        dataset_(std::move(dataset)),
        shape_(shape),
        kind_(kind) {}
  // Numbers of a column, or a row, as they are stored; `take` is given a piece of them.
  template <class Number>
  Result<void> each_piece(hid_t memory_type, std::uint64_t column, bool across,
                          const std::function<bool(std::vector<Number>& piece)>& take) const;
  // Whether integers equal `fill`.
  Result<bool> misses(double fill, std::uint64_t column, bool across) const;

  std::string name_;
  std::string member_;
  Hdf5Handle dataset_;
  Shape shape_;
  Kind kind_;
};

}  // namespace imunoise::recording
