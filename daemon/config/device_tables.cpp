#include "daemon/config/device_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <set>

#include "drivers/host/option_values.h"

namespace imunoise::config {
namespace {

constexpr std::size_t kLongestName = 64;

// A value as a user of the command line would write it; nothing for what cannot be one.
std::optional<std::string> text_of(const TomlValue& value) {
  if (const auto* const text = std::get_if<std::string>(&value.content)) return *text;
  if (const auto* const whole = std::get_if<std::int64_t>(&value.content)) {
    return fmt::format("{}", *whole);
  }
  if (const auto* const number = std::get_if<double>(&value.content)) {
    return fmt::format("{}", *number);
  }
  if (const auto* const flag = std::get_if<bool>(&value.content)) return *flag ? "true" : "false";
  return std::nullopt;
}

// One option's value, or several.
std::vector<TomlValue> values_of(const TomlValue& value) {
  if (const auto* const several = std::get_if<TomlArray>(&value.content)) return *several;
  return {value};
}

class OptionTable {
 public:
  OptionTable(TableReader& device, const drivers::Driver& driver, v1::CampaignDevice& out)
      : device_(device), driver_(driver), out_(out) {}

  void read(const TomlEntry* options) {
    if (options != nullptr) {
      for (const TomlEntry& entry : std::get<TomlTable>(options->value.content)) add(entry);
    }
    for (const drivers::Option& option : driver_.info.options) {
      if (!option.required || given_.contains(option.name)) continue;
      device_.complain("options", fmt::format("{} is missing ({}); give {} = ... under options",
                                              option.name, option.description, option.name));
    }
  }

 private:
  void complain(Place place, const std::string& option, const std::string& message) {
    device_.complain_at(place, "options." + option, message);
  }

  void add(const TomlEntry& entry) {
    const auto& known = driver_.info.options;
    const auto option = std::find_if(known.begin(), known.end(), [&](const drivers::Option& one) {
      return one.name == entry.key;
    });
    if (option == known.end()) {
      std::vector<std::string> names;
      for (const drivers::Option& one : known) names.push_back(one.name);
      return complain(
          entry.place, entry.key,
          fmt::format("driver {}: {}", driver_.info.name, unknown_name(entry.key, names)));
    }
    given_.insert(entry.key);
    const std::vector<TomlValue> values = values_of(entry.value);
    if (values.size() != 1 && !option->repeated) {
      return complain(entry.place, entry.key, "takes one value, not a list");
    }
    for (const TomlValue& value : values) add_value(*option, value);
  }

  void add_value(const drivers::Option& option, const TomlValue& value) {
    const auto text = text_of(value);
    if (!text) {
      return complain(value.place, option.name,
                      fmt::format("is {}; give a text, a number, true or false", type_of(value)));
    }
    if (const auto good = drivers::check_value(option, *text); !good) {
      return complain(value.place, option.name, good.error().message);
    }
    v1::CampaignOption& to = *out_.add_options();
    to.set_name(option.name);
    to.set_value(*text);
  }

  TableReader& device_;
  const drivers::Driver& driver_;
  v1::CampaignDevice& out_;
  std::set<std::string> given_;
};

void read_driver(TableReader& device, const drivers::Drivers& drivers, v1::CampaignDevice& out) {
  const TomlEntry* const options = device.table("options");
  const auto name = device.text("driver");
  if (!name) return device.require("driver", "a driver; imunoise drivers lists them");
  out.set_driver(*name);
  std::vector<std::string> names;
  for (const drivers::Driver& driver : drivers.found) {
    names.push_back(driver.info.name);
    if (driver.info.name == *name) return OptionTable(device, driver, out).read(options);
  }
  device.complain("driver", fmt::format("'{}' is {}", *name, unknown_name(*name, names)));
}

// Names that were not given: the driver's, numbered from the second on.
std::string free_name(const std::string& driver, const std::set<std::string>& taken) {
  std::string out = driver;
  for (std::size_t k = 2; taken.contains(out); ++k) out = fmt::format("{}-{}", driver, k);
  return out;
}

}  // namespace

Result<void> check_name(std::string_view name) {
  const bool fits = std::all_of(name.begin(), name.end(), [](unsigned char c) {
    return (std::isalnum(c) != 0 && c < 128) || c == '_' || c == '-' || c == '.';
  });
  if (fits && !name.empty() && name.front() != '.' && name.size() <= kLongestName) return {};
  return fail(fmt::format(
      "'{}' cannot name a folder; use at most {} letters, digits, '_', '-' and '.', no dot first",
      name, kLongestName));
}

void read_devices(TableReader& campaign, const drivers::Drivers& drivers,
                  std::vector<Problem>& problems, v1::Campaign& out) {
  const std::vector<const TomlValue*> tables = campaign.tables("device");
  campaign.require("device", "a table headed [[device]]");
  if (campaign.holds_nothing("device")) campaign.complain("device", "is empty; name a device");
  std::set<std::string> taken;
  for (std::size_t k = 0; k < tables.size(); ++k) {
    TableReader device(std::get<TomlTable>(tables[k]->content), tables[k]->place,
                       fmt::format("device {}", k + 1), problems);
    v1::CampaignDevice& to = *out.add_devices();
    const auto name = device.text("name");
    read_driver(device, drivers, to);
    to.set_name(name ? *name : free_name(to.driver(), taken));
    if (const auto good = check_name(to.name()); name && !good) {
      device.complain("name", good.error().message);
    }
    if (!taken.insert(to.name()).second) {
      device.complain("name", fmt::format("another device is '{}' already", to.name()));
    }
    device.finish();
  }
}

}  // namespace imunoise::config
