#include "recording/import/arrays/matrix_reader.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>

#include "recording/import/arrays/number_layout.h"

namespace imunoise::recording {
namespace {

enum MatrixType : std::uint32_t { kInt8 = 1, kUint8, kInt16, kUint16, kInt32, kUint32, kSingle };
constexpr std::uint32_t kDouble = 9;
constexpr std::uint32_t kInt64 = 12;
constexpr std::uint32_t kUint64 = 13;
constexpr std::uint32_t kMatrix = 14;

enum MatrixClass : std::uint32_t { kCellClass = 1, kStructClass = 2, kCharClass = 4 };
constexpr std::uint32_t kFirstNumbers = 6;  // double, single, int8 ... uint64
constexpr std::uint32_t kLastNumbers = 15;
constexpr std::uint32_t kOpaqueClass = 17;

constexpr int kDeepest = 8;                       // structs within structs
constexpr std::uint64_t kLongestText = 1 << 16U;  // bytes of names and dimensions
constexpr std::size_t kMostMatrices = 65536;

// The numbers of a type; a width of 0 for one that is none.
NumberLayout layout_of(std::uint32_t type, bool swap) {
  using Kind = NumberLayout::Kind;
  switch (type) {
    case kInt8:
      return {Kind::kSigned, 1, swap};
    case kUint8:
      return {Kind::kUnsigned, 1, swap};
    case kInt16:
      return {Kind::kSigned, 2, swap};
    case kUint16:
      return {Kind::kUnsigned, 2, swap};
    case kInt32:
      return {Kind::kSigned, 4, swap};
    case kUint32:
      return {Kind::kUnsigned, 4, swap};
    case kSingle:
      return {Kind::kFloat, 4, swap};
    case kDouble:
      return {Kind::kFloat, 8, swap};
    case kInt64:
      return {Kind::kSigned, 8, swap};
    case kUint64:
      return {Kind::kUnsigned, 8, swap};
    default:
      return {Kind::kFloat, 0, swap};
  }
}

}  // namespace

// Where the reader stands: what is left of the matrix at hand. Elements are padded to 8 bytes.
struct MatrixReader::Place {
  ByteStream& stream;
  std::uint64_t left = 0;

