#include "study/calibration/calibrate_array.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "recording/store/reading/across.h"
#include "study/analysis/arrays/array_series.h"
#include "study/calibration/calibrate_channel.h"

namespace imunoise::study {
namespace {

constexpr std::array kInertial = {Quantity::kAngularRate, Quantity::kAcceleration};

// What the sensors say together, or why they cannot.
void fit_array_of(const std::vector<Series>& sensors, const CalibrateOptions& options,
                  const Progress& progress, v1::ArrayCalibration& to) {
  ArraySeriesOptions how;
  how.model = options.array_model;
  for (const Series& one : sensors) to.add_channels(one.channel);
  auto report = array_series(sensors, how, progress);
  if (report) {
    *to.mutable_report() = std::move(*report);
  } else {
    add_trouble("array", report.error(), *to.mutable_troubles());
  }
}

// What one axis of all devices is called.
struct Role {
  Quantity quantity = Quantity::kUnknown;
  std::string name;
  std::vector<std::string> channels;
  std::vector<std::string> devices;  // each once
};

// "imu0/imu/gyro_x" is a gyro_x.
std::string name_in_stream(const std::string& channel) {
  return channel.substr(channel.rfind('/') + 1);
}

// In the order in which they first come, angular rates first.
std::vector<Role> roles_of(const std::vector<recording::ImportedStream>& streams) {
  std::vector<Role> out;
  for (const Quantity quantity : kInertial) {
    for (const recording::ImportedStream& stream : streams) {
      for (const recording::ImportedChannel& channel : stream.channels) {
        const auto unit = parse_unit(channel.units);
        if (!unit || unit->quantity != quantity) continue;
        const std::string name = name_in_stream(channel.name);
        auto to = std::find_if(out.begin(), out.end(), [&](const Role& one) {
          return one.quantity == quantity && one.name == name;
        });
        if (to == out.end()) to = out.insert(to, {quantity, name, {}, {}});
        to->channels.push_back(channel.name);
        if (to->devices.empty() || to->devices.back() != stream.device)
          to->devices.push_back(stream.device);
      }
    }
  }
  std::erase_if(out, [](const Role& one) { return one.devices.size() < 2; });
  return out;
}

v1::ArrayJoin join_of(const recording::Across& across) {
  v1::ArrayJoin out;
  for (const recording::JoinedStream& one : across.streams) {
    v1::JoinedStream& to = *out.add_streams();
    to.set_device(one.device);
    to.set_stream(one.stream);
    to.set_rate_hz(one.rate.value);
    to.set_clock_ppm(one.clock_ppm);
    to.set_seconds(one.seconds);
    to.set_averaged(static_cast<std::uint32_t>(one.averaged));
    to.set_dropped(one.dropped);
  }
  out.set_seconds(across.seconds);
  return out;
}

v1::ArrayCalibration array_of(const recording::Across& across, const CalibrateOptions& options,
                              const Progress& progress) {
  v1::ArrayCalibration out;
  for (const recording::LeftOut& one : across.left_out) {
    add_trouble("join", Error{fmt::format("{}/{}: {}", one.device, one.stream, one.reason)},
                *out.mutable_troubles());
  }
  if (across.replicates.empty()) {
    out.mutable_channels()->Assign(across.channels.begin(), across.channels.end());
    return out;
  }
  *out.mutable_join() = join_of(across);
  std::vector<Series> sensors;
  for (std::size_t c = 0; c < across.channels.size(); ++c)
    sensors.push_back(series_of(across.replicates, c));
  fit_array_of(sensors, options, progress, out);
  return out;
}

// One array for each rate that several devices have.
std::vector<v1::ArrayCalibration> arrays_of_role(const recording::FileSystem& files,
                                                 const std::filesystem::path& folder,
                                                 const Role& role, const CalibrateOptions& options,
                                                 const Progress& progress) {
  std::vector<v1::ArrayCalibration> out;
  const auto groups =
      recording::import_across(files, folder, role.channels, progress.part(0.0, 0.5));
  if (!groups) {
    v1::ArrayCalibration& none = out.emplace_back();
    none.mutable_channels()->Assign(role.channels.begin(), role.channels.end());
    add_trouble("join", groups.error(), *none.mutable_troubles());
    return out;
  }
  for (const recording::Across& one : *groups)
    out.push_back(array_of(one, options, progress.part(0.5, 1.0)));
  return out;
}

}  // namespace

std::vector<v1::ArrayCalibration> arrays_of_stream(
    const std::vector<recording::Replicate>& replicates, const std::vector<std::size_t>& channels,
    const CalibrateOptions& options, const Progress& progress) {
  std::vector<v1::ArrayCalibration> out;
  for (const Quantity quantity : kInertial) {
    std::vector<Series> sensors;
    for (const std::size_t c : channels) {
      if (replicates.front().channels[c].unit.quantity == quantity)
        sensors.push_back(series_of(replicates, c));
    }
    if (sensors.size() > 1) fit_array_of(sensors, options, progress, out.emplace_back());
  }
  return out;
}

std::vector<v1::ArrayCalibration> arrays_across(
    const recording::FileSystem& files, const std::filesystem::path& folder,
    const std::vector<recording::ImportedStream>& streams, const CalibrateOptions& options,
    const Progress& progress) {
  const std::vector<Role> roles = roles_of(streams);
  const auto count = static_cast<double>(roles.size());
  std::vector<v1::ArrayCalibration> out;
  for (std::size_t r = 0; r < roles.size() && !progress.stopped(); ++r) {
    const Progress part =
        progress.part(static_cast<double>(r) / count, static_cast<double>(r + 1) / count);
    for (v1::ArrayCalibration& one : arrays_of_role(files, folder, roles[r], options, part))
      out.push_back(std::move(one));
  }
  return out;
}

}  // namespace imunoise::study
