#pragma once

// An index of many recordings and their calibrations. The files are the truth: it may be deleted at
// any time and is then made again from them.

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "core/support/progress.h"
#include "daemon/catalogue/integrity.h"
#include "daemon/catalogue/scan.h"
#include "imunoise/v1/catalogue.pb.h"
#include "recording/store/disk/file_system.h"

namespace imunoise::catalogue {

/// Where the catalogue of a folder lies: catalogue.sqlite in it, or in memory where that cannot be
/// written or is itself a recording.
std::string place_in(const std::filesystem::path& root);

/// What an update did.
struct Changes {
  std::size_t added = 0;  ///< new, or said something else than before
  std::size_t unchanged = 0;
  std::size_t removed = 0;
  friend bool operator==(const Changes&, const Changes&) = default;
};

/// A parameter of a device over time, oldest first.
using Parameters = std::vector<v1::ParameterHistory>;

/// One thread at a time. Errors: the database's.
class Catalogue {
 public:
  /// `where` as Database::open() takes it. Recordings are known by their bench and folder: several
  /// benches share one PostgreSQL.
  static Result<Catalogue> open(const std::string& where, std::string bench = "");

  /// Reads what is new or says something else in the recordings under `root`, and forgets what is
  /// gone, of this bench. Each recording is taken whole or not at all. Error: also a root that
  /// cannot be listed, or the caller stopped it.
  Result<Changes> refresh(const recording::FileSystem& files, const std::filesystem::path& root,
                          const Progress& progress = {});
  /// The same after forgetting everything of this bench.
  Result<Changes> rebuild(const recording::FileSystem& files, const std::filesystem::path& root,
                          const Progress& progress = {});

  /// What was found damaged when it was opened, and what became of that; empty: nothing was. The
  /// next refresh() reads again what is missing now.
  const std::string& repair() const { return repair_; }

  /// What is refreshed and rebuilt from now on belongs to this bench.
  void use_bench(std::string bench) { bench_ = std::move(bench); }

  /// Of all benches, oldest first.
  Result<v1::RecordingList> recordings();
  Result<v1::CalibrationList> calibrations();

  /// The device of this id, serial number, or name in a recording. Error: there is none (those
  /// known are listed), or several.
  Result<v1::CataloguedDevice> device(const std::string& wanted);
  /// All devices, by id, as they were recorded last.
  Result<std::vector<v1::CataloguedDevice>> devices();
  /// What every calibration said of a device.
  Result<Parameters> parameters(const std::string& device_id);

 private:
  Catalogue(SoundDatabase sound, std::string bench)
      : database_(std::move(sound.database)),
        repair_(std::move(sound.repair)),
        bench_(std::move(bench)) {}
  struct AllDevices {
    std::map<std::string, v1::CataloguedDevice> newest;  // by id, as it was recorded last
    std::map<std::string, std::set<std::string>> ids;    // by serial number and by name
  };
  Result<AllDevices> all_devices();
  Result<bool> put(const Found& found, const std::function<void()>& again);
  // Programs that write about one bench do so one after the other.
  std::string lock() const { return "bench " + bench_; }

  std::unique_ptr<Database> database_;
  std::string repair_;
  std::string bench_;
};

}  // namespace imunoise::catalogue
