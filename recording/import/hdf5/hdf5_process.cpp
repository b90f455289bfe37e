#include "recording/import/hdf5/hdf5_process.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstring>
#include <new>
#include <system_error>
#include <type_traits>
#include <utility>

#include "recording/hdf5/dataset.h"
#include "recording/hdf5/limited_child.h"

namespace imunoise::recording {
namespace {

// What HDF5 may need besides the numbers that a file holds: its own tables, and chunks as they are
// stored.
constexpr std::uint64_t kMemory = std::uint64_t{256} << 20U;
constexpr std::uint64_t kCopies = 4;  // of the numbers of one dataset, while they are converted
constexpr std::uint64_t kSeconds = 2;
constexpr std::uint64_t kBytesASecond = std::uint64_t{2} << 20U;  // at the slowest
constexpr std::chrono::seconds kLongestSilence{60};  // the disk's and the machine's other work too
constexpr std::uint64_t kLongestMessage = std::uint64_t{64} << 20U;

template <class Number>
concept Plain = std::is_trivially_copyable_v<Number>;

// A message of plain numbers, texts and attributes, one after the other.
class Packer {
 public:
  template <Plain Number>
  void put(Number number) {
    std::array<char, sizeof number> bytes;
    std::memcpy(bytes.data(), &number, sizeof number);
    bytes_.append(bytes.data(), bytes.size());
  }
  void put(const std::string& text) {
    put(std::uint64_t{text.size()});
    bytes_ += text;
  }
  template <class Value>
  void put(const Hdf5Attribute<Value>& attribute) {
    put(attribute.has_value());
    if (!attribute) return put(attribute.error().message);
    put(attribute->has_value());
    if (*attribute) put(**attribute);
  }
  bool send(const Line& line) const {
    Packer length;
    length.put(std::uint64_t{bytes_.size()});
    return line.send(length.bytes_) && line.send(bytes_);
  }

 private:
  std::string bytes_;
};

// Takes a message to pieces. What a crashing child sent may be anything: it then is not good(), and
// what was taken means nothing.
class Unpacker {
 public:
  explicit Unpacker(std::string_view bytes) : left_(bytes) {}

  bool good() const { return good_; }
  template <Plain Number>
  void take(Number& number) {
    const std::string_view bytes = next(sizeof number);
    if (good_) std::memcpy(&number, bytes.data(), sizeof number);
  }
  bool take_bool() {
    char value = 0;
    take(value);
    return value != 0;
  }
  void take(std::string& text) {
    std::uint64_t size = 0;
    take(size);
    text = next(size);
  }
  template <class Value>
  void take(Hdf5Attribute<Value>& attribute) {
    if (!take_bool()) {
      std::string message;
      take(message);
      attribute = fail(std::move(message));
    } else if (take_bool()) {
      Value value{};
      take(value);
      attribute = std::optional<Value>(std::move(value));
    } else {
      attribute = std::optional<Value>();
    }
  }

 private:
  std::string_view next(std::uint64_t size) {
    good_ = good_ && size <= left_.size();
    const std::string_view out = left_.substr(0, good_ ? size : 0);
    left_.remove_prefix(out.size());
    return out;
  }

  std::string_view left_;
  bool good_ = true;
};

void pack(const Hdf5Facts& facts, Packer& out) {
  out.put(facts.rate);
  out.put(facts.rate_from);
  out.put(std::uint64_t{facts.columns.size()});
  for (const Hdf5Column& one : facts.columns) {
    out.put(one.name);
    out.put(one.by_default);
    out.put(one.trouble);
    out.put(one.size);
    out.put(one.scale);
    out.put(one.offset);
    out.put(one.unit);
  }
}

bool unpack(Unpacker& in, Hdf5Facts& facts) {
  in.take(facts.rate);
  in.take(facts.rate_from);
  std::uint64_t columns = 0;
  in.take(columns);
  for (; in.good() && columns > 0; --columns) {
    Hdf5Column& one = facts.columns.emplace_back();
    in.take(one.name);
    one.by_default = in.take_bool();
    in.take(one.trouble);
    in.take(one.size);
    in.take(one.scale);
    in.take(one.offset);
    in.take(one.unit);
  }
  return in.good();
}

// s
std::uint64_t computing_limit(std::uint64_t file_bytes, std::uint64_t number_bytes) {
  return kSeconds + (file_bytes + number_bytes) / kBytesASecond;
}

template <class Numbers>
std::span<const char> bytes_of(const Numbers& numbers) {
  return {reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(numbers[0])};
}
template <class Numbers>
std::span<char> room_of(Numbers& numbers) {
  return {reinterpret_cast<char*>(numbers.data()), numbers.size() * sizeof(numbers[0])};
}

// In the child -----------------------------------------------------------------------------------

void limit(std::uint64_t file_bytes, std::uint64_t number_bytes) {
  limit_memory(kMemory + file_bytes + kCopies * number_bytes);
  limit_computing(computing_limit(file_bytes, number_bytes));
}

// Message: what went wrong, or "", index of the type in Samples, count; then so many numbers.
bool answer(const Line& line, const Result<Samples>& piece) {
  Packer head;
  head.put(piece ? std::string() : piece.error().message);
  if (!piece) return head.send(line);
  head.put(std::uint64_t{piece->index()});
  head.put(std::uint64_t{size(*piece)});
  return head.send(line) &&
         std::visit([&](const auto& numbers) { return line.send(bytes_of(numbers)); }, *piece);
}

void serve(const Line& line, const std::filesystem::path& path, std::uint64_t bytes) {
  limit(bytes, 0);
  const auto source = Hdf5Source::open(path);
  Packer facts;
  facts.put(source ? std::string() : source.error().message);
  if (source) pack((*source)->facts(), facts);
  if (!facts.send(line) || !source) return;
  std::array<std::uint64_t, 1> wanted = {};
  while (line.receive(room_of(wanted))) {
    limit(bytes, (*source)->facts().columns.at(wanted[0]).size * sizeof(double));
    bool sent = true;
    try {
      const auto read = (*source)->read(
          wanted[0], [&](Samples piece) { return sent = answer(line, std::move(piece)); });
      if (!read) sent = answer(line, tl::make_unexpected(read.error()));
    } catch (const std::bad_alloc&) {
      sent = answer(line, fail("it needs more memory than available"));
    }
    if (!sent) return;
  }
}

// In the parent ----------------------------------------------------------------------------------

class Hdf5Process : public Hdf5Reader {
 public:
  Hdf5Process(LimitedChild child, std::uint64_t bytes, std::function<bool()> stopped)
      : child_(std::move(child)), bytes_(bytes), stopped_(std::move(stopped)) {}

