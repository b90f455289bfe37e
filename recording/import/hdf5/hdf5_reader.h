#pragma once

// What an HDF5 file says: first of itself, then its numbers.

#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/support/result.h"
#include "recording/hdf5/handle.h"
#include "recording/import/table/channel.h"

namespace imunoise::recording {

/// An attribute: nothing where there is none, an error where it is of another kind.
template <class Value>
using Hdf5Attribute = Result<std::optional<Value>>;

/// A column of a dataset: of two dimensions, one of several.
struct Hdf5Column {
  std::string name;         ///< "gyro_x"
  std::string dataset;      ///< its path in the file
  std::string member;       ///< of records: which of their numbers
  std::uint64_t place = 0;  ///< of the column in the dataset
  bool across = false;      ///< time is the dataset's second dimension
  bool by_default = true;   ///< false beside matrices: another length, or no numbers
  std::string trouble;      ///< why it cannot be read as a column of numbers; else empty
  std::uint64_t size = 0;
  Hdf5Attribute<double> scale;
  Hdf5Attribute<double> offset;
  Hdf5Attribute<std::string> unit;
};

struct Hdf5Facts {
  Hdf5Attribute<double> rate;       ///< attribute rate_hz, else a dataset of one number
  std::string rate_from;            ///< for messages: "the root attribute rate_hz"
  std::vector<Hdf5Column> columns;  ///< by name of their dataset
};

/// A file that is being read. Errors do not name it.
class Hdf5Reader {
 public:
  virtual ~Hdf5Reader() = default;
  const Hdf5Facts& facts() const { return facts_; }
  /// All samples of a column without trouble. Error: see Hdf5Dataset::read.
  virtual Result<Samples> read(std::size_t column) = 0;

 protected:
  Hdf5Facts facts_;
};

/// Reads a file in this process, which a damaged file can crash: see open_hdf5_apart.
class Hdf5Source : public Hdf5Reader {
 public:
  static Result<std::unique_ptr<Hdf5Source>> open(const std::filesystem::path& path);
  Result<Samples> read(std::size_t column) override;
  /// The same piece by piece, see Hdf5Dataset::read.
  Result<void> read(std::size_t column, const std::function<bool(Samples piece)>& take);

 private:
  Hdf5Handle file_;
};

}  // namespace imunoise::recording
