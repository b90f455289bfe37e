#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <limits>

#include "core/model/model.h"
#include "core/model/trend.h"

namespace imunoise {
namespace {

constexpr int kMostTerms = 12;
// Of a power that is not 0: its square must be a number, too.
constexpr double kLeastPower = 1e-60;
constexpr double kMostPower = 1e60;

// What a model may say beyond its processes and their values.
enum class Dialect { kPlain, kArray, kDynamic };

std::string upper(std::string_view text) {
  std::string out(text);
  std::transform(out.begin(), out.end(), out.begin(),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return out;
}

std::string known_names() {
  std::string out;
  for (const Process& process : known_processes()) {
    out += fmt::format("{}{}", out.empty() ? "" : ", ", info(process).name);
  }
  return out;
}

// Recursive descent over the text; every failure names the place.
class Parser {
 public:
  Parser(std::string_view text, Hertz rate, Dialect dialect)
      : text_(text), rate_(rate), dialect_(dialect) {}

  Result<Model> model() {
    Model out;
    do {
      if (auto done = term(out); !done) return tl::unexpected(done.error());
    } while (accept('+'));
    skip_space();
    if (at_ < text_.size()) return error(at_, "expected '+' and another term, or the end");
    return out;
  }

 private:
  Result<void> term(Model& model) {
    int count = 1;
    skip_space();
    const std::size_t begin = at_;
    if (at_ < text_.size() && std::isdigit(static_cast<unsigned char>(text_[at_])) != 0) {
      const Result<int> number = whole_number();
      if (!number) return tl::unexpected(number.error());
      count = *number;
      if (count < 1) return error(begin, "a term is counted from 1");
      if (!accept('*')) return error(at_, "expected '*' between the count and the name");
    }
    skip_space();
    Result<Term> one = single();
    if (!one) return tl::unexpected(one.error());
    if (count > kMostTerms - static_cast<int>(model.terms.size())) {
      return error(begin, fmt::format("a model has at most {} terms", kMostTerms));
    }
    model.terms.insert(model.terms.end(), static_cast<std::size_t>(count), *one);
    return {};
  }

  Result<Term> single() {
    const std::size_t begin = at_;
    const std::string name = upper(word());
    if (name.empty()) return error(begin, "expected the name of a process (" + known_names() + ")");
    const auto& known = known_processes();
    const auto found = std::find_if(known.begin(), known.end(),
                                    [&](const Process& p) { return info(p).name == name; });
    if (found == known.end()) {
      return error(begin, fmt::format("unknown process '{}' (known: {})",
                                      text_.substr(begin, at_ - begin), known_names()));
    }
    Process process = *found;
    if (auto* markov = std::get_if<GaussMarkov>(&process)) markov->rate = rate_;
    Term out(process);
    if (auto done = arguments(out); !done) return tl::unexpected(done.error());
    if (auto done = sharing(out); !done) return tl::unexpected(done.error());
    return out;
  }

  Result<void> arguments(Term& out) {
    if (!accept('(') || accept(')')) return {};
    bool first = true;
    do {
      skip_space();
      const bool number =
          at_ < text_.size() && std::isdigit(static_cast<unsigned char>(text_[at_])) != 0;
      Result<void> done = first && number ? structure(out) : assignment(out);
      if (!done) return tl::unexpected(done.error());
      first = false;
    } while (accept(','));
    if (!accept(')')) return error(at_, "expected ',' or ')'");
    return {};
  }

  Result<void> sharing(Term& term) {
    if (!accept('[')) return {};
    skip_space();
    const std::size_t begin = at_;
    if (dialect_ != Dialect::kArray)
      return error(begin, "processes are shared only among the sensors of an array");
    const std::string name = upper(word());
    for (const Sharing one : {Sharing::kCorrelated, Sharing::kGroup, Sharing::kAll}) {
      if (name == upper(word_of(one))) term.sharing = one;
    }
    if (term.sharing == Sharing::kOwn) {
      return error(begin,
                   "expected how the sensors of an array share the process: corr, group or "
                   "all");
    }
    if (term.sharing == Sharing::kCorrelated && term.given[0]) {
      return error(begin, "a correlated process has a matrix of powers, which cannot be given");
    }
    if (!accept(']')) return error(at_, "expected ']'");
    return {};
  }

  Result<void> structure(Term& term) {
    const std::size_t begin = at_;
    const ProcessInfo& about = info(term.process);
    if (about.structure.empty()) {
      return error(begin, fmt::format("{} takes no number: name the parameter ({})", about.name,
                                      parameter_names(term.process)));
    }
    const Result<int> number = whole_number();
    if (!number) return tl::unexpected(number.error());
    const std::optional<Process> made = with_structure(term.process, *number);
    if (!made)
      return error(begin, fmt::format("{} is out of range for {} ({})", *number, about.name,
                                      about.structure));
    term = Term(*made);
    return {};
  }

  Result<void> assignment(Term& term) {
    skip_space();
    const std::size_t begin = at_;
    const std::string_view name = word();
    const std::vector<ParameterInfo> known = parameters(term.process);
    const auto found = std::find_if(known.begin(), known.end(),
                                    [&](const ParameterInfo& p) { return p.name == name; });
    if (found == known.end()) {
      return error(
          begin, fmt::format("{} has no parameter '{}' (it has: {})", info(term.process).name, name,
                             parameter_names(term.process)));
    }
    const auto index = static_cast<std::size_t>(found - known.begin());
    if (term.given[index] || term.trends[index].link != Link::kConstant) {
      return error(begin, fmt::format("'{}' is given twice", name));
    }
    if (accept('~')) return trend(term, *found, index);
    if (!accept('=')) return error(at_, "expected '=' and a value");
    skip_space();
    const std::size_t value_at = at_;
    double value = 0.0;
    const char* const end = text_.data() + text_.size();
    const auto [stop, code] = std::from_chars(text_.data() + at_, end, value);
    if (code != std::errc() || !std::isfinite(value)) return error(at_, "expected a number");
    at_ = static_cast<std::size_t>(stop - text_.data());
    const bool power = index == 0;
    if (power && value < 0.0) return error(value_at, fmt::format("{} cannot be negative", name));
    if (power && value > 0.0 && !(value >= kLeastPower && value <= kMostPower))
      return error(value_at, fmt::format("{} must be 0 or lie between {:g} and {:g}", name,
                                         kLeastPower, kMostPower));
    if (!power && !(value >= found->lower && value <= found->upper)) {
      return error(value_at, fmt::format("{} must lie between {:.6g} and {:.16g}", name,
                                         found->lower, found->upper));
    }
    std::vector<double> all = values(term.process);
    all[index] = value;
    set_values(term.process, all);
    term.given[index] = true;
    return {};
  }

  Result<void> trend(Term& term, const ParameterInfo& about, std::size_t index) {
    if (dialect_ != Dialect::kDynamic) {
      return error(at_ - 1, "parameters follow a covariate only in imunoise dynamic");
    }
    skip_space();
    const std::size_t begin = at_;
    const std::string name = upper(word());
    const std::vector<Link> possible = possible_links(about, index);
    std::string words;
    for (const Link link : possible) {
      if (name.empty() || name == upper(word_of(link))) {
        term.trends[index].link = link;
        return {};
      }
      words += fmt::format("{}{}", words.empty() ? "" : " or ", word_of(link));
    }
    return error(begin, fmt::format("{} follows a covariate as {}", about.name, words));
  }

  static std::string parameter_names(const Process& process) {
    std::string out;
    for (const ParameterInfo& p : parameters(process)) out += (out.empty() ? "" : ", ") + p.name;
    return out;
  }

  Result<int> whole_number() {
    int value = 0;
    const char* const end = text_.data() + text_.size();
    const auto [stop, code] = std::from_chars(text_.data() + at_, end, value);
    if (code != std::errc()) return error(at_, "expected a whole number of reasonable size");
    at_ = static_cast<std::size_t>(stop - text_.data());
    return value;
  }

  std::string_view word() {
    const std::size_t begin = at_;
    while (at_ < text_.size() &&
           (std::isalnum(static_cast<unsigned char>(text_[at_])) != 0 || text_[at_] == '_')) {
      ++at_;
    }
    return text_.substr(begin, at_ - begin);
  }

  bool accept(char c) {
    skip_space();
    if (at_ >= text_.size() || text_[at_] != c) return false;
    ++at_;
    return true;
  }

  void skip_space() {
    while (at_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[at_])) != 0) ++at_;
  }

  tl::unexpected<Error> error(std::size_t at, const std::string& what) const {
    std::string shown(text_);
    for (char& c : shown) c = std::iscntrl(static_cast<unsigned char>(c)) != 0 ? ' ' : c;
    return fail(fmt::format("model: {}\n  {}\n  {}^", what, shown, std::string(at, ' ')));
  }

  std::string_view text_;
  Hertz rate_;
  Dialect dialect_;
  std::size_t at_ = 0;
};

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

Result<Model> parse_model(std::string_view text, Hertz rate) {
  return Parser(text, rate, Dialect::kPlain).model();
}
Result<Model> parse_array_model(std::string_view text, Hertz rate) {
  return Parser(text, rate, Dialect::kArray).model();
}

Result<Model> parse_dynamic_model(std::string_view text, Hertz rate) {
  return Parser(text, rate, Dialect::kDynamic).model();
}

std::string print(const Model& model) { return print(model, false); }
std::string print_with_values(const Model& model) { return print(model, true); }

}  // namespace imunoise
