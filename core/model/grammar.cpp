#include "core/model/grammar.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include "core/model/common_names.h"
#include "core/model/trend.h"

namespace imunoise {
namespace {

constexpr std::size_t kMostTerms = 12;
// Of a power that is not 0: its square must be a number, too.
constexpr double kLeastPower = 1e-60;
constexpr double kMostPower = 1e60;

std::string upper(std::string_view text) {
  std::string out(text);
  std::transform(out.begin(), out.end(), out.begin(),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return out;
}

const Process* process_called(std::string_view name) {
  const auto& known = known_processes();
  const auto found = std::find_if(known.begin(), known.end(), [&](const Process& one) {
    return info(one).name == upper(name);
  });
  return found == known.end() ? nullptr : &*found;
}

std::string parameter_names(const Process& process) {
  std::string out;
  for (const ParameterInfo& p : parameters(process)) out += (out.empty() ? "" : ", ") + p.name;
  return out;
}

// Makes a term of what is written; every failure names the place.
class ProcessReader {
 public:
  ProcessReader(std::string_view text, const Grammar& grammar) : text_(text), grammar_(grammar) {}

  Result<Term> read(const WrittenTerm& written, Process process) const {
    Term out(std::move(process));
    for (std::size_t i = 0; i < written.arguments.size(); ++i) {
      const Argument& one = written.arguments[i];
      const bool number =
          i == 0 && !one.text.empty() && std::isdigit(static_cast<unsigned char>(one.text[0])) != 0;
      auto done = number ? size(one, out) : parameter(one, out);
      if (!done) return tl::unexpected(done.error());
    }
    if (auto done = sharing(written, out); !done) return tl::unexpected(done.error());
    return out;
  }

 private:
  Result<void> size(const Argument& written, Term& term) const {
    const ProcessInfo& about = info(term.process);
    if (about.structure.empty())
      return error(written.text, fmt::format("{} takes no number: name the parameter ({})",
                                             about.name, parameter_names(term.process)));
    const std::optional<double> number = number_in(written.text);
    constexpr double kLargest = 1e9;
    if (!number || *number != std::floor(*number) || *number > kLargest)
      return error(written.text, "expected a whole number of reasonable size");
    const auto made = with_structure(term.process, static_cast<int>(*number));
    if (!made)
      return error(written.text, fmt::format("{} is out of range for {} ({})", *number, about.name,
                                             about.structure));
    term = Term(*made);
    return {};
  }

  Result<void> parameter(const Argument& written, Term& term) const {
    const std::vector<ParameterInfo> known = parameters(term.process);
    const auto found = std::find_if(known.begin(), known.end(),
                                    [&](const ParameterInfo& p) { return p.name == written.name; });
    if (found == known.end())
      return error(written.text,
                   fmt::format("{} has no parameter '{}' (it has: {})", info(term.process).name,
                               written.name, parameter_names(term.process)));
    const auto index = static_cast<std::size_t>(found - known.begin());
    if (term.given[index] || term.trends[index].link != Link::kConstant)
      return error(written.text, fmt::format("'{}' is given twice", written.name));
    if (written.sign.empty()) {
      return error(written.text.substr(written.text.size()), "expected '=' and a value");
    }
    return written.sign == "~" ? trend(written, *found, index, term)
                               : value(written, *found, index, term);
  }

  Result<void> value(const Argument& written, const ParameterInfo& about, std::size_t index,
                     Term& term) const {
    const std::optional<double> number = number_in(written.value);
    if (!number) return error(written.value, "expected a number");
    const bool power = index == 0;
    if (power && *number < 0.0)
      return error(written.value, fmt::format("{} cannot be negative", about.name));
    if (power && *number > 0.0 && !(*number >= kLeastPower && *number <= kMostPower))
      return error(written.value, fmt::format("{} must be 0 or lie between {:g} and {:g}",
                                              about.name, kLeastPower, kMostPower));
    if (!power && !(*number >= about.lower && *number <= about.upper))
      return error(written.value, fmt::format("{} must lie between {:.6g} and {:.16g}", about.name,
                                              about.lower, about.upper));
    std::vector<double> all = values(term.process);
    all[index] = *number;
    set_values(term.process, all);
    term.given[index] = true;
    return {};
  }

  Result<void> trend(const Argument& written, const ParameterInfo& about, std::size_t index,
                     Term& term) const {
    if (!grammar_.trends)
      return error(written.sign, "parameters follow a covariate only in imunoise dynamic");
    const std::string name = upper(written.value);
    std::string words;
    for (const Link link : possible_links(about, index)) {
      if (name.empty() || name == upper(word_of(link))) {
        term.trends[index].link = link;
        return {};
      }
      words += fmt::format("{}{}", words.empty() ? "" : " or ", word_of(link));
    }
    return error(written.value, fmt::format("{} follows a covariate as {}", about.name, words));
  }

  Result<void> sharing(const WrittenTerm& written, Term& term) const {
    if (!written.sharing) return {};
    if (!grammar_.sharing)
      return error(*written.sharing, "processes are shared only among the sensors of an array");
    for (const Sharing one : {Sharing::kCorrelated, Sharing::kGroup, Sharing::kAll}) {
      if (upper(*written.sharing) == upper(word_of(one))) term.sharing = one;
    }
    if (term.sharing == Sharing::kOwn)
      return error(*written.sharing,
                   "expected how the sensors of an array share the process: corr, group or all");
    if (term.sharing == Sharing::kCorrelated && term.given[0])
      return error(*written.sharing,
                   "a correlated process has a matrix of powers, which cannot be given");
    return {};
  }

  tl::unexpected<Error> error(std::string_view place, const std::string& what) const {
    return tl::unexpected(model_error(text_, place, what));
  }

  std::string_view text_;
  const Grammar& grammar_;
};

// A model that is processes alone.
Result<Model> parse_processes(std::string_view text, Hertz rate, const Grammar& grammar) {
  const auto terms = split_model(text);
  if (!terms) return tl::unexpected(terms.error());
  Model out;
  for (const WrittenTerm& one : *terms) {
    if (auto done = add_process(one, text, rate, grammar, out); !done)
      return tl::unexpected(done.error());
  }
  return out;
}

std::string print_term(const Term& term, bool all) {
  std::string inside;
  if (const int number = structure(term.process); number > 0) inside = std::to_string(number);
  const std::vector<ParameterInfo> about = parameters(term.process);
  const std::vector<double> at = values(term.process);
  for (std::size_t i = 0; i < at.size(); ++i) {
    const std::string comma = inside.empty() ? "" : ", ";
    if (all || term.given[i]) {
      inside += fmt::format("{}{}={}", comma, about[i].name, at[i]);  // shortest exact form
    } else if (term.trends[i].link != Link::kConstant) {
      inside += fmt::format("{}{}~{}", comma, about[i].name, word_of(term.trends[i].link));
    }
  }
  std::string out(info(term.process).name);
  if (!inside.empty()) out += "(" + inside + ")";
  if (term.sharing != Sharing::kOwn) out += fmt::format("[{}]", word_of(term.sharing));
  return out;
}

std::string print(const Model& model, bool all) {
  std::string out;
  for (std::size_t i = 0; i < model.terms.size();) {
    std::size_t count = 1;
    const std::string term = print_term(model.terms[i], all);
    while (i + count < model.terms.size() && print_term(model.terms[i + count], all) == term)
      ++count;
    out += (out.empty() ? "" : " + ") + (count > 1 ? std::to_string(count) + "*" : "") + term;
    i += count;
  }
  return out;
}

}  // namespace

bool is_process(std::string_view name) { return process_called(name) != nullptr; }

std::vector<std::string> known_process_names() {
  std::vector<std::string> out;
  for (const Process& process : known_processes()) out.emplace_back(info(process).name);
  return out;
}

std::string unknown_term(std::string_view name, const std::vector<std::string>& effects) {
  const std::vector<std::string> processes = known_process_names();
  std::vector<std::string> known = processes;
  known.insert(known.end(), effects.begin(), effects.end());
  const std::string what =
      fmt::format("unknown process{} '{}'", effects.empty() ? "" : " or effect", name);
  const std::string meant = meant_by(name, known);
  if (!meant.empty()) return what + "; " + meant;
  return fmt::format("{} (processes: {}{}{})", what, fmt::join(processes, ", "),
                     effects.empty() ? "" : "; effects: ", fmt::join(effects, ", "));
}

Result<void> add_process(const WrittenTerm& written, std::string_view text, Hertz rate,
                         const Grammar& grammar, Model& to) {
  const auto wrong = [&](std::string_view place, const std::string& what) {
    return tl::unexpected(model_error(text, place, what));
  };
  if (written.name.empty())
    return wrong(written.name, fmt::format("expected the name of a process ({})",
                                           fmt::join(known_process_names(), ", ")));
  const Process* const known = process_called(written.name);
  if (known == nullptr) return wrong(written.name, unknown_term(written.name, {}));
  Process process = *known;
  if (auto* markov = std::get_if<GaussMarkov>(&process)) markov->rate = rate;
  const Result<Term> term = ProcessReader(text, grammar).read(written, std::move(process));
  if (!term) return tl::unexpected(term.error());
  const auto count = static_cast<std::size_t>(written.count);
  if (count > kMostTerms - to.terms.size())
    return wrong(written.text, fmt::format("a model has at most {} terms", kMostTerms));
  to.terms.insert(to.terms.end(), count, *term);
  return {};
}

Result<Model> parse_model(std::string_view text, Hertz rate) {
  return parse_processes(text, rate, {});
}
Result<Model> parse_array_model(std::string_view text, Hertz rate) {
  return parse_processes(text, rate, {.sharing = true});
}
Result<Model> parse_dynamic_model(std::string_view text, Hertz rate) {
  return parse_processes(text, rate, {.trends = true});
}

std::string print(const Model& model) { return print(model, false); }
std::string print_with_values(const Model& model) { return print(model, true); }

}  // namespace imunoise
