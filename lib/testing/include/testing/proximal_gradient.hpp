// Contact forces by proximal gradient steps on a matrix in displacements, which knows neither multipliers nor subdomains.
#pragma once

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "feti/dual_problem.hpp"
#include "friction/law.hpp"

namespace mortise::friction {

/// Three forces a point: along the normal out of the body, and along the tangents; and the slip bounds.
struct Reference {
  Eigen::VectorXd forces, bounds;
};

/// min 1/2 w'S w - c'w + sum_p bound_p |w_t| over w_n <= 0, of relative displacements w in the frame of each point; S w - c are
/// minus the contact forces. Coulomb's bounds follow the forces: from `bounds` on by this part of the way each time.
inline Reference by_proximal_gradient(const Eigen::MatrixXd& s, const Eigen::VectorXd& c, Law law, Eigen::VectorXd bounds,
                                      double part = 1)
{
  using Kind = Law::Kind;
  const double step = 1 / s.selfadjointView<Eigen::Lower>().eigenvalues().maxCoeff();
  const Eigen::Index points = bounds.size();
  Eigen::VectorXd w = Eigen::VectorXd::Zero(c.size()), y = w, before = w;
  if (law.kind == Kind::tresca) bounds.setConstant(law.value);
  Reference result{w, std::move(bounds)};
  for (int round = 0; round < (law.kind == Kind::coulomb ? 200 : 1); ++round) {
    double t = 1, moved = 1;
    y = before = w;
    for (int i = 0; i < 200000 && moved > 1e-15; ++i) {  // Nesterov's, begun anew where it turns back
      w = y + step * (c - s * y);
      for (Eigen::Index p = 0; p < points; ++p) {
        w[3 * p] = std::min(w[3 * p], 0.0);
        auto slip = w.segment(3 * p + 1, 2);
        const double length = slip.norm();
        slip *= length > step * result.bounds[p] ? 1 - step * result.bounds[p] / length : 0.0;
      }
      const double next = (y - w).dot(w - before) > 0 ? 1 : 0.5 * (1 + std::sqrt(1 + 4 * t * t));
      moved = (w - before).norm();
      y = w + (next == 1 ? 0 : (t - 1) / next) * (w - before);
      before = w;
      t = next;
    }
    result.forces = c - s * w;
    if (law.kind != Kind::coulomb) break;
    Eigen::VectorXd wanted = result.bounds;
    for (Eigen::Index p = 0; p < points; ++p) wanted[p] = law.value * std::max(result.forces[3 * p], 0.0);
    const bool rests = (wanted - result.bounds).norm() <= 1e-12 * wanted.norm();
    result.bounds += part * (wanted - result.bounds);
    if (rests) break;
  }
  return result;
}

/// Forces of so many points whose rows stand on the ranks in turn, on every rank. Collective.
inline Eigen::VectorXd forces_of(const feti::DualProblem& problem, const Vector& multipliers, std::size_t points)
{
  Eigen::VectorXd forces = Eigen::VectorXd::Zero(3 * static_cast<Eigen::Index>(points));
  const Eigen::VectorXd own = problem.forces(multipliers);
  const auto& comm = problem.communicator();
  for (std::size_t i = 0; i < problem.node_rows().size(); ++i) {
    const auto& rows = problem.node_rows()[i];
    forces.segment(3 * (static_cast<Eigen::Index>(i) * comm.size() + comm.rank()), rows.tangents + 1) =
        own.segment(rows.normal, rows.tangents + 1);
  }
  comm.sum_in_place({forces.data(), static_cast<std::size_t>(forces.size())});
  return forces;
}

}  // namespace mortise::friction
