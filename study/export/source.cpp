#include "study/export/source.h"

#include <fmt/format.h>
#include <google/protobuf/util/json_util.h>

#include <algorithm>
#include <set>

#include "recording/import/table/names.h"
#include "study/calibration/calibration_file.h"

namespace imunoise::study {
namespace {

template <class Message>
bool reads(const std::string& text, Message& to) {
  google::protobuf::util::JsonParseOptions strict;
  strict.ignore_unknown_fields = false;
  return google::protobuf::util::JsonStringToMessage(text, &to, strict).ok();
}

}  // namespace

std::vector<SourceFit> fits_of(const v1::Calibration& calibration) {
  std::vector<SourceFit> out;
  for (const v1::ChannelCalibration& one : calibration.channels()) {
    if (!one.has_fit()) continue;
    out.push_back({one.device(), one.fit()});
    out.back().fit.set_channel(one.channel());
    *out.back().fit.mutable_spread() = one.stationarity().spread();
  }
  return out;
}

Result<std::vector<SourceFit>> parse_fits(const std::string& text) {
  std::vector<SourceFit> out;
  v1::FitReport one;
  v1::FitReports several;
  if (const auto calibration = parse_calibration(text)) {
    out = fits_of(*calibration);
  } else if (reads(text, one)) {
    out.push_back({"", one});
  } else if (reads(text, several)) {
    for (const v1::FitReport& fit : several.channels()) out.push_back({"", fit});
  } else {
    return fail(
        "not the JSON of imunoise calibrate, fit or array; write it with imunoise calibrate "
        "FILES... --json");
  }
  if (out.empty()) return fail("no channel has a fit; see the troubles in the calibration");
  return out;
}

std::optional<v1::ArrayReport> parse_array(const std::string& text) {
  v1::ArrayReport out;
  if (!reads(text, out) || out.sensors().empty()) return std::nullopt;
  return out;
}

Result<std::vector<SourceFit>> chosen_fits(const std::vector<SourceFit>& fits,
                                           const std::string& device,
                                           const std::vector<std::string>& channels) {
  std::set<std::string> devices;
  for (const SourceFit& one : fits) devices.insert(one.device);
  const auto list = [&] {
    std::string out;
    for (const std::string& one : devices) out += (out.empty() ? "" : ", ") + one;
    return out;
  };
  if (device.empty() && devices.size() > 1)
    return fail(fmt::format("several devices; choose one with --device ({})", list()));
  if (!device.empty() && !devices.contains(device))
    return fail(fmt::format("no device '{}' (known: {})", device, list()));
  if (fits.empty()) return fail("no channel has a fit");
  std::vector<SourceFit> out;
  std::string known;
  for (const SourceFit& one : fits) {
    if (!device.empty() && one.device != device) continue;
    known += (known.empty() ? "" : ", ") + one.fit.channel();
    const bool wanted =
        channels.empty() || std::any_of(channels.begin(), channels.end(), [&](const auto& name) {
          return recording::matches(name, one.fit.channel());
        });
    if (wanted) out.push_back(one);
  }
  if (out.empty()) return fail(fmt::format("no such channel with a fit (known: {})", known));
  return out;
}

}  // namespace imunoise::study
