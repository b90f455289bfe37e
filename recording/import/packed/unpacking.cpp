#include "recording/import/packed/unpacking.h"

#include <bzlib.h>
#include <fmt/core.h>
#include <lz4frame.h>
#include <zlib.h>
#include <zstd.h>

#include <vector>

namespace imunoise::recording {
namespace {

constexpr std::size_t kPackedBlock = std::size_t{1} << 16U;

// What is left of the packed bytes at hand, and of the room.
struct Buffers {
  std::span<char> in;
  std::span<char> out;
};

enum class Step {
  kGoesOn,
  kEnded,  // a whole stream; another may follow
  kDamaged,
};

// A library behind one face: step() takes from `in` and fills `out`.
class Codec {
 public:
  virtual ~Codec() = default;
  virtual bool ready() = 0;
  virtual Step step(Buffers& buffers) = 0;
  /// Makes ready for a stream that follows an ended one.
  virtual bool again() = 0;
};

class ZlibCodec : public Codec {
 public:
  explicit ZlibCodec(int window_bits) : made_(inflateInit2(&stream_, window_bits) == Z_OK) {}
  ~ZlibCodec() override {
    if (made_) inflateEnd(&stream_);
  }
  ZlibCodec(const ZlibCodec&) = delete;
  ZlibCodec& operator=(const ZlibCodec&) = delete;

  bool ready() override { return made_; }
  Step step(Buffers& buffers) override {
    stream_.next_in = reinterpret_cast<Bytef*>(buffers.in.data());
    stream_.avail_in = static_cast<uInt>(buffers.in.size());
    stream_.next_out = reinterpret_cast<Bytef*>(buffers.out.data());
    stream_.avail_out = static_cast<uInt>(buffers.out.size());
    const int said = inflate(&stream_, Z_NO_FLUSH);
    buffers.in = buffers.in.last(stream_.avail_in);
    buffers.out = buffers.out.last(stream_.avail_out);
    if (said == Z_STREAM_END) return Step::kEnded;
    return said == Z_OK || said == Z_BUF_ERROR ? Step::kGoesOn : Step::kDamaged;
  }
  bool again() override { return inflateReset(&stream_) == Z_OK; }

 private:
  z_stream stream_ = {};
  bool made_;
};

class ZstdCodec : public Codec {
 public:
  bool ready() override { return stream_ != nullptr; }
  Step step(Buffers& buffers) override {
    ZSTD_inBuffer in{buffers.in.data(), buffers.in.size(), 0};
    ZSTD_outBuffer out{buffers.out.data(), buffers.out.size(), 0};
    const std::size_t said = ZSTD_decompressStream(stream_.get(), &out, &in);
    buffers.in = buffers.in.subspan(in.pos);
    buffers.out = buffers.out.subspan(out.pos);
    if (ZSTD_isError(said) != 0) return Step::kDamaged;
    return said == 0 ? Step::kEnded : Step::kGoesOn;
  }
  bool again() override { return true; }

 private:
  std::unique_ptr<ZSTD_DStream, decltype(&ZSTD_freeDStream)> stream_{ZSTD_createDStream(),
                                                                     &ZSTD_freeDStream};
};

class Bzip2Codec : public Codec {
 public:
  Bzip2Codec() : made_(BZ2_bzDecompressInit(&stream_, 0, 0) == BZ_OK) {}
  ~Bzip2Codec() override {
    if (made_) BZ2_bzDecompressEnd(&stream_);
  }
  Bzip2Codec(const Bzip2Codec&) = delete;
  Bzip2Codec& operator=(const Bzip2Codec&) = delete;

  bool ready() override { return made_; }
  Step step(Buffers& buffers) override {
    stream_.next_in = buffers.in.data();
    stream_.avail_in = static_cast<unsigned>(buffers.in.size());
    stream_.next_out = buffers.out.data();
    stream_.avail_out = static_cast<unsigned>(buffers.out.size());
    const int said = BZ2_bzDecompress(&stream_);
    buffers.in = buffers.in.last(stream_.avail_in);
    buffers.out = buffers.out.last(stream_.avail_out);
    if (said == BZ_STREAM_END) return Step::kEnded;
    return said == BZ_OK ? Step::kGoesOn : Step::kDamaged;
  }
  bool again() override {
    BZ2_bzDecompressEnd(&stream_);
    stream_ = {};
    made_ = BZ2_bzDecompressInit(&stream_, 0, 0) == BZ_OK;
    return made_;
  }

 private:
  bz_stream stream_ = {};
  bool made_;
};

class Lz4Codec : public Codec {
 public:
  Lz4Codec() {
    if (LZ4F_isError(LZ4F_createDecompressionContext(&context_, LZ4F_VERSION)) != 0)
      context_ = nullptr;
  }
  ~Lz4Codec() override { LZ4F_freeDecompressionContext(context_); }
  Lz4Codec(const Lz4Codec&) = delete;
  Lz4Codec& operator=(const Lz4Codec&) = delete;

