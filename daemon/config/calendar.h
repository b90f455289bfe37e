#pragma once

#include <string_view>

namespace imunoise::config {

/// Whether a text has the form of a calendar event of systemd (systemd.time, section "Calendar
/// Events"): days of the week, a date, a time of day, a time zone, or one word such as "daily".
/// systemd alone knows time zones and the length of months.
bool may_be_calendar(std::string_view text);

}  // namespace imunoise::config
