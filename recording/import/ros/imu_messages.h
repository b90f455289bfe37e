#pragma once

// Messages of type sensor_msgs/Imu, as all bags hold them: decoded, then collected into a table.

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/support/result.h"
#include "recording/import/table/blocks.h"
#include "recording/import/table/options.h"
#include "recording/import/table/streams.h"
#include "recording/import/table/table.h"
#include "recording/import/table/times.h"

namespace imunoise::recording {

/// What is used of one message. SI units.
struct ImuMessage {
  std::int64_t stamp = 0;          ///< of the header, ns since 1970
  std::array<double, 6> values{};  ///< gyro_x, gyro_y, gyro_z (rad/s), acc_x, acc_y, acc_z (m/s²)
  bool has_gyro = true;            ///< false: its covariance begins with -1
  bool has_acc = true;
};

/// How the bytes of a message are laid out.
enum class Encoding { kRos1, kCdr };

/// Whether a type of messages is that of an IMU, as ROS 1 ("sensor_msgs/Imu") or ROS 2 names it.
bool is_imu_type(std::string_view type);

/// Decodes one message; nothing where the bytes are not one. CDR: plain, of either byte order.
std::optional<ImuMessage> decode_imu(Encoding encoding, std::string_view bytes);

/// Collects the messages of the wanted topic: that which `options` name, else the only one of an
/// IMU. Two topics of which one holds rates and the other accelerations are one IMU
/// (join_streams()).
class ImuCollector {
 public:
  ImuCollector(std::string file, const ImportOptions& options);

  /// A topic that the bag announces; `number` is what its messages call it. Both may come again.
  void topic(std::uint64_t number, std::string_view name, std::string_view type);
  /// Whether messages of this number are wanted.
  bool wants(std::uint64_t number) const;
  /// One message that is wanted. `received` (ns) is its time where all headers leave theirs 0.
  /// Bytes that are no message are left out and counted.
  void add(std::uint64_t number, Encoding encoding, std::string_view bytes, std::int64_t received);
  /// The wanted channels; `truncated`: the bag has no end. Error: no topic of an IMU, several and
  /// none chosen (all are listed), no message; see import_files.
  Result<Table> finish(bool truncated = false);

 private:
  struct Topic {
    std::string name;
    std::string type;
  };
  // Messages of the topics of one name.
  struct Source {
    std::size_t messages = 0;
    bool header_time = true;
    ImuMessage first{};
    bool has_gyro = false;  // a rate that is not 0
    bool has_acc = false;
    Times times;                           // ns
    std::array<Blocks<double>, 6> values;  // from the first on that is not 0
  };
  Result<void> check_topics() const;
  bool is_one_imu() const;
  TimedStream stream_of(const std::string& name, Source& source) const;

  std::string file_;
  const ImportOptions& options_;
  std::array<bool, 6> kept_;  // channels whose numbers are kept
  std::map<std::uint64_t, Topic> topics_;
  std::map<std::string, Source, std::less<>> sources_;  // by the topic's name
  bool ambiguous_ = false;
  std::size_t unreadable_ = 0;
  std::string first_unreadable_;
};

}  // namespace imunoise::recording
