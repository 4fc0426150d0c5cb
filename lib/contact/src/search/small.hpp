// A vector with room for a few entries, which it holds in itself: the search makes millions of them.
#pragma once

#include <array>
#include <cstddef>
#include <initializer_list>
#include <span>

namespace mortise::contact {

template <class T, std::size_t most>
class Few {
 public:
  Few() = default;
  Few(std::initializer_list<T> values)
  {
    for (const auto& value : values) push_back(value);
  }
  /// At most `most` entries; more are a mistake of the caller's, as with an array.
  void push_back(const T& value) { values_[size_++] = value; }
  void clear() { size_ = 0; }
  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  T& operator[](std::size_t i) { return values_[i]; }
  const T& operator[](std::size_t i) const { return values_[i]; }
  T* begin() { return values_.data(); }
  T* end() { return values_.data() + size_; }
  const T* begin() const { return values_.data(); }
  const T* end() const { return values_.data() + size_; }
  operator std::span<const T>() const { return {values_.data(), size_}; }

 private:
  std::array<T, most> values_;
  std::size_t size_ = 0;
};

}  // namespace mortise::contact
