// What costs much and not every run needs.
#pragma once

#include <functional>
#include <optional>
#include <utility>

namespace mortise {

/// A value that is made when it is first asked for.
template <class T>
class Lazy {
 public:
  /// `make` is called once, or again if it threw.
  explicit Lazy(std::function<T()> make) : make_(std::move(make)) {}
  Lazy(const Lazy&) = delete;
  Lazy& operator=(const Lazy&) = delete;

  /// Collective if `make` is.
  T& get() const
  {
    if (!value_) value_.emplace(make_());
    return *value_;
  }

 private:
  std::function<T()> make_;
  mutable std::optional<T> value_;
};

}  // namespace mortise
