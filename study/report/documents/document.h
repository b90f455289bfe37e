#pragma once

// A report as words, tables and figures, apart from where it is shown: the page and the terminal
// both draw it. The code that makes the document decides what it says.

#include <optional>
#include <string>
#include <vector>

#include "study/figure/figure.h"
#include "study/words/terminal_style.h"

namespace imunoise::report {

enum class Mood { kNeutral, kGood, kDoubtful, kBad };

struct Table {
  std::string title;
  std::vector<std::string> head;
  std::vector<std::vector<std::string>> rows;
};

struct Section {
  std::string title;
  std::string badge;  ///< a word or two; empty for none
  Mood mood = Mood::kNeutral;
  std::string facts;  ///< one line: what it was made from
  std::string summary;
  std::optional<figure::Figure> panel;  ///< rows of bars, for the page and the terminal
  std::vector<figure::Figure> figures;  ///< for the page; the terminal shows the tables
  std::vector<Table> tables;
  std::vector<std::string> notes;
};

struct Document {
  std::string title;  ///< "near-stationarity"
  std::vector<Section> sections;
};

/// One self-contained page. All text is escaped. Thread-safe.
std::string html_page(const Document& document);

/// For the terminal, no line wider than the style says. Thread-safe.
std::string text(const Document& document, const TerminalStyle& style = {});

}  // namespace imunoise::report
