// Replay through the plugin: how fast numbers come, and what many devices at real time cost.

#include <benchmark/benchmark.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "drivers/host/device.h"
#include "drivers/host/load.h"

namespace imunoise {
namespace {

using namespace std::chrono_literals;
constexpr std::size_t kChannels = 10;

// Ten channels of counts at 1 kHz; removed at the end.
class CountsFile {
 public:
  explicit CountsFile(std::size_t rows)
      : path_(std::filesystem::temp_directory_path() / "imunoise_replay_bench.i16") {
    std::vector<std::int16_t> numbers(rows * kChannels);
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      numbers[i] = static_cast<std::int16_t>(i * 7919);
    }
    std::ofstream(path_, std::ios::binary)
        .write(static_cast<const char*>(static_cast<const void*>(numbers.data())),
               static_cast<std::streamsize>(numbers.size() * sizeof(std::int16_t)));
    std::string channels;
    for (std::size_t c = 0; c < kChannels; ++c) {
      channels += (c > 0 ? ",{\"name\":\"c" : "{\"name\":\"c") + std::to_string(c) + "\"}";
    }
    std::ofstream(sidecar()) << R"({"rate_hz": 1000, "channels": [)" << channels << "]}";
  }
  ~CountsFile() {
    std::filesystem::remove(path_);
    std::filesystem::remove(sidecar());
  }
  CountsFile(const CountsFile&) = delete;
  CountsFile& operator=(const CountsFile&) = delete;

  std::unique_ptr<drivers::Device> replay(const std::string& speed) const {
    static const drivers::Drivers kDrivers = drivers::load_drivers(drivers::driver_folders());
    const std::vector<drivers::OptionText> options = {{"file", path_.string()}, {"speed", speed}};
    return std::move(*drivers::Device::open(**kDrivers.find("replay"), options));
  }

 private:
  std::filesystem::path sidecar() const { return path_.string() + ".json"; }
  std::filesystem::path path_;
};

void as_fast_as_possible(benchmark::State& state) {
  const CountsFile file(1'000'000);
  std::int64_t values = 0;
  for (auto _ : state) {
    state.PauseTiming();
    const auto device = file.replay("0");
    drivers::SampleBlock block = device->make_block(4096);
    state.ResumeTiming();
    while (*device->read(1s, block) == drivers::ReadOutcome::kSamples) {
      benchmark::DoNotOptimize(block.column<std::int16_t>(0).data());
      values += static_cast<std::int64_t>(block.rows() * kChannels);
    }
  }
  state.counters["values/s"] =
      benchmark::Counter(static_cast<double>(values), benchmark::Counter::kIsRate);
}
BENCHMARK(as_fast_as_possible)->Unit(benchmark::kMillisecond);

// One thread reads 64 devices in turn for two seconds of real time; look at CPU over wall time.
void sixty_four_at_real_time(benchmark::State& state) {
  const CountsFile file(2000);
  std::size_t rows = 0;
  for (auto _ : state) {
    std::vector<std::unique_ptr<drivers::Device>> devices;
    for (int i = 0; i < 64; ++i) devices.push_back(file.replay("1"));
    std::vector<drivers::SampleBlock> blocks;
    for (const auto& device : devices) blocks.push_back(device->make_block(1024));
    for (std::size_t over = 0; over < devices.size();) {
      over = 0;
      for (std::size_t i = 0; i < devices.size(); ++i) {
        const auto outcome = *devices[i]->read(10ms, blocks[i]);
        over += outcome == drivers::ReadOutcome::kEnd ? 1U : 0U;
        rows += blocks[i].rows();
      }
    }
  }
  state.counters["rows"] = static_cast<double>(rows);
}
BENCHMARK(sixty_four_at_real_time)->Iterations(1)->UseRealTime()->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace imunoise
