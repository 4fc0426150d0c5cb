#include "history.hpp"

#include <fmt/format.h>
#include <mpi.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <sstream>

#include "base/interruption.hpp"

namespace mortise {

namespace {

constexpr const char* header =
    "stage,friction_step,outer_iteration,hessian_multiplications,preconditionings,projected_gradient,equality,slip_bound_change,"
    "precision,open,slipping,time,dual_energy,error\n";
constexpr int column_of_time = 11;

// In a table: nothing where there is no number yet.
std::string number(double x, int digits = 6)
{
  return std::isfinite(x) ? fmt::format("{:.{}e}", x, digits) : "";
}

}  // namespace

// In this state, if the residual goes on falling by as many powers of ten a second as until now; "" where nothing can be said
// yet.
std::string History::time_left(const model::LoadState& state, double residual)
{
  constexpr double soon = 3;  // seconds that are not worth a word
  if (state_ != state.time || !(first_residual_ > 0)) {
    state_ = state.time, start_ = MPI_Wtime(), first_residual_ = residual;
    return "";
  }
  if (!options_.tolerance.value || !(residual > *options_.tolerance.value) || !(residual < first_residual_)) return "";
  const double done = std::log(first_residual_ / residual), all = std::log(first_residual_ / *options_.tolerance.value);
  const double elapsed = MPI_Wtime() - start_, left = elapsed * (all / done - 1);
  return elapsed > soon && left > soon ? fmt::format("; about {:.0f} s left", left) : "";
}

void History::note(const model::LoadState& state, int step, double change, const qp::Progress& p)
{
  if (p.what != "inner" || ++inner_ % 4 == 0) stop_if_requested(context_.comm);  // asking takes time where ranks share a core
  if (p.what == "inner") {
    const double residual = std::max(p.projected_gradient, p.equality);
    const auto measures = options_.algorithm == "smalse"
                              ? fmt::format("gradient {:.1e}, equality {:.1e}", p.projected_gradient, p.equality)
                          : std::isfinite(residual) ? fmt::format("residual {:.1e}", residual)
                                                    : "no residual yet";
    context_.log.progress("  {}outer {}, {} products, {} (tolerance {}){}",
                          step > 1 ? fmt::format("friction step {}, ", step) : "", p.outer, p.applications, measures,
                          options_.tolerance.value ? fmt::format("{:.1e}", *options_.tolerance.value) : "auto",
                          active_ + time_left(state, residual));
    return;
  }
  const auto bounds = context_.comm.sum(p.active.bounds), discs = context_.comm.sum(p.active.discs);
  while (!earlier_.empty() && earlier_.back().time >= state.time) earlier_.pop_back();
  rows_ += fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{},{}\n", p.what, step, p.outer, p.applications, p.preconditionings,
                       number(p.projected_gradient), number(p.equality), number(change), number(p.precision, 3), bounds, discs,
                       state.time, number(p.energy, 12), number(p.error, 3));
  active_ = fmt::format("; {} open, {} slipping", bounds, discs);
}

void History::take_up(const std::string& text)
{
  std::istringstream lines(text);
  std::string line;
  std::getline(lines, line);  // the header
  while (std::getline(lines, line)) {
    std::istringstream cells(line);
    std::string cell;
    for (int i = 0; i <= column_of_time; ++i) std::getline(cells, cell, ',');
    earlier_.push_back({std::strtod(cell.c_str(), nullptr), line + "\n"});
  }
}

std::string History::text() const
{
  std::string text = header;
  for (const auto& row : earlier_) text += row.text;
  return text + rows_;
}

}  // namespace mortise
