#include "study/report/html/document_page.h"

#include <fmt/format.h>

#include "study/report/html/page_frame.h"
#include "study/words/text.h"

namespace imunoise::report {
namespace {

struct Badge {
  const char* css_class;
  const char* sign;  // beside the colour: colours alone do not reach everybody
};

Badge badge_of(Mood mood) {
  switch (mood) {
    case Mood::kGood:
      return {"fits", "✓"};
    case Mood::kDoubtful:
      return {"doubtful", "?"};
    case Mood::kBad:
      return {"fails", "✗"};
    case Mood::kNeutral:
      break;
  }
  return {"untested", "–"};
}

std::string table(const Table& from) {
  if (from.rows.empty()) return {};
  std::string rows;
  for (const std::vector<std::string>& row : from.rows) {
    rows += "<tr>";
    for (const std::string& text : row) rows += cell("", text);
    rows += "</tr>\n";
  }
  return fmt::format(
      "<h3>{}</h3>\n<div class=\"scroll\"><table>{}<tbody>{}</tbody></table></div>\n",
      escape_markup(from.title), table_head(from.head), rows);
}

std::string shown(const figure::Figure& from) {
  return fmt::format("<h3>{}</h3>\n<figure>\n{}<figcaption>{}</figcaption>\n</figure>\n",
                     escape_markup(from.title), two_widths(from), escape_markup(from.caption));
}

}  // namespace

std::string section_markup(const Section& from, std::size_t index) {
  std::string out = fmt::format(
      "<section id=\"section-{}\" aria-label=\"{}\">\n<div class=\"heading\"><h2>{}</h2>", index,
      escape_markup(from.title), escape_markup(from.title));
  if (!from.badge.empty()) {
    const Badge badge = badge_of(from.mood);
    out += fmt::format(R"(<span class="badge {}">{} {}</span>)", badge.css_class, badge.sign,
                       escape_markup(from.badge));
  }
  out += fmt::format("</div>\n<p class=\"facts\">{}</p>\n<p class=\"summary\">{}</p>\n",
                     escape_markup(from.facts), escape_markup(from.summary));
  if (from.panel) out += shown(*from.panel);
  for (const figure::Figure& one : from.figures) out += shown(one);
  for (const Table& one : from.tables) out += table(one);
  if (!from.notes.empty()) {
    out += "<h3>Notes</h3>\n<ul class=\"notes\">\n";
    for (const std::string& note : from.notes) out += "<li>" + escape_markup(note) + "</li>\n";
    out += "</ul>\n";
  }
  return out + "</section>\n";
}

std::string html_page(const Document& document) {
  std::string title = document.title;
  std::string body = "<main>\n";
  for (std::size_t i = 0; i < document.sections.size(); ++i) {
    title += (i == 0 ? " of " : ", ") + document.sections[i].title;
    body += section_markup(document.sections[i], i);
  }
  return page_frame(title, document.title, body + "</main>\n");
}

}  // namespace imunoise::report
