#include "daemon/app/manual.h"

#include <fmt/format.h>

#include <string>

#include "daemon/config/campaign_keys.h"

namespace imunoise::app {
namespace {

constexpr const char* kDescription =
    R"(A campaign says what to record, for how long and how often. imunoised reads each campaign from a TOML file.
Check a file with imunoised --check-config FILE.

A TIME is a text with units: ms, s, min, h, d or w, such as "1 h 30 min". A SIZE has kB, MB, GB, TB, KiB, MiB, GiB
or TiB. Relative folders start at the working directory of imunoised. Limits of a file: 1 MiB, 16 levels.)";

constexpr const char* kExample = R"(  name = "array"
  folder = "recordings/array"
  replicates = 6
  length = "2 h"
  settling = "30 min"

  [schedule]
  every = "1 d"

  [[device]]
  driver = "xsens"
  options = { port = "/dev/ttyUSB0", rate = 100 })";

manual::OptionText text_of(const config::CampaignKey& key) {
  manual::OptionText out;
  out.names = {std::string(key.name)};
  out.value = "= " + std::string(key.value);
  out.about = std::string(key.about) +
              (key.standard.empty() ? " [required]" : fmt::format(" [default: {}]", key.standard));
  return out;
}

std::string title_of(std::string_view table) {
  if (table.empty()) return "KEYS";
  return table == "device" ? "KEYS OF EACH [[device]]" : fmt::format("KEYS OF [{}]", table);
}

}  // namespace

std::vector<manual::FileText> described_files() {
  manual::FileText out{
      "imunoise-campaign", "campaign files of imunoised", kDescription, kExample, {}};
  for (const config::CampaignKey& key : config::campaign_keys()) {
    const std::string title = title_of(key.table);
    if (out.keys.empty() || out.keys.back().first != title) out.keys.push_back({title, {}});
    out.keys.back().second.push_back(text_of(key));
  }
  return {out};
}

}  // namespace imunoise::app
