#pragma once

#include <fmt/format.h>

#include "cli/output.h"
#include "study/report/documents/batch_documents.h"
#include "study/report/documents/catalogue_documents.h"
#include "study/report/documents/datasheet_document.h"
#include "study/report/documents/deviation_document.h"
#include "study/report/documents/document.h"
#include "study/report/documents/inference_documents.h"
#include "study/report/json.h"

namespace imunoise::cli {

/// How a result leaves the program.
struct ShowArguments {
  bool json = false;
  std::optional<std::filesystem::path> report;  ///< HTML page
};

/// Writes the page if one was asked for, and prints the result as JSON (a single channel without
/// the list around it) or for people. Returns the exit status.
template <class Reports>
int show(const Reports& reports, const ShowArguments& arguments) {
  const auto json = [&] {
    if constexpr (requires { reports.channels_size(); }) {
      const bool list = Reports::descriptor()->field_count() == 1;
      if (list && reports.channels_size() == 1) return report::to_json(reports.channels(0));
    }
    return report::to_json(reports);
  };
  if (arguments.report) {
    const auto page = report::html_page(report::document(reports, report::Digits::kTypeset));
    if (auto done = write_report(*arguments.report, page); !done) return print_error(done.error());
  }
  if (arguments.json) {
    print(json());
    return 0;
  }
  print(report::text(report::document(reports, report::Digits::kPlain), terminal_style()));
  return 0;
}

}  // namespace imunoise::cli