  bool ready() override { return context_ != nullptr; }
  Step step(Buffers& buffers) override {
    std::size_t wrote = buffers.out.size();
    std::size_t took = buffers.in.size();
    const std::size_t said =
        LZ4F_decompress(context_, buffers.out.data(), &wrote, buffers.in.data(), &took, nullptr);
    buffers.in = buffers.in.subspan(took);
    buffers.out = buffers.out.subspan(wrote);
    if (LZ4F_isError(said) != 0) return Step::kDamaged;
    return said == 0 ? Step::kEnded : Step::kGoesOn;
  }
  bool again() override { return true; }

 private:
  LZ4F_dctx* context_ = nullptr;
};

class Unpacking : public ByteStream {
 public:
  Unpacking(std::unique_ptr<Codec> codec, std::unique_ptr<ByteStream> packed, std::string name)
      : codec_(std::move(codec)),
        packed_(std::move(packed)),
        name_(std::move(name)),
        block_(kPackedBlock) {}

  Result<std::size_t> read(std::span<char> out) override {
    Buffers buffers{in_, out};
    while (!buffers.out.empty() && !over_) {
      if (buffers.in.empty()) {
        const Result<std::size_t> got = packed_->read(block_);
        if (!got) return got;
        buffers.in = std::span(block_).first(*got);
        if (*got == 0) {
          // What a library holds back comes out without further input.
          const std::size_t before = buffers.out.size();
          if (within_ && codec_->step(buffers) == Step::kGoesOn && buffers.out.size() < before)
            continue;
          over_ = true;
          break;
        }
      }
      if (!within_ && streams_ > 0 && !codec_->again()) return damaged();
      within_ = true;
      const std::size_t in_before = buffers.in.size();
      const std::size_t out_before = buffers.out.size();
      const Step said = codec_->step(buffers);
      if (said == Step::kDamaged && streams_ > 0 && produced_ == 0) {
        within_ = false;  // padding behind the last stream
        over_ = true;
        break;
      }
      if (said == Step::kDamaged) return damaged();
      produced_ += out_before - buffers.out.size();
      if (said == Step::kEnded) {
        ++streams_;
        within_ = false;
        produced_ = 0;
      } else if (buffers.in.size() == in_before && buffers.out.size() == out_before) {
        return damaged();
      }
    }
    in_ = buffers.in;
    return out.size() - buffers.out.size();
  }
  bool truncated() const override { return within_ || (over_ && streams_ == 0); }

 private:
  tl::unexpected<Error> damaged() const {
    return fail(fmt::format("{}: its packed bytes are damaged; copy it again", name_));
  }

  std::unique_ptr<Codec> codec_;
  std::unique_ptr<ByteStream> packed_;
  std::string name_;
  std::vector<char> block_;
  std::span<char> in_;
  std::size_t streams_ = 0;     // that have ended
  std::uint64_t produced_ = 0;  // bytes of the stream at hand
  bool within_ = false;         // a stream that has not ended
  bool over_ = false;
};

std::unique_ptr<Codec> codec_of(Packing packing) {
  switch (packing) {
    case Packing::kGzip:
      return std::make_unique<ZlibCodec>(MAX_WBITS + 16);
    case Packing::kZlib:
      return std::make_unique<ZlibCodec>(MAX_WBITS);
    case Packing::kDeflate:
      return std::make_unique<ZlibCodec>(-MAX_WBITS);
    case Packing::kZstd:
      return std::make_unique<ZstdCodec>();
    case Packing::kBzip2:
      return std::make_unique<Bzip2Codec>();
    case Packing::kLz4:
      break;
  }
  return std::make_unique<Lz4Codec>();
}

}  // namespace

std::optional<Packing> packing_of(std::string_view head) {
  if (head.starts_with("\x1f\x8b\x08")) return Packing::kGzip;
  if (head.starts_with("\x28\xb5\x2f\xfd")) return Packing::kZstd;
  if (head.size() > 4 && head.starts_with("BZh") && head.substr(4).starts_with("1AY&SY"))
    return Packing::kBzip2;
  if (head.starts_with("\x04\x22\x4d\x18")) return Packing::kLz4;
  return std::nullopt;
}

std::unique_ptr<ByteStream> unpacking(Packing packing, std::unique_ptr<ByteStream> packed,
                                      std::string name) {
  std::unique_ptr<Codec> codec = codec_of(packing);
  if (!codec->ready()) return nullptr;
  return std::make_unique<Unpacking>(std::move(codec), std::move(packed), std::move(name));
}

}  // namespace imunoise::recording
