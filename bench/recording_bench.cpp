// Recordings on disk: values a second into chunk files, bytes a value, and the time of reading
// back. Real counts where they lie beside the project (ADIS16405), else rounded normal numbers.

#include <benchmark/benchmark.h>
#include <stdlib.h>

#include <cmath>
#include <filesystem>
#include <random>

#include "recording/import/import.h"
#include "recording/store/reading/device_recording.h"
#include "recording/store/recorder/recorder.h"

namespace imunoise::recording {
namespace {

constexpr std::size_t kRows = 1'000'000;
constexpr std::size_t kBlockRows = 1000;
constexpr std::uint32_t kReplicates = 6;

using Counts = std::vector<std::int16_t>;

// Three axes of a million counts.
const std::vector<Counts>& counts(std::uint32_t replicate) {
  static std::vector<std::vector<Counts>> all = [] {
    std::vector<std::vector<Counts>> out;
    const std::filesystem::path folder =
        std::filesystem::path(IMUNOISE_SHARED_DIR) / "data/adis16405";
    for (std::uint32_t i = 1; i <= kReplicates; ++i) {
      std::vector<Counts> axes;
      const std::vector<std::filesystem::path> file = {
          folder / ("replicate" + std::to_string(i) + "_gyro.h5")};
      if (const auto got = import_files(file)) {
        for (const Channel& channel : got->front().channels) {
          axes.push_back(std::get<Counts>(*channel.samples));
        }
      } else {
        std::mt19937_64 engine(i);
        std::normal_distribution<double> normal(0.0, 12.0);
        axes.assign(3, Counts(kRows));
        for (Counts& axis : axes) {
          for (auto& count : axis) count = static_cast<std::int16_t>(std::lround(normal(engine)));
        }
      }
      out.push_back(std::move(axes));
    }
    return out;
  }();
  return all[replicate];
}

// A device of so many channels, which repeat the three axes.
v1::RecordedDevice device(std::size_t channels) {
  v1::RecordedDevice out;
  out.set_name("imu0");
  v1::RecordedStream& stream = *out.add_streams();
  stream.set_name("imu");
  stream.set_rate_hz(100.0);
  stream.set_counter_modulus(65536);
  for (std::size_t i = 0; i < channels; ++i) {
    v1::RecordedChannel& channel = *stream.add_channels();
    channel.set_name("axis" + std::to_string(i));
    channel.set_dtype("<i2");
    channel.set_units("deg/s");
    channel.set_scale_factor(0.05);
  }
  return out;
}

// Blocks of one replicate: counter, and host times that are late by up to `late_ns`.
std::vector<Block> blocks(std::uint32_t replicate, std::size_t channels, std::int64_t late_ns) {
  std::mt19937_64 engine(replicate);
  std::uniform_int_distribution<std::int64_t> late(0, late_ns);
  const std::vector<Counts>& axes = counts(replicate);
  const v1::RecordedDevice described = device(channels);
  std::vector<Block> out;
  for (std::size_t first = 0; first + kBlockRows <= axes[0].size(); first += kBlockRows) {
    Block block{0, empty_rows(described.streams(0))};
    Rows& rows = block.rows;
    for (std::size_t i = first; i < first + kBlockRows; ++i) {
      const auto at = static_cast<std::int64_t>(i);
      rows.host_time.push_back(1'700'000'000'000'000'000 + at * 10'000'000 + late(engine));
      rows.counter.push_back(at % 65536);
      rows.flags.push_back(0);
    }
    for (std::size_t c = 0; c < channels; ++c) {
      std::get<Counts>(rows.channels[c])
          .assign(axes[c % 3].begin() + static_cast<std::ptrdiff_t>(first),
                  axes[c % 3].begin() + static_cast<std::ptrdiff_t>(first + kBlockRows));
    }
    rows.received = rows.size();
    out.push_back(std::move(block));
  }
  return out;
}

class Folder {
 public:
  Folder() {
    std::string pattern = (std::filesystem::temp_directory_path() / "imunoise-XXXXXX").string();
    path_ = ::mkdtemp(pattern.data());
  }
  ~Folder() { std::filesystem::remove_all(path_); }
  std::filesystem::path path() const { return path_ / "run"; }

 private:
  std::filesystem::path path_;
};

bool record(const std::filesystem::path& root, std::uint32_t replicate,
            const std::vector<Block>& all) {
  RecordingPlan plan;
  plan.replicate = replicate + 1;
  plan.devices = {device(all.front().rows.channels.size())};
  const auto recorder = Recorder::start(posix_file_system(), root, plan);
  if (!recorder) return false;
  for (const Block& block : all) {
    if (!(*recorder)->push(0, block)) return false;
  }
  return (*recorder)->close().has_value();
}

// Journal, chunk, every sync: from the first block handed over until everything is in chunks.
void write_recording(benchmark::State& state) {
  const auto channels = static_cast<std::size_t>(state.range(0));
  const std::vector<Block> all = blocks(0, channels, state.range(1));
  std::uintmax_t bytes = 0;
  for (auto _ : state) {
    const Folder folder;
    if (!record(folder.path(), 0, all)) state.SkipWithError("cannot record");
    state.PauseTiming();
    bytes = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder.path())) {
      if (entry.path().extension() == ".h5") bytes += entry.file_size();
    }
    state.ResumeTiming();
  }
  const double values = static_cast<double>(channels * all.size() * kBlockRows);
  state.counters["values/s"] = benchmark::Counter(values * static_cast<double>(state.iterations()),
                                                  benchmark::Counter::kIsRate);
  state.counters["bytes/value"] = static_cast<double>(bytes) / values;
}
BENCHMARK(write_recording)
    ->ArgNames({"channels", "late_ns"})
    ->Args({3, 0})
    ->Args({3, 100'000})
    ->Args({10, 100'000})
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();

// Six replicates of three channels of a million counts, checksums and all.
void read_recording(benchmark::State& state) {
  const Folder folder;
  for (std::uint32_t i = 0; i < kReplicates; ++i) {
    if (!record(folder.path(), i, blocks(i, 3, 100'000))) state.SkipWithError("cannot record");
  }
  const FileSystem& files = posix_file_system();
  for (auto _ : state) {
    const auto manifest = read_manifest(files, folder.path());
    std::size_t rows = 0;
    const auto folders = find_device_folders(files, folder.path());
    for (const DeviceFolder& where : *folders) {
      rows += read_device(files, where, **manifest)->streams[0].size();
    }
    if (rows != kReplicates * kRows) state.SkipWithError("rows are missing");
  }
}
BENCHMARK(read_recording)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();

}  // namespace
}  // namespace imunoise::recording
