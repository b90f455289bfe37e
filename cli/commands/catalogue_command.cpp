#include <fmt/format.h>

#include "cli/commands/commands.h"
#include "cli/interrupt.h"
#include "cli/progress_line.h"
#include "cli/show.h"
#include "daemon/catalogue/catalogue.h"

namespace imunoise::cli {
namespace {

// The catalogue as the files in the folder are now.
Result<catalogue::Catalogue> current(const CatalogueArguments& arguments) {
  const Interrupt interrupt;
  ProgressLine line("reading recordings");
  auto out = catalogue::Catalogue::open(
      arguments.catalogue.value_or(catalogue::place_in(arguments.folder)), arguments.bench);
  if (!out) return out;
  if (!out->repair().empty()) fmt::print(stderr, "{}\n", out->repair());
  const auto changes = out->refresh(recording::posix_file_system(), arguments.folder,
                                    line.progress(interrupt.token()));
  if (!changes) return tl::unexpected(changes.error());
  return out;
}

// The daemon's answer.
template <class Answer>
Result<Answer> ask(const DaemonArguments& daemon, const std::string& target) {
  auto client = DaemonClient::open(daemon);
  if (!client) return tl::unexpected(client.error());
  const auto json = client->get(target);
  if (!json) return tl::unexpected(json.error());
  Answer out;
  if (auto read = read_answer(*json, out); !read) return tl::unexpected(read.error());
  return out;
}

std::string history_target(const HistoryArguments& arguments) {
  std::string out = "/v1/history?device=" + escaped(arguments.device) +
                    fmt::format("&level={}", arguments.history.level);
  for (const std::string& one : arguments.history.channels) out += "&channel=" + escaped(one);
  for (const std::string& one : arguments.history.parameters) out += "&parameter=" + escaped(one);
  return out;
}

Result<v1::History> history_in(const HistoryArguments& arguments) {
  if (arguments.folder.empty()) {
    return ask<v1::History>(arguments.daemon, history_target(arguments));
  }
  auto catalogue = current(arguments);
  if (!catalogue) return tl::unexpected(catalogue.error());
  const auto device = catalogue->device(arguments.device);
  if (!device) return tl::unexpected(device.error());
  auto parameters = catalogue->parameters(device->id());
  if (!parameters) return tl::unexpected(parameters.error());
  return catalogue::history_of(*device, std::move(*parameters), arguments.history);
}

// A list of the daemon, or of the catalogue of a folder.
template <class List, class OfCatalogue>
int show_list(const CatalogueArguments& arguments, const char* target,
              const OfCatalogue& of_catalogue) {
  Result<List> list = [&]() -> Result<List> {
    if (arguments.folder.empty()) return ask<List>(arguments.daemon, target);
    auto catalogue = current(arguments);
    if (!catalogue) return tl::unexpected(catalogue.error());
    return of_catalogue(*catalogue);
  }();
  if (!list) return print_error(list.error());
  list->set_root(arguments.folder.string());
  return show(*list, arguments.show);
}

}  // namespace

int run(const RecordingsArguments& arguments) {
  return show_list<v1::RecordingList>(arguments, "/v1/recordings",
                                      [](auto& catalogue) { return catalogue.recordings(); });
}

int run(const CalibrationsArguments& arguments) {
  return show_list<v1::CalibrationList>(arguments, "/v1/calibrations",
                                        [](auto& catalogue) { return catalogue.calibrations(); });
}

int run(const HistoryArguments& arguments) {
  auto history = history_in(arguments);
  if (!history) return print_error(history.error());
  history->set_root(arguments.folder.string());
  const int status = show(*history, arguments.show);
  return status == 0 && history->alarm() ? 1 : status;
}

}  // namespace imunoise::cli
