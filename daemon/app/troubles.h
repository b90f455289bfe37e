#pragma once

// What keeps campaigns from recording.

#include <map>
#include <string>
#include <vector>

#include "daemon/live/live_board.h"
#include "imunoise/v1/campaign.pb.h"
#include "recording/store/disk/disk_calls.h"

namespace imunoise::app {

/// By campaign.
using Troubles = std::map<std::string, live::Trouble>;

/// Stands for a campaign where a call outside of all their folders hangs.
inline constexpr const char* kNoCampaign = "imunoised";

/// Calls that hang come first: nothing else is known for sure while one does. `calls`, the oldest
/// first, have not returned.
Troubles find_troubles(const std::vector<v1::Campaign>& campaigns,
                       const std::vector<recording::DiskCall>& calls, const live::LiveBoard& board,
                       live::Steady::time_point now);

/// Of those that hang for so long: "array: the disk hangs: ..."; empty: none.
std::string hanging_since(const Troubles& troubles, live::Steady::time_point before);

}  // namespace imunoise::app
