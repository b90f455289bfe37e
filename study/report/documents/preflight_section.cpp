#include "study/report/documents/preflight_section.h"

#include <fmt/format.h>

#include "study/words/number.h"

namespace imunoise::report {
namespace {

Section file_section(const v1::Preflight& file) {
  Section out;
  out.title = file.file();
  const int findings = file.findings_size();
  out.badge = findings == 0 ? "no faults found" : counted(findings, "finding");
  out.mood = findings == 0 ? Mood::kGood : Mood::kDoubtful;
  out.facts = fmt::format("{} of {} used, in {}", file.used(), counted(file.samples(), "sample"),
                          counted(file.stretches(), "stretch"));
  Table recognised{"Recognised", {"", ""}, {}};
  for (const std::string& one : file.recognised()) {
    const std::size_t colon = one.find(": ");
    if (colon == std::string::npos) {
      recognised.rows.push_back({one, ""});
    } else {
      recognised.rows.push_back({one.substr(0, colon), one.substr(colon + 2)});
    }
  }
  if (!recognised.rows.empty()) out.tables.push_back(std::move(recognised));
  Table found{"Findings", {"", ""}, {}};
  for (const v1::PreflightFinding& one : file.findings())
    found.rows.push_back({one.left_out() ? "left out" : "doubt", one.text()});
  if (!found.rows.empty()) out.tables.push_back(std::move(found));
  return out;
}

}  // namespace

void add_files(const google::protobuf::RepeatedPtrField<v1::Preflight>& files, Digits digits,
               Document& to) {
  if (digits != Digits::kTypeset) return;
  for (const v1::Preflight& one : files) to.sections.push_back(file_section(one));
}

}  // namespace imunoise::report
