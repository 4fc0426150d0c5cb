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

/// How far a warning is beyond its limit.
inline double excess(const Warning& w)
{
  return w.limit > 0 ? w.value / w.limit : w.value;
}

/// The worst of warnings of one kind, by value / limit or another weight, which also says how many others there are: a hundred
/// rollers that roll too far are one thing to tell. `others` names them.
inline std::vector<Warning> worst(std::vector<Warning> all, const std::string& others, double (*weight)(const Warning&) = excess)
{
  if (all.empty()) return {};
  std::size_t most = 0;
  for (std::size_t i = 1; i < all.size(); ++i)
    if (weight(all[i]) > weight(all[most])) most = i;
  Warning result = std::move(all[most]);
  if (all.size() > 1) result.text += fmt::format("; {} other {} as well", all.size() - 1, others);
  return {result};
}

}  // namespace mortise::post