  // Whether all bytes were there.
  Result<bool> take(std::span<char> out) {
    if (out.size() > left) return fail("a matrix is damaged; save the file again");
    const Result<std::size_t> got = stream.read(out);
    if (!got) return tl::make_unexpected(got.error());
    left -= *got;
    return *got == out.size();
  }
  Result<bool> pass(std::uint64_t count) {
    count = std::min(count, left);
    const Result<std::uint64_t> got = stream.skip(count);
    if (!got) return tl::make_unexpected(got.error());
    left -= *got;
    return *got == count;
  }
};

Result<bool> MatrixReader::tag(Place& at, Tag& out) const {
  std::array<char, 8> raw;
  const Result<bool> whole = at.take(raw);
  if (!whole || !*whole) return whole;
  out.type = plain_number<std::uint32_t>(raw.data(), swap_);
  out.bytes = plain_number<std::uint32_t>(raw.data() + 4, swap_);
  out.is_small = out.type >> 16U != 0;
  if (!out.is_small) return true;
  out.bytes = out.type >> 16U;
  out.type &= 0xffffU;
  if (out.bytes > 4) return fail("a matrix is damaged; save the file again");
  out.small.assign(raw.data() + 4, out.bytes);
  return true;
}

// All of an element that is short.
Result<bool> MatrixReader::content(Place& at, const Tag& tag, std::uint64_t most,
                                   std::string& out) const {
  if (tag.is_small) {
    out = tag.small;
    return true;
  }
  if (tag.bytes > most || tag.bytes > at.left) return fail("a matrix is damaged; save it again");
  out.resize(tag.bytes);
  const Result<bool> whole = at.take(out);
  if (!whole || !*whole) return whole;
  return at.pass((8 - tag.bytes % 8) % 8);
}

Result<bool> MatrixReader::matrix(ByteStream& stream, std::uint64_t bytes) {
  Place at{stream, bytes};
  return walk(at, bytes, "", 0);
}

// One matrix of `bytes` bytes, whatever of it is understood.
Result<bool> MatrixReader::walk(Place& at, std::uint64_t bytes, const std::string& prefix,
                                int depth) {
  if (bytes == 0) return true;
  if (bytes > at.left) return fail("a matrix is damaged; save the file again");
  Place inner{at.stream, bytes};
  const Result<bool> whole = inside(inner, prefix, depth);
  if (!whole || !*whole) return whole;
  const Result<bool> passed = inner.pass(inner.left);
  at.left -= bytes;
  return passed;
}

Result<bool> MatrixReader::inside(Place& at, const std::string& prefix, int depth) {
  Tag head;
  std::string text;
  Result<bool> whole = tag(at, head);
  if (whole && *whole) whole = content(at, head, kLongestText, text);
  if (!whole || !*whole) return whole;
  if (text.size() < 4) return fail("a matrix is damaged; save the file again");
  const std::uint32_t kind = plain_number<std::uint32_t>(text.data(), swap_) & 0xffU;
  if (kind == kOpaqueClass) {
    visitor_.note("tables, timetables and objects are left out: save their columns as arrays");
    return true;
  }
  whole = tag(at, head);
  std::string extents;
  if (whole && *whole) whole = content(at, head, kLongestText, extents);
  if (whole && *whole) whole = tag(at, head);
  std::string name;
  if (whole && *whole) whole = content(at, head, kLongestText, name);
  if (!whole || !*whole) return whole;
  if (!prefix.empty()) name = prefix;
  NamedArray array{name, {1, 1}, true};
  const std::size_t dimensions = extents.size() / 4;
  for (std::size_t d = 0; d < dimensions; ++d) {
    const std::uint64_t extent = plain_number<std::uint32_t>(extents.data() + 4 * d, swap_);
    std::uint64_t& to = d == 0 ? array.shape.rows : array.shape.columns;
    if (__builtin_mul_overflow(to, extent, &to)) to = 0;
  }
  if (kind == kStructClass && array.shape.is_single() && depth < kDeepest)
    return fields(at, name, depth);
  if (kind >= kFirstNumbers && kind <= kLastNumbers && dimensions == 2)
    return numbers(at, std::move(array));
  if (kind != kCharClass)
    visitor_.note(fmt::format("{} is no matrix of numbers: left out", name.empty() ? "?" : name));
  return true;
}

Result<bool> MatrixReader::fields(Place& at, const std::string& name, int depth) {
  Tag head;
  std::string length;
  std::string names;
  Result<bool> whole = tag(at, head);
  if (whole && *whole) whole = content(at, head, 8, length);
  if (whole && *whole) whole = tag(at, head);
  if (whole && *whole) whole = content(at, head, kLongestText, names);
  if (!whole || !*whole) return whole;
  const std::size_t each =
      length.size() < 4 ? 0 : plain_number<std::uint32_t>(length.data(), swap_);
  if (each == 0) return true;
  for (std::size_t f = 0; f + each <= names.size(); f += each) {
    std::string field = names.substr(f, each);
    field.resize(std::min(field.size(), field.find('\0')));
    whole = tag(at, head);
    if (!whole || !*whole) return whole;
    if (head.type != kMatrix) return fail("a struct is damaged; save the file again");
    whole = walk(at, head.bytes, fmt::format("{}.{}", name, field), depth + 1);
    if (!whole || !*whole) return whole;
  }
  return true;
}

Result<bool> MatrixReader::numbers(Place& at, NamedArray array) {
  Tag head;
  Result<bool> whole = tag(at, head);
  if (!whole || !*whole) return whole;
  const NumberLayout layout = layout_of(head.type, swap_);
  const std::size_t width = layout.width;
  std::uint64_t count = 0;
  if (__builtin_mul_overflow(array.shape.rows, array.shape.columns, &count) || width == 0 ||
      head.bytes / width != count) {
    return fail(fmt::format("matrix {} announces {} x {} numbers in {} bytes; save it again",
                            array.name, array.shape.rows, array.shape.columns, head.bytes));
  }
  if (count == 0) return true;
  if (count_ >= kMostMatrices) return fail("holds too many matrices; save those of the sensor");
  std::string single = head.small;
  if (count == 1) {
    if (!head.is_small) whole = content(at, head, 8, single);
    if (!whole || !*whole) return whole;
    array.number = number_at(single.data(), layout);
    head.is_small = true;
  }
  const std::size_t index = count_++;
  const bool wanted = visitor_.begin(array, index);
  if (head.is_small) {
    for (std::uint64_t i = 0; wanted && i < count; ++i)
      visitor_.number(index, number_at(single.data() + i * width, layout));
    visitor_.end(index);
    return true;
  }
  if (!wanted) {
    whole = at.pass(head.bytes);
    if (whole && *whole) visitor_.end(index);
    return whole;
  }
  std::array<char, 8192> block;
  for (std::uint64_t left = head.bytes; left > 0;) {
    const std::size_t step = std::min<std::uint64_t>(block.size(), left);
    whole = at.take(std::span(block).first(step));
    if (!whole || !*whole) return whole;
    for (std::size_t i = 0; i < step; i += width)
      visitor_.number(index, number_at(block.data() + i, layout));
    left -= step;
  }
  visitor_.end(index);
  return true;
}

}  // namespace imunoise::recording
