#include "post/verdict.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace mortise::post {

namespace {

// What `tolerance: auto` may leave where the error is a tenth of the mesh's: some three times what it was seen to leave.
constexpr double gradient_limit = 0.5;
constexpr double equality_limit = 1e-2;
constexpr double penetration_limit = 5e-2;      // of the largest displacement
constexpr double supports_limit = 5e-2;         // of the largest displacement
constexpr double interfaces_limit = 5e-2;       // of the largest displacement
constexpr double complementarity_limit = 5e-2;  // of twice the strain energy
// Nearly incompressible bodies leave gradients of 10 and 300 where the energy is right to 0.3 and 0.5 %: multipliers that waver
// from node to node cost no energy. So an error below this excuses the gradient.
constexpr double error_that_excuses = 1e-2;
// Factorizations alone decide these two.
constexpr double equilibrium_limit = 1e-5;
constexpr double imbalance_limit = 1e-3;
constexpr double balanced = 1e-10;  // forces on every subdomain: the rest is rounding
// No estimate above this is a solution, whatever the mesh allows. What it allows is the solver's to keep.
constexpr double error_limit = 0.25;

constexpr double drifting = 0.5;  // sizes

// `name value (limit limit)` of what exceeds its limit; not a number exceeds any.
std::string unfit(const Evidence& e)
{
  std::string text;
  const auto check = [&](const char* name, double value, double limit) {
    if (value <= limit) return;
    const std::string size = std::isfinite(value) ? fmt::format("{:.2g}", value) : "unknown";
    text += fmt::format("{}{} {} (limit {:.2g})", text.empty() ? "" : ", ", name, size, limit);
  };
  if (!(e.algebraic_error <= error_that_excuses) || !std::isfinite(e.projected_gradient))
    check("gradient", e.projected_gradient, std::max(gradient_limit, e.tolerance));
  // In displacements: thin bodies bend far under what rounding leaves of forces.
  if (!(e.algebraic_error <= error_that_excuses && e.equilibrium <= balanced) || !std::isfinite(e.equality))
    check("equality", e.equality, std::max(equality_limit, e.tolerance));
  check("equilibrium", e.equilibrium, equilibrium_limit);
  check("penetration", e.penetration, std::max(penetration_limit, e.tolerance));
  check("supports", e.supports, std::max(supports_limit, e.tolerance));
  check("interfaces", e.interfaces, std::max(interfaces_limit, e.tolerance));
  check("complementarity", e.complementarity, std::max(complementarity_limit, e.tolerance));
  check("balance of forces", e.imbalance, imbalance_limit);
  if (!std::isnan(e.algebraic_error)) check("the solver's error", e.algebraic_error, error_limit);
  return text;
}

std::string cure(const Evidence& e)
{
  if (!e.limit.empty()) return fmt::format("It was ended by {}; a larger value lets it go on.", e.limit);
  if (!(e.imbalance <= imbalance_limit))
    return "The forces do not balance: a motion that only facets of the mesh resist was taken for free, and the loads drive it. "
           "Hold the body against it by a support.";
  if (!e.converged)
    return "It made no more progress: a looser solver.tolerance may be all that this mesh allows; --set solver.algorithm=smalse "
           "is the other way.";
  return "Set a smaller solver.tolerance than the one that stopped it.";
}

}  // namespace

Verdict verdict(const Evidence& e)
{
  const std::string wrong = unfit(e);
  const bool unfinished = !e.converged || !wrong.empty();
  if ((unfinished && e.limit.empty() && e.drift.sizes > drifting) || std::isnan(e.drift.sizes))
    return {
        ExitStatus::no_equilibrium, "NO EQUILIBRIUM.",
        fmt::format("no equilibrium: {}, {:.3g} times its size, and what little holds it is no support: facets of the mesh, or "
                    "friction at its limit{}; support it, or look at the direction of the loads and at the friction",
                    e.drift.text, e.drift.sizes, wrong.empty() ? "" : " (" + wrong + ")")};
  if (!unfinished) return {ExitStatus::solved, "Solved.", ""};
  return {ExitStatus::not_converged, "NOT CONVERGED within the limits: the results are written, but do not trust them.",
          cure(e) + (wrong.empty() ? "" : fmt::format(" Beyond its limit: {}.", wrong))};
}

std::vector<Warning> unreached_tolerance(const Residuals& residuals, double tolerance, double algebraic_error)
{
  constexpr double more = 2;  // the last digit of a residual is rounding
  if (!(tolerance > 0) || !(residuals.projected_gradient > more * tolerance)) return {};
  Warning w{"unreached_tolerance",
            fmt::format("the projected gradient comes down to {:.1e} and not to solver.tolerance = {:.1e}: rounding leaves no "
                        "less on this mesh; "
                        "the solver's error is {:.1e} in the energy norm",
                        residuals.projected_gradient, tolerance, algebraic_error),
            "nothing, or a tolerance that can be reached"};
  w.value = residuals.projected_gradient;
  w.limit = tolerance;
  return {w};
}

}  // namespace mortise::post
