#include "study/figure/characters.h"
#include "study/report/documents/document.h"
#include "study/report/terminal/lines.h"
#include "study/report/terminal/table.h"

namespace imunoise::report {
namespace {

Ink ink_of(Mood mood) {
  switch (mood) {
    case Mood::kGood:
      return Ink::kGood;
    case Mood::kDoubtful:
    case Mood::kBad:
      return Ink::kAlarm;
    case Mood::kNeutral:
      break;
  }
  return Ink::kPlain;
}

std::string section(const Section& from, const TerminalStyle& style) {
  std::string title = from.title;
  if (!from.badge.empty()) title += ": " + from.badge;
  std::string out = title_line(title, style) + paragraph(from.facts, Ink::kQuiet, style) + "\n";
  out += paragraph(from.summary, ink_of(from.mood), style);
  if (from.panel)
    out += "\n" + paragraph(from.panel->title, Ink::kStrong, style) +
           figure::characters(*from.panel, style) +
           paragraph(from.panel->caption, Ink::kQuiet, style);
  for (const Table& table : from.tables) {
    if (table.rows.empty()) continue;
    out += "\n" + paragraph(table.title, Ink::kStrong, style) +
           terminal_table(table.head, table.rows, style);
  }
  if (!from.notes.empty()) out += "\n";
  for (const std::string& note : from.notes) out += wrapped("note: " + note, 0, style);
  return out;
}

}  // namespace

std::string text(const Document& document, const TerminalStyle& wanted) {
  const TerminalStyle style = usable(wanted);
  std::string out;
  for (const Section& one : document.sections)
    out += (out.empty() ? "" : "\n") + section(one, style);
  return out;
}

}  // namespace imunoise::report
