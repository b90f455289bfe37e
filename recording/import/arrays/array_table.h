#pragma once

// A table made of named arrays, whose numbers come in the order in which a file holds them.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/support/result.h"
#include "recording/import/table/array_columns.h"
#include "recording/import/table/options.h"
#include "recording/import/table/table.h"

namespace imunoise::recording {

/// An array that a file offers.
struct NamedArray {
  std::string name;  ///< "imu.gyro"
  Shape shape;
  bool column_major = false;       ///< the numbers of one column lie together
  std::optional<double> number{};  ///< of an array of one number
};

/// The columns of arrays: which are wanted, and their numbers.
class ArrayTable {
 public:
  /// Chooses columns: those of the most common length, by their names (column_names()). An array
  /// named as a time column gives the times, one of a single number named fs or dt the rate. Error:
  /// see select_columns().
  static Result<ArrayTable> choose(std::string file, std::vector<NamedArray> arrays,
                                   const ImportOptions& options);

  bool wants(std::size_t array) const { return !wanted_[array].empty(); }
  /// The next number of a wanted array, as the file holds them one after the other.
  void take(std::size_t array, double number);
  /// The table. A first column that rises steadily is the time where nothing else tells it. Error:
  /// an array whose numbers were not all there.
  Result<Table> finish();

 private:
  static constexpr std::size_t kTime = static_cast<std::size_t>(-1);
  struct Part {
    std::size_t column = 0;  // of the array, across time
    std::size_t to = 0;      // in table_.columns, or kTime
  };

  ArrayTable(std::string file, std::vector<NamedArray> arrays, const ImportOptions& options)
      : file_(std::move(file)), arrays_(std::move(arrays)), options_(options) {}
  bool across(std::size_t array) const;
  std::size_t columns_of(std::size_t array) const;
  Result<void> choose_columns();
  void find_time_and_rate();

  std::string file_;
  std::vector<NamedArray> arrays_;
  ImportOptions options_;
  std::uint64_t length_ = 0;
  std::vector<std::vector<Part>> wanted_;  // of each array
  std::vector<std::uint64_t> taken_;       // numbers of each array
  std::vector<std::vector<double>> columns_;
  std::vector<double> times_;
  Table table_;
};

}  // namespace imunoise::recording
