// Thousands of damaged files, two minutes: 2 % of them make HDF5 compute without an end.

#include <sys/resource.h>

#include <iostream>
#include <map>

#include "tests/recording/files.h"
#include "tests/recording/hdf5_mutants.h"

namespace imunoise::recording {
namespace {

class Hdf5MutantsTrial : public FileTest {};

TEST_F(Hdf5MutantsTrial, TwoThousandMutants) {
  std::map<std::string, std::size_t> said;
  for (const Hdf5Bounds bounds : {Hdf5Bounds::kEarliest, Hdf5Bounds::kV110}) {
    const std::string good = hdf5_like_h5py(path("good.h5"), bounds);
    for (std::uint32_t seed = 0; seed < 1000; ++seed) {
      const std::string message = error_of(write("mutant.h5", mutant(good, seed)));
      const std::size_t cause = message.find("HDF5 cannot read it (");
      ++said[cause == std::string::npos ? message == "no error" ? "read" : "refused"
                                        : message.substr(cause, message.find(')') - cause + 1)];
    }
  }
  rusage children = {};
  ::getrusage(RUSAGE_CHILDREN, &children);
  for (const auto& [what, count] : said) std::cout << what << ": " << count << "\n";
  std::cout << "largest child: " << children.ru_maxrss / 1024 << " MiB\n";
  EXPECT_LT(children.ru_maxrss, 600 * 1024) << "KiB";
}

}  // namespace
}  // namespace imunoise::recording
