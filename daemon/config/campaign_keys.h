#pragma once

#include <string_view>
#include <vector>

namespace imunoise::config {

/// One key of a campaign file, for the manual: imunoise-campaign(5).
struct CampaignKey {
  std::string_view table;  ///< "schedule"; empty: the top of the file
  std::string_view name;
  std::string_view value;  ///< kind of its value: TEXT, TIME, SIZE, COUNT, true|false
  std::string_view about;
  std::string_view standard;  ///< its default, in words; empty: required
};

/// All keys, in the order in which a file gives them.
const std::vector<CampaignKey>& campaign_keys();

}  // namespace imunoise::config
