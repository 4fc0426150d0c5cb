#include "history.hpp"

#include <fmt/format.h>
#include <mpi.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <sstream>

#include "base/interruption.hpp"
#include "qp/solver.hpp"

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

// The residual that ends the solve: the tolerance or, where that is auto, the one at which the error is about what it may be. Not
// a number while that is not known, nor where the error is small enough and contact has still to settle.
double History::target(const qp::Progress& p, double residual) const
{
  if (options_.tolerance.value) return *options_.tolerance.value;
  const double part = p.allowed_error / p.error;
  return part < 1 ? residual * part : std::numeric_limits<double>::quiet_NaN();
}

// In this state, if the residual goes on falling by as many powers of ten a second as until now; "" where nothing can be said
// yet.
std::string History::time_left(const model::LoadState& state, double residual, double target)
{
  constexpr double soon = 3;  // seconds that are not worth a word
  if (state_ != state.time || !(first_residual_ > 0)) {
    state_ = state.time, start_ = MPI_Wtime(), first_residual_ = residual;
    return "";
  }
  if (!(residual > target) || !(residual < first_residual_)) return "";
  const double done = std::log(first_residual_ / residual), all = std::log(first_residual_ / target);
  const double elapsed = MPI_Wtime() - start_, left = elapsed * (all / done - 1);
  return elapsed > soon && left > soon ? fmt::format("; about {:.0f} s left", left) : "";
}

void History::note(const model::LoadState& state, int step, double change, const qp::Progress& p)
{
  if (p.what != "inner" || ++inner_ % 4 == 0) stop_if_requested(context_.comm);  // asking takes time where ranks share a core
  if (p.what == "inner") {
    const double residual = std::max(p.projected_gradient, p.equality);
    const auto measures = qp::solver_kind(options_.algorithm).two_residuals
                              ? fmt::format("gradient {:.1e}, equality {:.1e}", p.projected_gradient, p.equality)
                          : std::isfinite(residual) ? fmt::format("residual {:.1e}", residual)
                                                    : "no residual yet";
    const double end = target(p, residual);
    const auto goal = options_.tolerance.value ? fmt::format("tolerance {:.1e}", end)
                      : std::isfinite(end)     ? fmt::format("tolerance auto, about {:.1e}", end)
                                               : "tolerance auto";
    context_.log.progress("  {}outer {}, {} products, {} ({}){}", step > 1 ? fmt::format("friction step {}, ", step) : "",
                          p.outer, p.applications, measures, goal, active_ + time_left(state, residual, end));
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
