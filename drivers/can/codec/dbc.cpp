#include "drivers/can/codec/dbc.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <set>

#include "core/support/utf8.h"
#include "drivers/can/codec/dbc_lexer.h"
#include "drivers/can/codec/identifier.h"

namespace imunoise::drivers {
namespace {

constexpr std::uint32_t kNoMessage = 0xc000'0000;  // keeps signals that no message uses
constexpr std::size_t kLongestMessage = 1785;      // bytes, J1939's transport protocol

constexpr std::size_t kDeepestMultiplexing = 8;

// Sections that end with a semicolon and say nothing about bits.
constexpr std::array<std::string_view, 22> kSkipped = {"CM_",
                                                       "BA_",
                                                       "BA_DEF_",
                                                       "BA_DEF_DEF_",
                                                       "BA_DEF_REL_",
                                                       "BA_REL_",
                                                       "BA_DEF_SGTYPE_",
                                                       "BA_SGTYPE_",
                                                       "BA_DEF_DEF_REL_",
                                                       "VAL_",
                                                       "VAL_TABLE_",
                                                       "BO_TX_BU_",
                                                       "EV_",
                                                       "EV_DATA_",
                                                       "ENVVAR_DATA_",
                                                       "SIG_GROUP_",
                                                       "SIG_TYPE_REF_",
                                                       "SGTYPE_",
                                                       "SGTYPE_VAL_",
                                                       "CAT_DEF_",
                                                       "CAT_",
                                                       "FILTER"};
// Sections that end where a line begins at its first column.
constexpr std::array<std::string_view, 4> kIndented = {"VERSION", "NS_", "BS_", "BU_"};

template <class List>
bool contains(const List& list, std::string_view word) {
  return std::find(list.begin(), list.end(), word) != list.end();
}

// Recursive descent; the first error wins, and every step after it does nothing.
class Parser {
 public:
  Parser(std::string_view text, std::string_view file) : lexer_(text, file) { advance(); }

  Result<CanDatabase> parse() {
    while (!error_ && token_.kind != DbcToken::Kind::kEnd) section();
    for (CanMessage& message : messages_) {
      if (!error_) resolve_multiplexors(message);
    }
    if (error_) return tl::unexpected(*error_);
    return CanDatabase(std::move(messages_));
  }

 private:
  void refuse(const DbcToken& token, std::string_view what) {
    if (!error_) error_ = lexer_.error_at(token, what);
  }

  void advance() {
    if (error_) return;
    Result<DbcToken> next = lexer_.next();
    if (next) {
      token_ = *next;
    } else {
      error_ = next.error();
    }
  }

  DbcToken take() {
    const DbcToken out = token_;
    advance();
    return out;
  }

  void refuse_instead_of(std::string_view what) {
    const bool end = token_.kind == DbcToken::Kind::kEnd;
    refuse(token_, fmt::format("expected {}, found {}", what,
                               end ? std::string("the end of the file")
                                   : fmt::format("'{}'", token_.text)));
  }

  DbcToken expect(DbcToken::Kind kind, std::string_view what) {
    if (token_.kind != kind) refuse_instead_of(what);
    return take();
  }

  void expect_mark(std::string_view mark) {
    if (!token_.is(mark)) refuse_instead_of(fmt::format("'{}'", mark));
    advance();
  }

  double number(std::string_view what) {
    const DbcToken token = expect(DbcToken::Kind::kNumber, what);
    if (error_) return 0.0;
    std::string_view digits = token.text;
    if (digits.front() == '+') digits.remove_prefix(1);
    double out = 0.0;
    const char* const end = digits.data() + digits.size();
    const auto [stop, failure] = std::from_chars(digits.data(), end, out);
    if (failure != std::errc() || stop != end) {
      refuse(token, fmt::format("'{}' is not a number", token.text));
      return 0.0;
    }
    return out;
  }

  std::uint64_t whole(std::string_view what, std::uint64_t most) {
    const DbcToken token = expect(DbcToken::Kind::kNumber, what);
    if (error_) return 0;
    std::uint64_t out = 0;
    const char* const end = token.text.data() + token.text.size();
    const auto [stop, failure] = std::from_chars(token.text.data(), end, out);
    if (failure != std::errc() || stop != end || out > most) {
      refuse(token, fmt::format("'{}' is not a valid {} (a whole number, at most {})", token.text,
                                what, most));
      return 0;
    }
    return out;
  }

