#include "history.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/interruption.hpp"

namespace mortise {

namespace {

// In a table: nothing where there is no number yet.
std::string number(double x, int digits = 6)
{
  return std::isfinite(x) ? fmt::format("{:.{}e}", x, digits) : "";
}

}  // namespace

void History::note(const model::LoadState& state, int step, double change, const qp::Progress& p)
{
  if (p.what != "inner" || ++inner_ % 4 == 0) stop_if_requested(context_.comm);  // asking takes time where ranks share a core
  if (p.what == "inner") {
    const auto measures = options_.algorithm == "smalse"
                              ? fmt::format("gradient {:.1e}, equality {:.1e}", p.projected_gradient, p.equality)
                              : fmt::format("residual {:.1e}", std::max(p.projected_gradient, p.equality));
    context_.log.progress("  {}outer {}, {} products, {} (tolerance {}){}",
                          step > 1 ? fmt::format("friction step {}, ", step) : "", p.outer, p.applications, measures,
                          options_.tolerance.value ? fmt::format("{:.1e}", *options_.tolerance.value) : "auto", active_);
    return;
  }
  const auto bounds = context_.comm.sum(p.active.bounds), discs = context_.comm.sum(p.active.discs);
  text_ += fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{},{}\n", p.what, step, p.outer, p.applications, p.preconditionings,
                       number(p.projected_gradient), number(p.equality), number(change), number(p.precision, 3), bounds, discs,
                       state.time, number(p.energy, 12), number(p.error, 3));
  active_ = fmt::format("; {} open, {} slipping", bounds, discs);
}

}  // namespace mortise
