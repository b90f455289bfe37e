// Any text as a campaign: problems with words and places, or a campaign that can be recorded.

#include <cstdint>
#include <cstdlib>
#include <string>

#include "daemon/config/campaign_config.h"

namespace {

void require(bool holds) {
  if (!holds) std::abort();
}

imunoise::drivers::Drivers example_drivers() {
  using enum imunoise::drivers::OptionType;
  imunoise::drivers::Driver driver;
  driver.info = {
      "replay",
      "Recordings",
      "1",
      {{.name = "file", .type = kText, .description = "", .required = true, .repeated = true},
       {.name = "speed", .type = kNumber, .description = "", .minimum = 0.0},
       {.name = "seed", .type = kInteger, .description = "", .maximum = 9.0},
       {.name = "poll", .type = kFlag, .description = ""},
       {.name = "unit", .type = kText, .description = "", .choices = {"V", "K"}}}};
  imunoise::drivers::Drivers out;
  out.found.push_back(driver);
  return out;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const imunoise::drivers::Drivers kDrivers = example_drivers();
  const std::string text(static_cast<const char*>(static_cast<const void*>(data)), size);
  const auto read = imunoise::config::parse_campaign(text, kDrivers);
  for (const auto& problem : read.problems) {
    require(problem.place.line >= 1 && problem.place.column >= 1 && !problem.message.empty());
  }
  if (!read.problems.empty()) return 0;
  const imunoise::v1::Campaign& campaign = read.campaign;
  require(!campaign.name().empty() && !campaign.folder().empty());
  require(campaign.replicates() >= 1 && campaign.length_s() >= 1.0);
  require(campaign.settling_s() >= 0.0 && campaign.pause_s() >= 0.0);
  require(campaign.devices_size() >= 1);
  for (const auto& device : campaign.devices()) require(device.driver() == "replay");
  return 0;
}
