#include <fmt/format.h>

#include <bit>

#include "study/export/whole/matrices.h"
#include "study/export/whole/zip_archive.h"

namespace imunoise::study::consumers {
namespace {

static_assert(std::endian::native == std::endian::little, "numbers are written as they lie");

// The .npy format, version 1.0: the head fills 64 bytes or a multiple of these.
std::string npy(std::string_view type, const std::string& shape, const std::string& numbers) {
  std::string head =
      fmt::format("{{'descr': '{}', 'fortran_order': True, 'shape': {}, }}", type, shape);
  constexpr std::size_t kBefore = 10;
  head.append(63 - (kBefore + head.size()) % 64, ' ');
  head += '\n';
  std::string out("\x93NUMPY\x01\x00", 8);
  out += static_cast<char>(head.size() % 256);
  out += static_cast<char>(head.size() / 256);
  return out + head + numbers;
}

std::string matrix_npy(const Eigen::MatrixXd& matrix) {
  const std::string numbers(reinterpret_cast<const char*>(matrix.data()),
                            static_cast<std::size_t>(matrix.size()) * sizeof(double));
  return npy("<f8", fmt::format("({}, {})", matrix.rows(), matrix.cols()), numbers);
}

// Bytes of UTF-8, padded to the longest.
std::string text_npy(const std::vector<std::string>& texts) {
  std::size_t longest = 1;
  for (const std::string& one : texts) longest = std::max(longest, one.size());
  std::string bytes;
  for (std::string one : texts) {
    one.resize(longest, '\0');
    bytes += one;
  }
  return npy(fmt::format("|S{}", longest), fmt::format("({},)", texts.size()), bytes);
}

std::string kf_numpy_file(const Sheet& sheet) {
  std::vector<ArchiveMember> members = {{"comment.npy", text_npy(sheet.heading)}};
  for (const StateSpace& one : sheet.systems) {
    const std::string name = identifier(system_name(one));
    members.push_back({name + ".dt.npy", matrix_npy(Eigen::MatrixXd::Constant(1, 1, one.dt))});
    members.push_back({name + ".outputs.npy", text_npy(one.outputs)});
    members.push_back({name + ".states.npy", text_npy(one.states)});
    for (const NamedMatrix& matrix : matrices_of(one))
      members.push_back({fmt::format("{}.{}.npy", name, matrix.name), matrix_npy(*matrix.matrix)});
  }
  return zip_archive(members);
}

}  // namespace

const Consumer& kf_numpy() {
  static const Consumer kConsumer{
      .name = "kf-numpy",
      .title = "NumPy (Kalman filter)",
      .file = "kf.npz",
      .holds = kStatesHeld,
      .holding = Holding::kStates,
      .axes = AxisRule::kEach,
      .write = kf_numpy_file,
  };
  return kConsumer;
}

}  // namespace imunoise::study::consumers
