// The driver "text" through its plugin: commands, serial ports, TCP, pipes, and what goes wrong.

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/stat.h>

#include <atomic>
#include <csignal>
#include <fstream>
#include <thread>

#include "drivers/emulator/lines/pty.h"
#include "tests/drivers/recording_session.h"
#include "tests/study/simulated_recording.h"

namespace imunoise::text {
namespace {

using namespace std::chrono_literals;
using testing::ReadRow;
using testing::RecordingSession;
using testing::TemporaryFolder;
using Options = std::vector<drivers::OptionText>;

Result<std::unique_ptr<RecordingSession>> open(const Options& options, bool with_wire = false) {
  return RecordingSession::open(IMUNOISE_DRIVER_FOLDER, "text", options, with_wire);
}

std::string refusal(const Options& options) {
  const auto session = open(options);
  return session ? "" : session.error().message;
}

// Rows "i,x" with x = i / 4, the first at 0, at 200 Hz of the device's clock.
std::string rows(int first, int last) {
  std::string out;
  for (int i = first; i < last; ++i) out += fmt::format("{},{},{}\n", 5 * i, i, 0.25 * i);
  return out;
}

TEST(TextDriver, RecordsWhatACommandPrintsToItsEnd) {
  const TemporaryFolder folder;
  std::ofstream(folder.path() / "rows.csv") << "time[ms],counter,x[deg/s]\n" << rows(0, 300);
  const auto session =
      open({{"command", "cat '" + (folder.path() / "rows.csv").string() + "'"}}, true);
  ASSERT_TRUE(session) << session.error().message;
  const drivers::Stream& stream = (*session)->info().streams.at(0);
  EXPECT_EQ(stream.nominal_rate_hz, 200.0);
  EXPECT_EQ(stream.channels.at(0).units, "deg/s");
  EXPECT_EQ(stream.counter_maximum, 4294967295U);
  ASSERT_TRUE((*session)->read_rows(300)) << (*session)->failure();
  for (std::size_t i = 0; i < 300; ++i) {
    const ReadRow& row = (*session)->rows()[i];
    ASSERT_EQ(row.counter, i);
    ASSERT_EQ(row.device_time_ns, 5'000'000 * static_cast<std::int64_t>(i));
    ASSERT_EQ(row.numbers[0], 0.25 * static_cast<double>(i));
    ASSERT_EQ(row.flags, i == 0 ? std::uint32_t{IMUNOISE_SAMPLE_AFTER_RESTART} : 0U);
    if (i > 0) {
      ASSERT_GE(row.host_time_ns, (*session)->rows()[i - 1].host_time_ns);
    }
  }
  drivers::SampleBlock block = (*session)->device().make_block(10);
  EXPECT_EQ((*session)->device().read(100ms, block), drivers::ReadOutcome::kEnd);
  EXPECT_EQ((*session)->wire(), "time[ms],counter,x[deg/s]\n" + rows(0, 300));
}

// Every second row is missing while it listens: the counter shows it.
TEST(TextDriver, MissingRowsLeaveTheRateAsItIs) {
  const TemporaryFolder folder;
  std::ofstream file(folder.path() / "rows.csv");
  file << "time[ms],counter,x[deg/s]\n";
  for (int i = 0; i < 300; i += 2) file << rows(i, i + 1);
  file.close();
  const auto session = open({{"command", "cat '" + (folder.path() / "rows.csv").string() + "'"}});
  ASSERT_TRUE(session) << session.error().message;
  EXPECT_EQ((*session)->info().streams.at(0).nominal_rate_hz, 200.0);
}

TEST(TextDriver, SaysWhatKeepsItFromReading) {
  const auto expect = [](const Options& options, const std::string& words) {
    EXPECT_NE(refusal(options).find(words), std::string::npos) << refusal(options);
  };
  expect({}, "name one source");
  expect({{"command", "true"}, {"pipe", "/dev/null"}}, "name one source");
  expect({{"command", "echo broken wire >&2; exit 3"}}, "status 3: broken wire");
  expect({{"command", "kill -9 $$"}}, "signal 9");
  expect({{"command", "sleep 60"}, {"listen", "0.1"}}, "nothing came in 0.1 s");
  expect({{"command", "echo 1,2"}}, "the first line is '1,2'");
  expect({{"command", "echo 1,2"}, {"columns", "x,y,z"}}, "no row of 3 columns");
  expect({{"command", "echo 1,2"}, {"columns", "x,y"}}, "give it (rate=100)");
  expect({{"command", "yes '# remark' | head"}}, "none is a row");
  expect({{"pipe", "/nonsuch"}}, "No such file");
  expect({{"tcp", "localhost"}}, "HOST:PORT");
  expect({{"tcp", "localhost:1"}}, "refused");
}

TEST(TextDriver, CountsWhatItCannotDeliver) {
  const auto session = open({{"command", "echo 1,2; echo 1; echo 1,z; echo nan,1; echo 3,4"},
                             {"columns", "x,y"},
                             {"rate", "100"},
                             {"listen", "0.5"}});
  ASSERT_TRUE(session) << session.error().message;
  ASSERT_TRUE((*session)->read_rows(2)) << (*session)->failure();
  EXPECT_EQ((*session)->rows()[1].numbers, (std::vector<double>{3.0, 4.0}));
  EXPECT_EQ((*session)->refused(IMUNOISE_REFUSED_MALFORMED), 2U);
  EXPECT_EQ((*session)->refused(IMUNOISE_REFUSED_FAULT), 1U);
}

TEST(TextDriver, ACommandThatFailsIsStartedAgain) {
  const TemporaryFolder folder;
  const std::string mark = (folder.path() / "mark").string();
  const std::string command = fmt::format(
      "if [ -e '{0}' ]; then echo 7,8; sleep 60; else touch '{0}'; for i in 1 2 3 4 5; "
      "do echo $i,0; done; sleep 0.5; exit 1; fi",
      mark);
  const auto session =
      open({{"command", command}, {"columns", "x,y"}, {"rate", "10"}, {"listen", "0.2"}});
  ASSERT_TRUE(session) << session.error().message;
  ASSERT_TRUE((*session)->read_rows(6)) << (*session)->failure();
  ASSERT_EQ((*session)->disconnections().size(), 1U);
  EXPECT_NE((*session)->disconnections()[0].find("status 1"), std::string::npos);
  EXPECT_EQ((*session)->rows()[5].numbers[0], 7.0);
  EXPECT_EQ((*session)->rows()[5].flags, std::uint32_t{IMUNOISE_SAMPLE_AFTER_RESTART});
}

TEST(TextDriver, EndsItsCommandWithTheRecording) {
  const TemporaryFolder folder;
  const std::string file = (folder.path() / "pid").string();
  {
    const auto session = open({{"command", fmt::format("echo $$ > '{}'; echo 1; sleep 60", file)},
                               {"columns", "x"},
                               {"rate", "10"},
                               {"listen", "0.3"}});
    ASSERT_TRUE(session) << session.error().message;
  }
  int child = 0;
  std::ifstream(file) >> child;
  ASSERT_GT(child, 1);
  EXPECT_NE(::kill(child, 0), 0);
}

// Sends rows for as long as it lives.
class Sender {
 public:
  explicit Sender(std::function<void(const std::string&)> send)
      : thread_([this, send = std::move(send)] {
          for (int i = 0; !over_; ++i) {
            send(rows(i, i + 1));
            std::this_thread::sleep_for(5ms);
          }
        }) {}
  ~Sender() {
    over_ = true;
    thread_.join();
  }

