// The start of a replicate, beside those that the recording has already: two devices, two chunks of
// each in every replicate. And what the whole manifest costs, which grows with them.

#include <benchmark/benchmark.h>
#include <stdlib.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>

#include "recording/store/recorder/recorder.h"

namespace imunoise::recording {
namespace {

constexpr std::size_t kDevices = 2;
constexpr int kChunks = 2;
constexpr int kRows = 100;
constexpr std::int64_t kBegin = 1'700'000'000'000'000'000;  // ns

v1::RecordedDevice small_imu(std::size_t number) {
  v1::RecordedDevice out;
  out.set_name("imu" + std::to_string(number));
  out.set_driver("adis16405");
  out.set_serial("000" + std::to_string(number));
  v1::RecordedStream& stream = *out.add_streams();
  stream.set_name("imu");
  stream.set_rate_hz(100.0);
  for (const char* const name : {"gyro_x", "gyro_y", "gyro_z", "acc_x", "acc_y", "acc_z"}) {
    v1::RecordedChannel& channel = *stream.add_channels();
    channel.set_name(name);
    channel.set_dtype("<i2");
    channel.set_scale_factor(0.05);
  }
  return out;
}

Block small_block(const v1::RecordedDevice& device) {
  Block out{0, empty_rows(device.streams(0))};
  for (int i = 0; i < kRows; ++i) {
    out.rows.host_time.push_back(kBegin + std::int64_t{i} * 10'000'000);
    out.rows.flags.push_back(0);
  }
  for (Numbers& channel : out.rows.channels)
    std::get<std::vector<std::int16_t>>(channel).assign(kRows, 7);
  out.rows.received = out.rows.size();
  return out;
}

// A recording that grows by a replicate at a time.
class GrowingRecording {
 public:
  GrowingRecording() {
    std::string pattern = (std::filesystem::temp_directory_path() / "imunoise-XXXXXX").string();
    folder_ = ::mkdtemp(pattern.data());
    plan_.campaign = "bench";
    plan_.started_ns = kBegin;
    for (std::size_t i = 0; i < kDevices; ++i) plan_.devices.push_back(small_imu(i));
    plan_.note = v1::ReplicateNote();
    options_.sync_every = {};
    options_.segments.bytes = 1;  // a chunk each block
  }
  ~GrowingRecording() { std::filesystem::remove_all(folder_); }
  GrowingRecording(const GrowingRecording&) = delete;
  GrowingRecording& operator=(const GrowingRecording&) = delete;

  std::filesystem::path folder() const { return folder_ / "run"; }
  std::uint32_t replicates() const { return plan_.replicate - 1; }
  // Records the next one; how long its start took, in s, or nothing.
  std::optional<double> record_one() {
    const auto before = std::chrono::steady_clock::now();
    const auto recorder = Recorder::start(posix_file_system(), folder_ / "run", plan_, options_);
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - before;
    if (!recorder) return std::nullopt;
    for (int chunk = 0; chunk < kChunks; ++chunk) {
      for (std::size_t i = 0; i < kDevices; ++i) {
        if (!(*recorder)->push(i, small_block(plan_.devices[i]))) return std::nullopt;
      }
      while ((*recorder)->state().acknowledged.back() < static_cast<std::uint64_t>(chunk) + 1) {
      }
    }
    v1::ReplicateNote note;
    note.set_state(v1::complete);
    if (!(*recorder)->close([&](const RecorderState&) { return note; })) return std::nullopt;
    ++plan_.replicate;
    return took.count();
  }

 private:
  std::filesystem::path folder_;
  RecordingPlan plan_;
  RecorderOptions options_;
};

GrowingRecording& growing_recording() {
  static GrowingRecording out;
  return out;
}

void start_of_replicate(benchmark::State& state) {
  GrowingRecording& recording = growing_recording();
  while (recording.replicates() + 1 < state.range(0)) {
    if (!recording.record_one()) return state.SkipWithError("cannot record");
  }
  for (auto _ : state) {
    const auto took = recording.record_one();
    if (!took) return state.SkipWithError("cannot record");
    state.SetIterationTime(*took);
  }
}
BENCHMARK(start_of_replicate)
    ->Arg(2)
    ->Arg(100)
    ->Arg(1000)
    ->Iterations(20)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);

void whole_manifest_of(benchmark::State& state) {
  GrowingRecording& recording = growing_recording();
  while (recording.replicates() < state.range(0)) {
    if (!recording.record_one()) return state.SkipWithError("cannot record");
  }
  for (auto _ : state) {
    if (!read_manifest(posix_file_system(), recording.folder())) state.SkipWithError("no manifest");
  }
}
BENCHMARK(whole_manifest_of)->Arg(1000)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace imunoise::recording
