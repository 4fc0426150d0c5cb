// The functions behind the rows of the table of solvers, each in a file of its own.
#pragma once

#include "qp/solver.hpp"

namespace mortise::qp {

std::unique_ptr<Solver> make_face_newton(const Programme& programme, const Means& means);
std::unique_ptr<Solver> make_smalse(const Programme& programme, const Means& means);
std::unique_ptr<Solver> make_direct(const Programme& programme, const Means& means);

/// SMALSE-M with the radii that discs have, to a goal. Where that is an allowed error, with tolerances that fall until it is
/// reached. `preconditioner`, which may be null, is for the bound of the error alone. Collective.
Solution smalse_to_goal(const Problem& problem, std::optional<Solution> start, const Goal& goal,
                        ActiveSetPreconditioner* preconditioner, const Observer& observer);

/// Face Newton, with SMALSE-M to take over where it crawls. `inverse` preconditions face Newton.
std::unique_ptr<Solver> face_newton_with(ActiveSetPreconditioner* inverse, const Programme& programme, const Means& means);

}  // namespace mortise::qp
