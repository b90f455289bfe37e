#include "cli/commands/commands.h"
#include "cli/input.h"
#include "cli/output.h"
#include "cli/progress_line.h"
#include "cli/show.h"
#include "study/analysis/preflights.h"
#include "study/deviation/deviations.h"
#include "study/figure/svg.h"
#include "study/report/figures/deviation_figure.h"
#include "study/report/json.h"

namespace imunoise::cli {
namespace {

Result<v1::DeviationReports> deviations_of(const std::vector<study::Series>& all,
                                           const WvArguments& arguments) {
  v1::DeviationReports out;
  ProgressLine line("measuring");
  for (std::size_t i = 0; i < all.size(); ++i) {
    line.part(i, all.size(), all[i].channel).report(0.0);
    const auto done = study::deviations(all[i], *arguments.deviation, arguments.measure.confidence);
    if (!done) return tl::unexpected(done.error());
    *out.add_channels() = *done;
  }
  return out;
}

Result<v1::WaveletVarianceReports> variances_of(const std::vector<study::Series>& all,
                                                const WvArguments& arguments) {
  v1::WaveletVarianceReports out;
  ProgressLine line("measuring");
  for (std::size_t i = 0; i < all.size(); ++i) {
    const auto measured =
        study::measure(all[i], arguments.measure, line.part(i, all.size(), all[i].channel));
    if (!measured) return tl::unexpected(measured.error());
    *out.add_channels() = study::wavelet_report(all[i], *measured);
  }
  return out;
}

int show_deviations(const std::vector<recording::Replicate>& replicates,
                    const WvArguments& arguments) {
  auto done = deviations_of(all_series(replicates), arguments);
  if (!done) return print_error(done.error());
  v1::DeviationReports& reports = *done;
  for (int i = 0; i < reports.channels_size() && arguments.svg; ++i) {
    const v1::DeviationReport& one = reports.channels(i);
    const auto out =
        reports.channels_size() > 1 ? with_word(*arguments.svg, one.channel()) : *arguments.svg;
    if (auto written = write_file(out, figure::svg(report::deviation_figure(one))); !written)
      return print_error(written.error());
    tell("wrote " + out.string() + "\n");
  }
  study::add_preflight(replicates, reports);
  return show(reports, arguments.show);
}

}  // namespace

int run(const WvArguments& arguments) {
  const auto replicates = read_input(arguments.input);
  if (!replicates) return print_error(replicates.error());
  if (arguments.deviation) return show_deviations(*replicates, arguments);
  auto done = variances_of(all_series(*replicates), arguments);
  if (!done) return print_error(done.error());
  v1::WaveletVarianceReports& reports = *done;
  study::add_preflight(*replicates, reports);
  if (arguments.show.json) {
    const bool single = reports.channels_size() == 1;
    print(single ? report::to_json(reports.channels(0)) : report::to_json(reports));
    return 0;
  }
  for (const v1::WaveletVarianceReport& one : reports.channels()) {
    print(report::wv_text(one, terminal_style()));
  }
  return 0;
}

}  // namespace imunoise::cli
