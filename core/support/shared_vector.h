#pragma once

#include <Eigen/Core>
#include <memory>
#include <utility>

namespace imunoise {

/// Numbers with many holders and no writer: a vector's, or those of a file that is mapped into
/// memory. Copies share them. Reads as any vector does; but `const Eigen::VectorXd& x = shared`
/// makes a copy of them all: take `const SharedVector&` or `const VectorRef&`.
class SharedVector : public Eigen::Map<const Eigen::VectorXd> {
 public:
  using Numbers = Eigen::Map<const Eigen::VectorXd>;

  SharedVector() : Numbers(nullptr, 0) {}
  /// `owner` keeps the numbers where they are.
  SharedVector(std::shared_ptr<const void> owner, const double* data, Eigen::Index size)
      : Numbers(data, size), owner_(std::move(owner)) {}
  SharedVector(Eigen::VectorXd numbers)  // NOLINT(google-explicit-constructor): shares a vector
      : SharedVector(std::make_shared<const Eigen::VectorXd>(std::move(numbers))) {}
  SharedVector(const SharedVector&) = default;
  ~SharedVector() = default;
  SharedVector& operator=(const SharedVector& other) {
    if (this == &other) return *this;
    owner_ = other.owner_;
    // As Eigen says that a Map is made one of other numbers.
    new (static_cast<Numbers*>(this)) Numbers(other.data(), other.size());
    return *this;
  }

 private:
  explicit SharedVector(const std::shared_ptr<const Eigen::VectorXd>& numbers)
      : SharedVector(numbers, numbers->data(), numbers->size()) {}

  std::shared_ptr<const void> owner_;
};

}  // namespace imunoise