  Result<void> learn() {
    const auto message = receive_message();
    if (!message) return tl::make_unexpected(message.error());
    Unpacker in(*message);
    std::string trouble;
    in.take(trouble);
    if (!trouble.empty()) return fail(std::move(trouble));
    return unpack(in, facts_) ? Result<void>() : nonsense();
  }

  Result<Samples> read(std::size_t column) override {
    const std::array wanted = {std::uint64_t{column}};
    if (!child_.line().send(bytes_of(wanted))) return broken_off();
    const std::uint64_t all = facts_.columns.at(column).size;
    const auto first = receive_head(all);
    if (!first) return tl::make_unexpected(first.error());
    read_ += all * (first->type == 1 ? sizeof(std::int16_t) : sizeof(float));
    if (read_ / kBestCompression > bytes_) {
      return fail(
          "its datasets claim more numbers than the file can hold; it is damaged, or several names "
          "stand for one dataset: choose with --channel");
    }
    if (first->type == 0) return receive_numbers<double>(all, *first);
    if (first->type == 1) return receive_numbers<std::int16_t>(all, *first);
    return receive_numbers<std::int32_t>(all, *first);
  }

 private:
  // It has to compute within its limit, and may be one of many programs meanwhile.
  std::chrono::nanoseconds silence() const {
    std::uint64_t numbers = 0;
    for (const Hdf5Column& one : facts_.columns) numbers = std::max(numbers, one.size);
    return kLongestSilence +
           10 * std::chrono::seconds(computing_limit(bytes_, numbers * sizeof(double)));
  }
  tl::unexpected<Error> nonsense() const {
    return fail("HDF5 returned invalid data: the file is damaged; copy it again");
  }
  tl::unexpected<Error> broken_off() {
    if (stopped_()) return fail("the import was stopped");
    return fail(
        fmt::format("HDF5 cannot read it ({}): it is damaged; copy it again, or write it anew with "
                    "h5repack",
                    child_.cause_of_death()));
  }
  Result<std::string> receive_message() {
    std::array<std::uint64_t, 1> length = {};
    if (!child_.line().receive(room_of(length), stopped_, silence())) return broken_off();
    if (length[0] > kLongestMessage) return nonsense();
    std::string out(length[0], '\0');
    if (!child_.line().receive(out, stopped_, silence())) return broken_off();
    return out;
  }
  // Of a piece.
  struct Head {
    std::uint64_t type = 0;
    std::uint64_t count = 0;
  };
  Result<Head> receive_head(std::uint64_t most) {
    const auto message = receive_message();
    if (!message) return tl::make_unexpected(message.error());
    Unpacker in(*message);
    std::string trouble;
    Head out;
    in.take(trouble);
    if (!trouble.empty()) return fail(std::move(trouble));
    in.take(out.type);
    in.take(out.count);
    if (!in.good() || out.type > 2 || out.count == 0 || out.count > most) return nonsense();
    return out;
  }
  // Piece by piece; the child announced the first.
  template <class Number>
  Result<Samples> receive_numbers(std::uint64_t all, Head head) {
    std::vector<Number> out(all);
    for (std::uint64_t got = 0;;) {
      const std::span<Number> room = std::span(out).subspan(got, head.count);
      if (!child_.line().receive(room_of(room), stopped_, silence())) return broken_off();
      got += head.count;
      if (got == all) return Samples(std::move(out));
      const auto next = receive_head(all - got);
      if (!next) return tl::make_unexpected(next.error());
      if (next->type != head.type) return nonsense();
      head = *next;
    }
  }

  LimitedChild child_;
  std::uint64_t bytes_;
  std::uint64_t read_ = 0;  // bytes of numbers, as the file may hold them at least
  std::function<bool()> stopped_;
};

}  // namespace

Result<std::unique_ptr<Hdf5Reader>> open_hdf5_apart(const std::filesystem::path& path,
                                                    std::uint64_t bytes,
                                                    std::function<bool()> stopped) {
  if constexpr (!kHdf5Apart) return Hdf5Source::open(path);
  std::error_code unknown;  // a name such as /dev/fd/3 means nothing to the child
  const std::filesystem::path real = std::filesystem::canonical(path, unknown);
  auto child =
      LimitedChild::start([&](const Line& line) { serve(line, unknown ? path : real, bytes); });
  if (!child) return tl::make_unexpected(child.error());
  auto out = std::make_unique<Hdf5Process>(std::move(*child), bytes, std::move(stopped));
  if (auto learnt = out->learn(); !learnt) return tl::make_unexpected(learnt.error());
  return out;
}

}  // namespace imunoise::recording
