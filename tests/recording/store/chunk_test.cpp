// Chunk files: what is written comes back, and no flipped bit passes.

#include "recording/store/chunk/chunk.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <limits>
#include <random>
#include <thread>

#include "recording/store/format/crc32c.h"
#include "tests/recording/files.h"
#include "tests/recording/store/samples.h"

namespace imunoise::recording {
namespace {

template <class Number>
std::vector<Number> extremes(std::mt19937_64& random, std::size_t count) {
  using Limits = std::numeric_limits<Number>;
  std::vector<Number> out = {Limits::lowest(), Limits::max(), Number(0), Number(-1)};
  while (out.size() < count) {
    if constexpr (std::is_integral_v<Number>) {
      out.push_back(static_cast<Number>(random()));
    } else {
      out.push_back(static_cast<Number>(std::ldexp(static_cast<double>(random()) - 9e18, -70)));
    }
  }
  return out;
}

// One stream with a channel of every type, one without rows.
Chunk every_type(std::size_t rows) {
  std::mt19937_64 random(3);
  Chunk out;
  out.replicate = 7;
  out.first_sequence = 12;
  out.last_sequence = 99;
  out.device = test_device();
  out.device.clear_streams();
  v1::RecordedStream* const stream = out.device.add_streams();
  stream->set_name("all");
  stream->set_rate_hz(819.2);
  stream->set_counter_modulus(4294967296);
  stream->set_counter_step(100);
  for (const char* dtype : {"<i8", "<f4", "<i2", "<f8", "<i4"}) {
    v1::RecordedChannel* const one = stream->add_channels();
    *one = channel(std::string("z_") + (dtype + 1), dtype);  // not in the order of names
  }
  stream->mutable_channels(2)->set_name("a");
  stream->mutable_channels(2)->set_scale_factor(0.05);
  stream->mutable_channels(2)->set_add_offset(-3.25);
  stream->mutable_channels(2)->set_units("deg/s");
  stream->mutable_channels(2)->set_long_name("first by name, third by place; °");
  stream->mutable_channels(2)->set_valid_min(-8192);
  stream->mutable_channels(2)->set_valid_max(8191);
  *out.device.add_streams() = test_device().streams(1);
  Rows all = empty_rows(*stream);
  all.channels = {extremes<std::int64_t>(random, rows), extremes<float>(random, rows),
                  extremes<std::int16_t>(random, rows), extremes<double>(random, rows),
                  extremes<std::int32_t>(random, rows)};
  all.host_time = extremes<std::int64_t>(random, rows);
  all.counter = extremes<std::int64_t>(random, rows);
  all.flags.assign(rows, 5);
  all.flags[rows / 2] |= kLostBefore;
  all.refused = {{Refused::kChecksum, "", 4}, {Refused::kOutOfRange, "a", 3}};
  all.received = rows + 7;
  out.streams = {all, empty_rows(test_device().streams(1))};
  return out;
}

void expect_same(const Rows& a, const Rows& b) {
  EXPECT_EQ(a.host_time, b.host_time);
  EXPECT_EQ(a.counter, b.counter);
  EXPECT_EQ(a.flags, b.flags);
  EXPECT_EQ(a.channels, b.channels);
  EXPECT_EQ(a.received, b.received);
  EXPECT_EQ(a.refused, b.refused);
}

TEST(Crc32c, ExamplesOfRfc3720) {
  std::string counting;
  for (char c = 0; c < 32; ++c) counting += c;
  EXPECT_EQ(crc32c(std::string(32, '\0')), 0x8a9136aaU);
  EXPECT_EQ(crc32c(std::string(32, '\xff')), 0x62a8ab43U);
  EXPECT_EQ(crc32c(counting), 0x46dd794eU);
  EXPECT_EQ(crc32c(counting.substr(0, 13), counting.substr(13)), 0x46dd794eU);
  for (std::size_t length = 0; length <= counting.size(); ++length) {
    EXPECT_EQ(crc32c(counting.substr(length), counting.substr(0, length)),
              crc32c_by_table(counting.substr(length), counting.substr(0, length)));
  }
  EXPECT_EQ(crc32c("123456789"), 0xe3069283U);
  EXPECT_EQ(crc32c("12345", "6789"), 0xe3069283U);
  EXPECT_EQ(crc32c_text("123456789"), "e3069283");
}

TEST(Chunk, EveryNumberTypeComesBack) {
  const Chunk chunk = every_type(70000);  // more than one of HDF5's chunks
  const auto bytes = encode_chunk(chunk);
  ASSERT_TRUE(bytes) << bytes.error().message;
  const auto back = decode_chunk(*bytes);
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_EQ(back->replicate, 7U);
  EXPECT_EQ(back->first_sequence, 12U);
  EXPECT_EQ(back->last_sequence, 99U);
  EXPECT_EQ(back->device.DebugString(), chunk.device.DebugString());
  ASSERT_EQ(back->streams.size(), 2U);
  expect_same(back->streams[0], chunk.streams[0]);
  expect_same(back->streams[1], chunk.streams[1]);
}

// Several recordings of one process make and read chunks at the same time.
TEST(Chunk, ThreadsDoNotMixTheirFiles) {
  std::vector<std::thread> threads;
  for (std::size_t k = 0; k < 4; ++k) {
    threads.emplace_back([k] {
      const Chunk chunk = every_type(1000 + 100 * k);
      for (int turn = 0; turn < 20; ++turn) {
        const auto bytes = encode_chunk(chunk);
        ASSERT_TRUE(bytes) << bytes.error().message;
        const auto back = decode_chunk(*bytes);
        ASSERT_TRUE(back) << back.error().message;
        expect_same(back->streams[0], chunk.streams[0]);
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
}

// A bit in every third byte of a small chunk or so: the number, name or count it belongs to is
// refused, or nothing that is read has changed (unused bytes of the file).
TEST(Chunk, NoFlippedBitPasses) {
  const Chunk chunk = every_type(60);
  const std::string bytes = *encode_chunk(chunk);
  const std::string device = chunk.device.DebugString();
  std::mt19937_64 random(4);
  std::size_t refused = 0;
  std::size_t tried = 0;
  for (std::size_t i = 0; i < bytes.size(); i += 1 + random() % 5) {
    ++tried;
    std::string damaged = bytes;
    damaged[i] = static_cast<char>(damaged[i] ^ (1 << (random() % 8)));
    const auto back = decode_chunk(damaged);
    if (!back) {
      ++refused;
      continue;
    }
    ASSERT_EQ(back->device.DebugString(), device) << "byte " << i;
    ASSERT_EQ(back->first_sequence, chunk.first_sequence) << "byte " << i;
    for (std::size_t s = 0; s < 2; ++s) {
      ASSERT_EQ(back->streams[s].channels, chunk.streams[s].channels) << "byte " << i;
      ASSERT_EQ(back->streams[s].host_time, chunk.streams[s].host_time) << "byte " << i;
      ASSERT_EQ(back->streams[s].counter, chunk.streams[s].counter) << "byte " << i;
      ASSERT_EQ(back->streams[s].flags, chunk.streams[s].flags) << "byte " << i;
      ASSERT_EQ(back->streams[s].refused, chunk.streams[s].refused) << "byte " << i;
    }
  }
  EXPECT_GT(refused, tried / 2);
}

TEST(Chunk, NoTruncationPasses) {
  const std::string bytes = *encode_chunk(every_type(300));
  for (std::size_t size = 0; size < bytes.size(); size += 7) {
    EXPECT_FALSE(decode_chunk(std::string_view(bytes).substr(0, size))) << size;
  }
}

// What Python makes of a chunk; PYTHON is Debian's own interpreter, which has Debian's packages.
class Python : public FileTest {
 protected:
  // Exit status of a script, its complaints in the test's output.
  int run(const std::string& script) const {
    write("script.py", script);
    return std::system(("/usr/bin/python3 '" + path("script.py").string() + "'").c_str());
  }
  std::string chunk_file() const { return write("c.h5", *encode_chunk(every_type(300))).string(); }
};

TEST_F(Python, H5pySeesCountsUnitsAndScale) {
  if (run("import h5py") != 0) GTEST_SKIP() << "NOT TESTED: python3-h5py is absent";
  EXPECT_EQ(run("import h5py\n"
                "f = h5py.File('" +
                chunk_file() +
                "')\n"
                "assert f.attrs['device'] == b'imu0' or f.attrs['device'] == 'imu0'\n"
                "assert int(f.attrs['first_sequence']) == 12\n"
                "assert f['all'].attrs['rate_hz'] == 819.2\n"
                "assert f['all'].attrs['received'] == 307\n"
                "assert f['all'].attrs['refused.checksum'] == 4\n"
                "a = f['all/a']\n"
                "assert a.dtype == 'int16' and a.shape == (300,)\n"
                "assert list(a[:4]) == [-32768, 32767, 0, -1]\n"
                "assert a.attrs['scale_factor'] == 0.05 and a.attrs['add_offset'] == -3.25\n"
                "assert a.attrs['units'] in ('deg/s', b'deg/s')\n"
                "assert a.attrs['refused.out_of_range'] == 3\n"
                "assert a.shuffle and a.fletcher32 and a.compression_opts == 1\n"),
            0);
}

TEST_F(Python, XarrayScales) {
  if (run("import xarray, h5netcdf") != 0) {
    GTEST_SKIP() << "NOT TESTED: python3-xarray or python3-h5netcdf is absent";
  }
  EXPECT_EQ(run("import xarray, numpy\n"
                "d = xarray.open_dataset('" +
                chunk_file() +
                "', group='all', engine='h5netcdf',\n"
                "    phony_dims='sort', mask_and_scale=True, decode_times=False)\n"
                "a = d['a'].values\n"
                "assert numpy.allclose(a[:4], [-32768*0.05-3.25, 32767*0.05-3.25, -3.25, -3.30])\n"
                "assert d['a'].attrs['units'] == 'deg/s'\n"
                "assert d['z_i8'].dtype == 'int64' and d['host_time'].dtype == 'int64'\n"),
            0);
}

}  // namespace
}  // namespace imunoise::recording
