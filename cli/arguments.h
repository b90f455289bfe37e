#pragma once

// What the user asked for. CLI11 is slow to compile: it lives in cli/parse alone.

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "cli/client/daemon_client.h"
#include "cli/show.h"
#include "core/wavelet/deviation.h"
#include "daemon/catalogue/history.h"
#include "drivers/codec/wire_format.h"
#include "drivers/emulator/serving/serve.h"
#include "imunoise/v1/batch.pb.h"
#include "imunoise/v1/study.pb.h"
#include "recording/import/import.h"
#include "study/analysis/arrays/array_series.h"
#include "study/analysis/arrays/fault_series.h"
#include "study/analysis/arrays/mixed_series.h"
#include "study/analysis/diagnose_series.h"
#include "study/analysis/dynamic_series.h"
#include "study/analysis/fit_series.h"
#include "study/analysis/select_model.h"
#include "study/analysis/test_series.h"
#include "study/calibration/calibrate.h"
#include "study/deviation/printed.h"
#include "study/export/export.h"

namespace imunoise::cli {

/// Where measurements come from.
struct InputArguments {
  std::vector<std::filesystem::path> files;
  recording::ImportOptions import;
};

struct WvArguments {
  InputArguments input;
  study::MeasureOptions measure;
  std::optional<DeviationKind> deviation;  ///< instead of the wavelet variance
  ShowArguments show;                      ///< its page: of deviations alone
  std::optional<std::filesystem::path> svg;
};

/// Figures of a data sheet, and what they are compared with.
struct DatasheetArguments {
  InputArguments input;  ///< no files: the figures alone, at the rate given
  std::optional<study::PrintedFigures> gyro;
  std::optional<study::PrintedFigures> accelerometer;
  double confidence = 0.95;
  ShowArguments show;
  std::optional<std::filesystem::path> svg;
};

struct FitArguments {
  InputArguments input;
  study::FitOptions fit;
  bool json = false;
  std::optional<std::filesystem::path> report;  ///< HTML page
  std::optional<std::filesystem::path> svg;     ///< picture for papers
  bool fail_if_misfit = false;                  ///< exit status 3 if a model does not fit
};

/// A channel that a simulation has beside its own, for effects to follow.
struct WitnessArguments {
  std::string name;
  Unit unit;
  std::string model;                         ///< of its noise, in SI; or
  std::vector<std::filesystem::path> files;  ///< where it is: one for all replicates, or one each
};

struct SimulateArguments {
  std::string model;
  std::vector<WitnessArguments> witnesses;
  Hertz rate;
  std::size_t samples = 0;
  std::uint32_t replicates = 1;
  std::uint64_t seed = 1;
  Unit unit;
  std::string channel = "x";
  std::filesystem::path out;
  bool json = false;
};

struct TestArguments {
  InputArguments input;
  study::TestOptions test;
  ShowArguments show;
};

struct SelectArguments {
  InputArguments input;
  study::SelectOptions select;
  ShowArguments show;
};

struct ArrayArguments {
  InputArguments input;
  study::ArraySeriesOptions array;
  ShowArguments show;
};

struct MixedArguments {
  InputArguments input;
  study::MixedSeriesOptions mixed;
  ShowArguments show;
};

struct DynamicArguments {
  InputArguments input;
  study::DynamicOptions dynamic;
  ShowArguments show;
};

struct DiagnoseArguments {
  InputArguments input;
  std::vector<std::string> channels;  ///< to be diagnosed; empty: those of the first one's quantity
  study::DiagnoseOptions diagnose;
  ShowArguments show;
  std::optional<std::filesystem::path> svg{};  ///< pictures for papers, before and after
};

/// One operation on a study's file.
struct StudyArguments {
  std::filesystem::path file;
  v1::StudyRequest request;  ///< no operation: only show it
  ShowArguments show;
};

/// The page, on files or a study.
struct OpenArguments {
  v1::StudyInput input;  ///< what studies can be made of; no files: only look at studies
  std::vector<std::string> channels;  ///< to be shown; empty: all
  std::string study;                  ///< the name of the one to begin with; empty: none
  std::filesystem::path studies;      ///< their folder; empty: the user's
  std::uint16_t port = 0;             ///< 0: one that is free
  bool browser = true;
};

struct FaultsArguments {
  InputArguments input;
  InputArguments training;  ///< read like the input; no files: the model is fitted to the input
  study::FaultSeriesOptions faults;
  ShowArguments show;
};

/// A device to record: a driver and its options, "name=value".
struct DeviceArguments {
  std::string driver;
  std::vector<std::string> options;
};

struct RecordArguments {
  std::filesystem::path folder;
  std::vector<DeviceArguments> devices;
  std::optional<std::chrono::duration<double>> duration;  ///< unset: until the devices end
  std::uint32_t replicates = 1;
  std::optional<std::uint32_t> replicate;             ///< number of the first; unset: the next free
  std::vector<std::filesystem::path> driver_folders;  ///< searched before all others
  bool wire = false;                                  ///< the bytes of each device as well
  bool json = false;
};

struct EmulateArguments {
  emulator::ServePlan plan;
  std::optional<std::chrono::duration<double>> duration;  ///< unset: until it is interrupted
};

struct DriversArguments {
  std::vector<std::filesystem::path> folders;  ///< searched before all others
  bool json = false;
  bool names_only = false;
};

struct DecodeArguments {
  drivers::WireFormat format = drivers::WireFormat::kXbus;
  std::string file;                          ///< "-": standard input
  std::optional<std::filesystem::path> dbc;  ///< candump: a database, or
  std::string preset;                        ///< the name of a known IMU.
  std::uint16_t sens_avg = 0;                ///< adis16405: registers at the time of recording
  std::uint16_t smpl_prd = 0;
  bool json = false;
};

struct VerifyArguments {
  std::filesystem::path path;  ///< a recording's folder, or one chunk file
  bool repair = false;
  bool json = false;
};

/// The calibration of one recording, or of files.
struct CalibrateArguments {
  InputArguments input;
  study::CalibrateOptions calibrate;
  ShowArguments show;
};

/// Noise values in the form of another program.
struct ExportArguments {
  InputArguments input;  ///< one JSON file of fits, one folder of a recording, or recordings to fit
  std::vector<std::string> models;  ///< for recordings; as CalibrateOptions::models
  std::string to;                   ///< a consumer's name
  std::string device;               ///< in the source; empty: its only one
  study::ExportOptions options;
  std::optional<std::filesystem::path> out;  ///< unset: standard output
};

/// A folder of recordings and its index, or the recordings of a daemon.
struct CatalogueArguments {
  std::filesystem::path folder;          ///< empty: the daemon is asked
  std::optional<std::string> catalogue;  ///< unset: in the folder
  std::string bench;
  ShowArguments show;
  DaemonArguments daemon;
};
struct RecordingsArguments : CatalogueArguments {};
struct CalibrationsArguments : CatalogueArguments {};
struct HistoryArguments : CatalogueArguments {
  std::string device;
  catalogue::HistoryOptions history;
};

// What a running imunoised is asked.
struct DevicesArguments {
  DaemonArguments daemon;
  bool json = false;
};
struct CampaignsArguments : DevicesArguments {};
struct LiveArguments : DevicesArguments {};
struct StatusArguments : DevicesArguments {
  bool follow = false;
};
struct StartArguments : DevicesArguments {
  std::string campaign;
  bool once = false;
};
struct StopArguments : DevicesArguments {
  std::string campaign;
  std::string recording;  ///< that is to be interrupted; empty: none
};

/// A batch: made, run, one shard of it, looked at, put together.
struct BatchNewArguments {
  std::filesystem::path folder;
  v1::Batch batch;
};
struct BatchRunArguments {
  std::filesystem::path folder;
  bool slurm = false;                  ///< else child processes on this machine
  std::optional<std::size_t> workers;  ///< at once; unset: one a processor, or as Slurm likes
  std::uint32_t retries = 3;
  std::vector<std::string> sbatch;  ///< options for it
  ShowArguments show;
};
struct BatchShardArguments {
  std::filesystem::path folder;
  std::uint32_t number = 0;
};
struct BatchLookArguments {
  std::filesystem::path folder;
  ShowArguments show;
};
struct BatchStatusArguments : BatchLookArguments {};
struct BatchMergeArguments : BatchLookArguments {};

struct Arguments {
  using Command = std::variant<
      WvArguments, FitArguments, TestArguments, SelectArguments, ArrayArguments, MixedArguments,
      FaultsArguments, DynamicArguments, DiagnoseArguments, StudyArguments, OpenArguments,
      SimulateArguments, RecordArguments, VerifyArguments, EmulateArguments, DriversArguments,
      DecodeArguments, CalibrateArguments, ExportArguments, DatasheetArguments, RecordingsArguments,
      CalibrationsArguments, HistoryArguments, DevicesArguments, CampaignsArguments, LiveArguments,
      StatusArguments, StartArguments, StopArguments, BatchNewArguments, BatchRunArguments,
      BatchShardArguments, BatchStatusArguments, BatchMergeArguments>;
  Command command;
  std::optional<std::size_t> threads;
};

/// The arguments, or the exit status with which to end (help and usage errors are printed).
std::variant<Arguments, int> parse_arguments(int argc, const char* const* argv);

}  // namespace imunoise::cli
