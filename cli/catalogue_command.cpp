#include "cli/commands.h"
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
  const auto changes = out->refresh(recording::posix_file_system(), arguments.folder,
                                    line.progress(interrupt.token()));
  if (!changes) return tl::unexpected(changes.error());
  return out;
}

template <class List>
int show_list(Result<List> list, const CatalogueArguments& arguments) {
  if (!list) return print_error(list.error());
  list->set_root(arguments.folder.string());
  return show(*list, arguments.show);
}

}  // namespace

int run(const RecordingsArguments& arguments) {
  auto catalogue = current(arguments);
  if (!catalogue) return print_error(catalogue.error());
  return show_list(catalogue->recordings(), arguments);
}

int run(const CalibrationsArguments& arguments) {
  auto catalogue = current(arguments);
  if (!catalogue) return print_error(catalogue.error());
  return show_list(catalogue->calibrations(), arguments);
}

int run(const HistoryArguments& arguments) {
  auto catalogue = current(arguments);
  if (!catalogue) return print_error(catalogue.error());
  const auto device = catalogue->device(arguments.device);
  if (!device) return print_error(device.error());
  auto parameters = catalogue->parameters(device->id());
  if (!parameters) return print_error(parameters.error());
  auto history = catalogue::history_of(*device, std::move(*parameters), arguments.history);
  if (!history) return print_error(history.error());
  history->set_root(arguments.folder.string());
  const int status = show(*history, arguments.show);
  return status == 0 && history->alarm() ? 1 : status;
}

}  // namespace imunoise::cli
