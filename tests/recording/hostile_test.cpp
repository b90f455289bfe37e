// Files whose headers claim what is not there: each is refused, or read as far as it goes, in
// little memory. Truncations at every byte of small files.

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <string>
#include <vector>

#include "tests/recording/files.h"

namespace imunoise::recording {
namespace {

template <class Number>
std::string raw(Number value) {
  return bytes_of(std::vector<Number>{value});
}
std::string counted(const std::string& text) {
  return raw(static_cast<std::uint32_t>(text.size())) + text;
}

// MCAP: a record of any claimed length.
std::string mcap_record(char code, const std::string& content, std::uint64_t claimed) {
  return std::string(1, code) + raw(claimed) + content;
}
std::string mcap_record(char code, const std::string& content) {
  return mcap_record(code, content, content.size());
}
std::string mcap_start() {
  return "\x89MCAP0\r\n" +
         mcap_record(3, raw<std::uint16_t>(1) + counted("sensor_msgs/msg/Imu") + counted("") +
                            counted("")) +
         mcap_record(4, raw<std::uint16_t>(1) + raw<std::uint16_t>(1) + counted("/imu") +
                            counted("cdr") + counted(""));
}
std::string mcap_chunk(const std::string& packing, std::uint64_t unpacked,
                       const std::string& bytes) {
  return raw<std::uint64_t>(0) + raw<std::uint64_t>(0) + raw(unpacked) + raw<std::uint32_t>(0) +
         counted(packing) + raw<std::uint64_t>(bytes.size()) + bytes;
}
// Message i of 100 Hz: a rate of i mod 7 about x.
std::string mcap_message(int i) {
  std::string data("\0\1\0\0", 4);
  data += raw<std::int32_t>(1'700'000'000 + i / 100) +
          raw<std::uint32_t>(static_cast<std::uint32_t>(i % 100) * 10'000'000U) +
          counted(std::string("imu\0", 4));
  std::vector<double> numbers(37, 0.0);
  numbers[13] = i % 7;
  return mcap_record(5, raw<std::uint16_t>(1) + raw<std::uint32_t>(0) + raw<std::uint64_t>(0) +
                            raw<std::uint64_t>(0) + data + bytes_of(numbers));
}

// ROS 1: a record of header fields and data, of any claimed length.
std::string bag_record(const std::vector<std::string>& fields, const std::string& data,
                       std::uint32_t claimed) {
  std::string header;
  for (const std::string& one : fields) header += counted(one);
  return counted(header) + raw(claimed) + data;
}

std::string matlab_head() {
  std::string out(124, ' ');
  out.replace(0, 19, "MATLAB 5.0 MAT-file");
  return out + std::string("\0\1IM", 4);
}
// A matrix of doubles that claims rows x columns and so many bytes.
std::string matlab_matrix(std::uint32_t bytes, std::int32_t rows, std::int32_t columns) {
  return raw<std::uint32_t>(14) + raw(bytes) + raw<std::uint32_t>(6) + raw<std::uint32_t>(8) +
         raw<std::uint64_t>(6) + raw<std::uint32_t>(5) + raw<std::uint32_t>(8) + raw(rows) +
         raw(columns) + raw<std::uint32_t>(1) + raw<std::uint32_t>(8) + "gyro\0\0\0\0" +
         raw<std::uint32_t>(9) + raw<std::uint32_t>(bytes - 64U) + std::string(64, '\1');
}

std::string zip_of(const std::string& name, const std::string& content, std::uint32_t claimed) {
  const auto names = static_cast<std::uint16_t>(name.size());
  const std::string local = raw<std::uint32_t>(0x04034b50) + std::string(14, '\0') + raw(claimed) +
                            raw(claimed) + raw(names) + raw<std::uint16_t>(0) + name + content;
  const std::string member = raw<std::uint32_t>(0x02014b50) + std::string(16, '\0') + raw(claimed) +
                             raw(claimed) + raw(names) + std::string(12, '\0') +
                             raw<std::uint32_t>(0) + name;
  return local + member + raw<std::uint32_t>(0x06054b50) + std::string(8, '\0') +
         raw(static_cast<std::uint32_t>(member.size())) +
         raw(static_cast<std::uint32_t>(local.size())) + std::string(2, '\0');
}

std::string ulog_record(char kind, const std::string& content, std::uint16_t claimed) {
  return raw(claimed) + std::string(1, kind) + content;
}
std::string ulog_start() { return std::string("ULog\x01\x12\x35\x01", 8) + std::string(8, '\0'); }
std::string ulog_format(const std::string& text) {
  return ulog_record('F', text, static_cast<std::uint16_t>(text.size()));
}

struct Hostile {
  std::string what;
  std::string name;
  std::string bytes;
};

std::vector<Hostile> hostile_files() {
  const std::string few(64, '\0');
  std::string sqlite = "SQLite format 3";
  sqlite.resize(100, '\0');
  sqlite[17] = 1;                                // pages of 65536 bytes
  sqlite.replace(28, 4, "\x7f\xff\xff\xff", 4);  // 2³¹ of them
  std::string nested;
  for (int i = 0; i < 60; ++i)
    nested += ulog_format("f" + std::to_string(i) + ":f" + std::to_string(i + 1) + "[60000] x;");
  return {
      {"rows", "a.npy",
       npy("{'descr': '<f8', 'fortran_order': False, 'shape': (1099511627776, 6)}", few)},
      {"rows times columns", "b.npy",
       npy("{'descr': '<f8', 'fortran_order': False, 'shape': (9223372036854775807, "
           "9223372036854775807)}",
           few)},
      {"a member of 4 GB", "a.npz",
       zip_of("gyro.npy",
              npy("{'descr': '<f8', 'fortran_order': False, 'shape': (500000000, 3)}", few),
              0xfffffff0U)},
      {"a member of little, an array of much", "b.npz",
       zip_of("gyro.npy",
              npy("{'descr': '<f8', 'fortran_order': False, 'shape': (500000000, 3)}", few), 200)},
      {"a matrix", "a.mat", matlab_head() + matlab_matrix(0xfffffff0U, 2147483647, 3)},
      {"dimensions", "b.mat", matlab_head() + matlab_matrix(128, 2147483647, 2147483647)},
      {"negative dimensions", "c.mat", matlab_head() + matlab_matrix(128, -2147483647, 3)},
      {"packed bytes", "d.mat",
       matlab_head() + raw<std::uint32_t>(15) + raw<std::uint32_t>(0xfffffff0U) + few},
      {"a record", "a.mcap", mcap_start() + mcap_record(5, few, std::uint64_t{1} << 62U)},
      {"a chunk", "b.mcap",
       mcap_start() + mcap_record(6, mcap_chunk("zstd", std::uint64_t{1} << 60U, few))},
      {"a chunk below the limit", "c.mcap",
       mcap_start() + mcap_record(6, mcap_chunk("lz4", std::uint64_t{255} << 20U, few))},
      {"a text", "d.mcap",
       "\x89MCAP0\r\n" + mcap_record(3, raw<std::uint16_t>(1) + raw<std::uint32_t>(0xffffffffU))},
      {"a header", "a.bag", "#ROSBAG V2.0\n" + raw<std::uint32_t>(0xfffffff0U) + few},
      {"data", "b.bag", "#ROSBAG V2.0\n" + bag_record({"op=\x02"}, few, 0xfffffff0U)},
      {"a chunk", "c.bag",
       "#ROSBAG V2.0\n" + bag_record({"op=\x05", "compression=lz4", "size=\xff\xff\xff\x0f"}, few,
                                     static_cast<std::uint32_t>(few.size()))},
      {"pages", "a.db3", sqlite},
      {"an array of a format", "a.ulg",
       ulog_start() + ulog_format("sensor_gyro:uint64_t timestamp;float[4000000000] x;") +
           ulog_record('A', std::string(3, '\0') + "sensor_gyro", 14)},
      {"formats within formats", "b.ulg", ulog_start() + nested},
      {"a message", "c.ulg", ulog_start() + ulog_record('D', few, 65535)},
      {"a line without an end", "a.csv", "t,x\n" + std::string(std::size_t{8} << 20U, '1')},
      {"columns", "b.csv",
       [] {
         std::string out;
         for (int i = 0; i < 400'000; ++i) out += i == 0 ? "x" : ",x";
         return out + "\n";
       }()},
      {"columns between blanks", "c.csv",
       [] {
         std::string out;
         for (int i = 0; i < 400'000; ++i) out += "1 ";
         return out + "\n";
       }()},
      {"a line of a bus", "a.log",
       "(1700000000.000000) can0 123#" + std::string(std::size_t{4} << 20U, 'F')},
      {"an Xsens message", "a.bin", "\xfa\xff\x36\xff\xff\xff" + few},
      {"zstd", "a.csv.zst",
       std::string("\x28\xb5\x2f\xfd\xe0", 5) + raw(std::uint64_t{1} << 60U) + few},
  };
}

std::size_t kilobytes_of(const std::string& key) {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    if (line.starts_with(key + ":")) return std::stoul(line.substr(key.size() + 1));
  }
  return 0;
}

// Reads the file in a process that may reserve 1 GiB more. Returns the message, or "" where it was
// read, and how much more of the memory was used at most (bytes).
struct Read {
  std::string message;
  std::size_t memory = 0;
  bool ended = false;
};
Read read_apart(const std::filesystem::path& file) {
  std::array<int, 2> ends{};
  if (pipe(ends.data()) != 0) return {};
  const pid_t child = fork();
  if (child == 0) {
    std::ofstream("/proc/self/clear_refs") << "5";
    const std::size_t before = kilobytes_of("VmRSS");
    const rlim_t most = kilobytes_of("VmSize") * 1024 + (std::size_t{1} << 30U);
    const rlimit limit{most, most};
    setrlimit(RLIMIT_AS, &limit);
    const auto got = import_one(file, at_rate(100));
    const std::size_t more = kilobytes_of("VmHWM") - before;
    const std::string said = std::to_string(more) + "\n" + (got ? "" : got.error().message);
    const bool told = ::write(ends[1], said.data(), said.size()) > 0;
    _exit(told ? 0 : 1);
  }
  close(ends[1]);
  std::string said;
  std::array<char, 4096> buffer{};
  for (ssize_t n = 0; (n = ::read(ends[0], buffer.data(), buffer.size())) > 0;)
    said.append(buffer.data(), static_cast<std::size_t>(n));
  close(ends[0]);
  int status = -1;
  waitpid(child, &status, 0);
  Read out;
  out.ended = WIFEXITED(status) && WEXITSTATUS(status) == 0 && !said.empty();
  if (!out.ended) return out;
  out.memory = std::stoul(said) * 1024;
  out.message = said.substr(said.find('\n') + 1);
  return out;
}

class HostileFiles : public FileTest {};

TEST_F(HostileFiles, TakeLittleMemory) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "the sanitizer needs the address space";
#endif
  constexpr std::size_t kWork = std::size_t{24} << 20U;  // blocks, tables and libraries
  for (const Hostile& one : hostile_files()) {
    const auto file = write(one.name, one.bytes);
    const Read got = read_apart(file);
    ASSERT_TRUE(got.ended) << one.name << ", " << one.what;
    EXPECT_LE(got.memory, 2 * one.bytes.size() + kWork) << one.name << ", " << one.what;
    EXPECT_NE(got.message.find(one.name), std::string::npos)
        << one.name << ", " << one.what << ": " << got.message;
    EXPECT_EQ(got.message.find("std::"), std::string::npos)
        << one.name << ", " << one.what << ": " << got.message;
  }
}

// Reads beginnings of a file, `step` bytes apart. Each gives an error that names the file, or
// finite numbers. A longer beginning gives no fewer numbers, except for a last record that is cut.
void expect_every_beginning(const std::filesystem::path& file, const std::string& bytes,
                            const ImportOptions& options, std::size_t whole, std::size_t step = 1) {
  std::size_t before = 0;
  for (std::size_t left = bytes.size() / step + 1; left-- > 0;) {
    const std::size_t length = bytes.size() - left * step;
    std::ofstream(file, std::ios::binary) << bytes.substr(0, length);
    const auto got = import_one(file, options);
    if (!got) {
      ASSERT_NE(got.error().message.find(file.string()), std::string::npos) << got.error().message;
      ASSERT_LE(before, kMinimumSamples) << length << ": " << got.error().message;
      continue;
    }
    const Channel& channel = got->front().channels.front();
    ASSERT_GE(channel.count + 1, before) << length;
    before = channel.count;
    for (std::size_t i = 0; i < channel.count; ++i)
      ASSERT_TRUE(std::isfinite(channel.signal().value(i))) << length;
  }
  EXPECT_EQ(before, whole);
}

TEST_F(HostileFiles, CutAtEveryByte) {
  std::string text = "t,gyro_x [deg/s]\n";
  for (int i = 0; i < 40; ++i) text += std::to_string(10 * i) + "," + std::to_string(i % 7) + "\n";
  ImportOptions none;
  expect_every_beginning(path("a.csv"), text, none, 40);

  const std::string numbers = bytes_of(std::vector<double>(20, 1.5));
  const std::string array =
      npy("{'descr': '<f8', 'fortran_order': False, 'shape': (20,)}", numbers);
  expect_every_beginning(path("a.npy"), array, at_rate(100), 20, 3);
  expect_every_beginning(path("a.npz"),
                         zip_of("gyro.npy", array, static_cast<std::uint32_t>(array.size())),
                         at_rate(100), 20, 5);

  std::string bag = mcap_start();
  std::string chunk;
  for (int i = 0; i < 20; ++i) (i < 10 ? bag : chunk) += mcap_message(i);
  bag += mcap_record(6, mcap_chunk("", chunk.size(), chunk));
  expect_every_beginning(path("a.mcap"), bag, none, 20, 13);

  std::string log;
  for (int i = 0; i < 20; ++i)
    log += "(1700000000." + std::to_string(100000 + 10000 * i) + ") can0 023" +
           std::string(i % 2 == 0 ? "#0102030405060708\n" : "#0203040506070809\n");
  ImportOptions bus;
  bus.dbc = write("imu.dbc",
                  "VERSION \"\"\n\nBU_: A\n\nBO_ 35 IMU: 8 A\n"
                  " SG_ GyroX : 0|16@1- (0.001,0) [-32|32] \"deg/s\" A\n")
                .string();
  expect_every_beginning(path("a.log"), log, bus, 20, 3);
}

}  // namespace
}  // namespace imunoise::recording