  void section() {
    const DbcToken keyword = take();
    if (keyword.is("BO_")) return message();
    if (keyword.is("SIG_VALTYPE_")) return value_type();
    if (keyword.is("SG_MUL_VAL_")) return multiplex_values();
    if (contains(kSkipped, keyword.text)) {
      while (!error_ && !token_.is(";")) {
        if (token_.kind == DbcToken::Kind::kEnd) {
          return refuse(keyword, fmt::format("{} has no closing ';'", keyword.text));
        }
        advance();
      }
      return advance();
    }
    if (contains(kIndented, keyword.text)) {
      while (!error_ && token_.kind != DbcToken::Kind::kEnd && token_.column > 1) advance();
      return;
    }
    refuse(keyword, fmt::format("unknown section '{}'", keyword.text));
  }

  // BO_ id name: length sender, then its signals
  void message() {
    const DbcToken id_token = token_;
    const auto id = static_cast<std::uint32_t>(whole("identifier", 0xffff'ffff));
    CanMessage out;
    out.extended = (id & kDbcExtendedFlag) != 0;
    out.id = id & kExtendedMask;
    out.name = expect(DbcToken::Kind::kName, "a message's name").text;
    expect_mark(":");
    out.length = whole("message length in bytes", kLongestMessage);
    expect(DbcToken::Kind::kName, "the sender's name");
    const bool unused = id == kNoMessage;
    if (!unused && (id & ~kDbcExtendedFlag) > (out.extended ? kExtendedMask : kStandardMask)) {
      refuse(id_token, fmt::format("{} is not an identifier: 11 bits, or 29 and bit 31 set", id));
    }
    if (!unused && !ids_.insert(id).second) {
      refuse(id_token, fmt::format("identifier {} is defined twice", id));
    }
    while (!error_ && token_.is("SG_")) signal(out, unused);
    if (!error_ && !unused) messages_.push_back(std::move(out));
  }

  // SG_ name [M|mN|mNM] : start|length@order sign (factor,offset) [min|max] "unit" receivers
  void signal(CanMessage& message, bool unused) {
    advance();
    CanSignal out;
    const DbcToken name = expect(DbcToken::Kind::kName, "a signal's name");
    out.name = name.text;
    if (token_.kind == DbcToken::Kind::kName) multiplex_mark(out);
    expect_mark(":");
    bit_field(out);
    expect_mark("(");
    const DbcToken factor = token_;
    out.factor = number("a factor");
    expect_mark(",");
    out.offset = number("an offset");
    expect_mark(")");
    expect_mark("[");
    number("a minimum");
    expect_mark("|");
    number("a maximum");
    expect_mark("]");
    out.unit = as_utf8(expect(DbcToken::Kind::kText, "a unit in quotes").text);
    expect(DbcToken::Kind::kName, "a receiver's name");
    while (!error_ && token_.is(",")) {
      advance();
      expect(DbcToken::Kind::kName, "a receiver's name");
    }
    if (error_) return;
    if (out.factor == 0.0) return refuse(factor, "a factor of 0 makes every value the same");
    if (!unused && bytes_needed(out.field) > message.length) {
      return refuse(name, fmt::format("signal {} needs {} bytes, its message {} has {}", out.name,
                                      bytes_needed(out.field), message.name, message.length));
    }
    if (find_signal(message, out.name) != nullptr) {
      return refuse(name, fmt::format("message {} has two signals {}", message.name, out.name));
    }
    message.signals.push_back(std::move(out));
  }

  void multiplex_mark(CanSignal& out) {
    const DbcToken token = take();
    std::string_view text = token.text;
    if (text.ends_with('M')) {
      out.multiplexor = true;
      text.remove_suffix(1);
    }
    if (text.empty()) return;
    std::uint64_t value = 0;
    const char* const end = text.data() + text.size();
    const auto [stop, failure] = std::from_chars(text.data() + 1, end, value);
    if (text.front() != 'm' || failure != std::errc() || stop != end) {
      return refuse(token, fmt::format("'{}' is not a multiplexing mark (M, m0, m0M)", token.text));
    }
    out.present_at.push_back({value, value});
  }

  // start|length@order sign
  void bit_field(CanSignal& out) {
    out.field.start = whole("start bit", 8 * kLongestMessage - 1);
    expect_mark("|");
    const DbcToken length = token_;
    out.field.length = whole("length in bits", 64);
    if (!error_ && out.field.length == 0) refuse(length, "a signal has at least one bit");
    expect_mark("@");
    out.field.order = whole("byte order", 1) == 1 ? ByteOrder::kLittle : ByteOrder::kBig;
    if (!token_.is("+") && !token_.is("-")) return refuse_instead_of("'+' or '-'");
    out.type = take().is("-") ? SignalType::kSigned : SignalType::kUnsigned;
  }

  static CanSignal* find_signal(CanMessage& message, std::string_view name) {
    const auto found = std::find_if(message.signals.begin(), message.signals.end(),
                                    [&](const CanSignal& signal) { return signal.name == name; });
    return found == message.signals.end() ? nullptr : &*found;
  }

  // The message of the identifier and the signal of the name that come next.
  std::pair<CanMessage*, CanSignal*> reference() {
    const DbcToken id_token = token_;
    const auto id = static_cast<std::uint32_t>(whole("identifier", 0xffff'ffff));
    const DbcToken name = expect(DbcToken::Kind::kName, "a signal's name");
    if (error_ || id == kNoMessage) return {};
    const auto message =
        std::find_if(messages_.begin(), messages_.end(), [&](const CanMessage& known) {
          return known.id == (id & kExtendedMask) &&
                 known.extended == ((id & kDbcExtendedFlag) != 0);
        });
    if (message == messages_.end()) {
      refuse(id_token, fmt::format("no message before this line has the identifier {}", id));
      return {};
    }
    CanSignal* const signal = find_signal(*message, name.text);
    if (signal == nullptr) {
      refuse(name, fmt::format("message {} has no signal {}", message->name, name.text));
    }
    return {&*message, signal};
  }

  // SIG_VALTYPE_ id signal : type;
  void value_type() {
    const DbcToken place = token_;
    CanSignal* const signal = reference().second;
    if (token_.is(":")) advance();  // some files leave it out
    const std::uint64_t type = whole("value type", 2);
    expect_mark(";");
    if (error_ || signal == nullptr || type == 0) return;
    if (signal->field.length != 32 * type) {
      return refuse(place,
                    fmt::format("signal {} has {} bits; a {} has {}", signal->name,
                                signal->field.length, type == 1 ? "float" : "double", 32 * type));
    }
    signal->type = type == 1 ? SignalType::kFloat32 : SignalType::kFloat64;
  }

  // SG_MUL_VAL_ id signal multiplexor first-last, first-last ...;
  void multiplex_values() {
    const auto [message, signal] = reference();
    const DbcToken name = expect(DbcToken::Kind::kName, "a multiplexor's name");
    std::vector<MultiplexRange> ranges;
    do {
      if (token_.is(",")) advance();
      MultiplexRange range;
      range.first = whole("first multiplexor value", ~std::uint64_t{0});
      // "3-5" reads as 3 and -5
      if (token_.kind == DbcToken::Kind::kNumber && token_.text.starts_with('-')) {
        token_.text.remove_prefix(1);
      } else {
        expect_mark("-");
      }
      range.last = whole("last multiplexor value", ~std::uint64_t{0});
      ranges.push_back(range);
    } while (!error_ && token_.is(","));
    expect_mark(";");
    if (error_ || signal == nullptr) return;
    CanSignal* const multiplexor = find_signal(*message, name.text);
    if (multiplexor == nullptr || !multiplexor->multiplexor || multiplexor == signal) {
      return refuse(
          name, fmt::format("message {} has no other multiplexor {}", message->name, name.text));
    }
    signal->switched_by = static_cast<std::size_t>(multiplexor - message->signals.data());
    signal->present_at = std::move(ranges);
  }

  // Signals with a mark and without SG_MUL_VAL_ belong to the message's only multiplexor that is
  // not switched itself.
  void resolve_multiplexors(CanMessage& message) {
    std::vector<std::size_t> roots;
    for (std::size_t i = 0; i < message.signals.size(); ++i) {
      const CanSignal& signal = message.signals[i];
      if (signal.multiplexor && signal.present_at.empty()) roots.push_back(i);
    }
    for (CanSignal& signal : message.signals) {
      if (signal.present_at.empty() || signal.switched_by) continue;
      if (roots.size() != 1) {
        return refuse(token_,
                      fmt::format("message {}: signal {} is multiplexed, and {} signals are "
                                  "marked M: mark one, or name it in SG_MUL_VAL_",
                                  message.name, signal.name, roots.size()));
      }
      signal.switched_by = roots.front();
    }
    for (const CanSignal& signal : message.signals) {
      std::size_t steps = 0;
      for (const CanSignal* at = &signal; at->switched_by;
           at = &message.signals[*at->switched_by]) {
        if (++steps > kDeepestMultiplexing) {
          return refuse(token_, fmt::format("message {}: the multiplexors of signal {} switch each "
                                            "other in a circle, or more than {} deep",
                                            message.name, signal.name, kDeepestMultiplexing));
        }
      }
    }
  }

  DbcLexer lexer_;
  DbcToken token_;
  std::optional<Error> error_;
  std::vector<CanMessage> messages_;
  std::set<std::uint32_t> ids_;
};

}  // namespace

Result<CanDatabase> parse_dbc(std::string_view text, std::string_view file) {
  if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
  return Parser(text, file).parse();
}

}  // namespace imunoise::drivers
