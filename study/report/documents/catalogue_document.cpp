#include <fmt/format.h>

#include <set>

#include "study/report/documents/catalogue_documents.h"
#include "study/report/view/coefficient_words.h"
#include "study/words/number.h"

namespace imunoise::report {
namespace {

std::string devices_of(const v1::CataloguedRecording& recording) {
  std::string out;
  for (const v1::CataloguedDevice& one : recording.devices())
    out += (out.empty() ? "" : ", ") +
           (one.serial().empty() ? one.name() : fmt::format("{} ({})", one.name(), one.serial()));
  return out;
}

std::string state_of(const v1::CataloguedRecording& recording) {
  if (!recording.trouble().empty()) return "not readable";
  if (!recording.closed()) return "open";
  return recording.calibrated() ? "calibrated" : "closed";
}

std::string state_of(const v1::CataloguedCalibration& calibration) {
  if (!calibration.trouble().empty()) return "not readable";
  return calibration.outdated() ? "outdated" : "current";
}

// A bench has a column where there are several.
template <class List>
bool of_benches(const List& list) {
  std::set<std::string> benches;
  for (const auto& one : list) benches.insert(one.bench());
  return benches.size() > 1 || (!benches.empty() && !benches.begin()->empty());
}

// The name of a channel is enough where one recording has no other of that name.
std::string name_in(const v1::ChannelNoise& one, const v1::CataloguedCalibration& calibration) {
  int same = 0;
  for (const v1::ChannelNoise& other : calibration.noise())
    same += other.channel() == one.channel() ? 1 : 0;
  return same > 1 ? fmt::format("{} of {}", one.channel(), one.device()) : one.channel();
}

Table noise_table(const v1::CalibrationList& list, Digits digits) {
  Table out{"Coefficients", {"folder", "channel", "model", "coefficients"}, {}};
  for (const v1::CataloguedCalibration& one : list.calibrations()) {
    for (const v1::ChannelNoise& of : one.noise()) {
      out.rows.push_back({one.bench().empty() ? one.folder() : one.bench() + ": " + one.folder(),
                          name_in(of, one), of.model(), short_words(of.coefficients(), digits)});
    }
  }
  return out;
}

Table noise_table(const v1::RecordingList& list, Digits digits) {
  Table out{"Largest coefficients of the calibrated channels", {"folder", "coefficients"}, {}};
  for (const v1::CataloguedRecording& one : list.recordings()) {
    if (one.noise().empty()) continue;
    out.rows.push_back({one.bench().empty() ? one.folder() : one.bench() + ": " + one.folder(),
                        short_words(one.noise(), digits)});
  }
  return out;
}

void put_bench_first(const std::string& bench, std::vector<std::string>& row) {
  row.insert(row.begin(), bench);
}

}  // namespace

Document document(const v1::RecordingList& list, Digits digits) {
  const bool benches = of_benches(list.recordings());
  Table table{"Recordings",
              {"started (UTC)", "folder", "devices", "replicates", "samples", "MB", "state"},
              {}};
  if (benches) put_bench_first("bench", table.head);
  Section section;
  int calibrated = 0;
  for (const v1::CataloguedRecording& one : list.recordings()) {
    calibrated += one.calibrated() ? 1 : 0;
    table.rows.push_back({minute(one.started_ns()), one.folder(), devices_of(one),
                          std::to_string(one.replicates()), count(one.samples(), digits),
                          number(static_cast<double>(one.bytes()) / 1e6, 3, digits),
                          state_of(one)});
    if (benches) put_bench_first(one.bench(), table.rows.back());
    if (!one.trouble().empty()) section.notes.push_back(one.trouble());
  }
  section.title = list.root();
  section.summary = list.recordings().empty()
                        ? "This folder has no recordings; imunoise record makes one."
                        : fmt::format("{}, {} of them calibrated.",
                                      counted(list.recordings_size(), "recording"), calibrated);
  section.tables = {std::move(table)};
  if (Table noise = noise_table(list, digits); !noise.rows.empty())
    section.tables.push_back(std::move(noise));
  return {"recordings", {section}};
}

Document document(const v1::CalibrationList& list, Digits digits) {
  const bool benches = of_benches(list.calibrations());
  Table table{"Calibrations",
              {"recorded (UTC)", "folder", "calibrated (UTC)", "model", "channels", "state"},
              {}};
  if (benches) put_bench_first("bench", table.head);
  Section section;
  for (const v1::CataloguedCalibration& one : list.calibrations()) {
    table.rows.push_back(
        {minute(one.started_ns()), one.folder(), minute(one.made_ns()),
         one.model().empty() ? "chosen" : one.model(),
         fmt::format("{} of {}", count(one.fitted(), digits), count(one.channels(), digits)),
         state_of(one)});
    if (benches) put_bench_first(one.bench(), table.rows.back());
    if (!one.trouble().empty()) section.notes.push_back(one.trouble());
    if (one.outdated()) {
      section.notes.push_back(
          fmt::format("{}: the recording changed since its calibration; run imunoise calibrate "
                      "again.",
                      one.folder()));
    }
  }
  section.title = list.root();
  section.summary = list.calibrations().empty()
                        ? "No recording in this folder is calibrated; run imunoise calibrate "
                          "RECORDING."
                        : counted(list.calibrations_size(), "calibration") + ".";
  section.tables = {std::move(table)};
  if (Table noise = noise_table(list, digits); !noise.rows.empty())
    section.tables.push_back(std::move(noise));
  return {"calibrations", {section}};
}

}  // namespace imunoise::report
