#include "base/packed.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <stdexcept>

namespace mortise {

namespace {

// Before a list of whole numbers.
struct PackedHead {
  std::uint64_t count;
  Global least;
};

// Calls use(a number of the type that takes so many bytes).
template <class Use>
void with_width(int width, const Use& use)
{
  if (width == 1) use(std::uint8_t());
  if (width == 2) use(std::uint16_t());
  if (width == 4) use(std::uint32_t());
  if (width == 8) use(std::uint64_t());
}

int width_of(std::uint64_t largest)
{
  if (largest == 0) return 0;
  return largest < (1ULL << 8) ? 1 : largest < (1ULL << 16) ? 2 : largest < (1ULL << 32) ? 4 : 8;
}

}  // namespace

void PackedWriter::append(const void* data, std::size_t bytes)
{
  const auto* begin = static_cast<const char*>(data);
  bytes_.insert(bytes_.end(), begin, begin + bytes);
}

void PackedWriter::integers(std::span<const Global> list)
{
  PackedHead head{list.size(), 0};
  std::uint64_t largest = 0;
  if (!list.empty()) {
    const auto [least, most] = std::ranges::minmax(list);
    head.least = least;
    largest = static_cast<std::uint64_t>(most) - static_cast<std::uint64_t>(least);
  }
  const int width = width_of(largest);
  append(&head, sizeof head);
  bytes_.push_back(static_cast<char>(width));
  auto at = bytes_.size();
  bytes_.resize(at + list.size() * static_cast<std::size_t>(width));
  with_width(width, [&](auto number) {
    for (const Global x : list) {
      number = static_cast<decltype(number)>(static_cast<std::uint64_t>(x) - static_cast<std::uint64_t>(head.least));
      std::memcpy(bytes_.data() + at, &number, sizeof number);
      at += sizeof number;
    }
  });
}

void PackedWriter::numbers(std::span<const double> list)
{
  const std::uint64_t count = list.size();
  append(&count, sizeof count);
  append(list.data(), list.size_bytes());
}

std::span<const char> PackedReader::take(std::size_t bytes)
{
  if (bytes > rest_.size()) throw std::out_of_range("a packed message ends too early");
  const auto taken = rest_.first(bytes);
  rest_ = rest_.subspan(bytes);
  return taken;
}

std::vector<Global> PackedReader::integers()
{
  PackedHead head{};
  std::memcpy(&head, take(sizeof head).data(), sizeof head);
  const int width = take(1).front();
  std::vector<Global> list(head.count, head.least);
  const auto data = take(head.count * static_cast<std::size_t>(width));
  with_width(width, [&](auto number) {
    for (std::size_t i = 0; i < list.size(); ++i) {
      std::memcpy(&number, data.data() + i * sizeof number, sizeof number);
      list[i] = static_cast<Global>(static_cast<std::uint64_t>(head.least) + number);
    }
  });
  return list;
}

std::vector<double> PackedReader::numbers()
{
  std::uint64_t count = 0;
  std::memcpy(&count, take(sizeof count).data(), sizeof count);
  std::vector<double> list(count);
  const auto data = take(count * sizeof(double));
  if (count > 0) std::memcpy(list.data(), data.data(), data.size());
  return list;
}

}  // namespace mortise
