// How places and numbers of warnings are spelt.
#pragma once

#include <fmt/format.h>

#include <string>
#include <vector>

#include "base/warning.hpp"

namespace mortise::post {

inline std::string spell(const Point& p)
{
  return fmt::format("({:.4g}, {:.4g}, {:.4g})", p[0], p[1], p[2]);
}

/// The worst of warnings of one kind by value / limit, which also says how many others there are: a hundred rollers that roll too
/// far are one thing to tell. `others` names them.
inline std::vector<Warning> worst(std::vector<Warning> all, const std::string& others)
{
  if (all.empty()) return {};
  const auto weight = [](const Warning& w) { return w.limit > 0 ? w.value / w.limit : w.value; };
  std::size_t most = 0;
  for (std::size_t i = 1; i < all.size(); ++i)
    if (weight(all[i]) > weight(all[most])) most = i;
  Warning result = std::move(all[most]);
  if (all.size() > 1) result.text += fmt::format("; {} other {} as well", all.size() - 1, others);
  return {result};
}

}  // namespace mortise::post