 private:
  std::atomic<bool> over_ = false;
  std::thread thread_;
};

const Options kThree = {{"columns", "time[ms],counter,x"}, {"listen", "0.5"}};

Options with(Options options, const std::string& name, const std::string& value) {
  options.push_back({name, value});
  return options;
}

void expect_rows_without_gaps(RecordingSession& session, std::size_t count) {
  ASSERT_TRUE(session.read_rows(count)) << session.failure();
  const auto& all = session.rows();
  for (std::size_t i = 1; i < count; ++i) {
    ASSERT_EQ(all[i].counter, all[i - 1].counter + 1) << i;
    ASSERT_EQ(all[i].numbers[0], 0.25 * static_cast<double>(all[i].counter));
  }
  EXPECT_EQ(session.all_refused(), 0U);
}

TEST(TextDriver, ReadsASerialPortFromTheNextWholeLine) {
  const TemporaryFolder folder;
  const std::string link = (folder.path() / "line").string();
  std::optional<emulator::Pty> line(std::in_place, link);
  const auto send = [&line](const std::string& text) {
    line->write({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  };
  send("5,1,7\n");  // the end of "25,1,7", which looks like a line
  std::optional<Sender> sender(std::in_place, send);
  const auto session = open(with(with(kThree, "port", "pty:" + link), "rate", "200"));
  ASSERT_TRUE(session) << session.error().message;
  expect_rows_without_gaps(**session, 50);
  EXPECT_EQ(line->host_baud(), 115200U);

  sender.reset();
  line.reset();  // unplugged
  ASSERT_TRUE((*session)->read_until([&] { return !(*session)->disconnections().empty(); }));
  const std::size_t before = (*session)->rows().size();
  line.emplace(link);
  sender.emplace(send);
  ASSERT_TRUE((*session)->read_rows(before + 20)) << (*session)->failure();
  EXPECT_EQ((*session)->rows()[before].flags, std::uint32_t{IMUNOISE_SAMPLE_AFTER_RESTART});
}

TEST(TextDriver, ReadsAPipeAndWaitsForSilenceToEnd) {
  const TemporaryFolder folder;
  const std::string path = (folder.path() / "pipe").string();
  ASSERT_EQ(::mkfifo(path.c_str(), 0600), 0);
  std::optional<Sender> sender(
      std::in_place, [out = std::make_shared<std::fstream>(path)](const std::string& text) {
        *out << text << std::flush;
      });
  const auto session = open(with(kThree, "pipe", path));
  ASSERT_TRUE(session) << session.error().message;
  expect_rows_without_gaps(**session, 50);
  sender.reset();
  ASSERT_TRUE((*session)->read_until([&] { return !(*session)->disconnections().empty(); }));
  EXPECT_NE((*session)->disconnections()[0].find("sends no more"), std::string::npos);
}

TEST(TextDriver, ReadsATcpPort) {
  const int server = ::socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  auto* const any = reinterpret_cast<sockaddr*>(&address);
  socklen_t size = sizeof address;
  ASSERT_EQ(::bind(server, any, size), 0);
  ASSERT_EQ(::listen(server, 1), 0);
  ASSERT_EQ(::getsockname(server, any, &size), 0);
  std::thread accepting([server] {
    for (int k = 0; k < 2; ++k) {
      const int client = ::accept(server, nullptr, nullptr);
      const std::string all = "0,0,0\n" + rows(0, 200);
      (void)::send(client, all.data(), all.size(), MSG_NOSIGNAL);
      std::this_thread::sleep_for(1s);
      ::close(client);
    }
  });
  const auto session =
      open(with(kThree, "tcp", fmt::format("127.0.0.1:{}", ntohs(address.sin_port))));
  ASSERT_TRUE(session) << session.error().message;
  EXPECT_EQ((*session)->info().streams[0].nominal_rate_hz, 200.0);
  expect_rows_without_gaps(**session, 200);
  ASSERT_TRUE((*session)->read_rows(400)) << (*session)->failure();  // the connection is made again
  EXPECT_EQ((*session)->rows()[200].counter, 0U);
  accepting.join();
  ::close(server);
}

}  // namespace
}  // namespace imunoise::text
