// What a solve leaves open: contact nodes of which it is not known whether they press or slip, and those at which it made no
// progress. Both are called points.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "feti/dual_problem.hpp"
#include "feti/state_record.hpp"
#include "qp/predicted_solution.hpp"

namespace mortise::feti {

/// The points of one contact whose state is not known.
struct Undecided {
  struct Band {
    long long points = 0;
    int cells = 0;  ///< how wide the band is at its widest place, from decided points to decided points
  };
  int contact = 0;     ///< index into the deck's contacts
  Band rim;            ///< of points that may be open or closed
  Band edge_of_stick;  ///< of closed points that may stick or slip
};

/// Points of one contact at which a solve made no progress.
struct Stuck {
  int contact = 0;
  long long points = 0;
  std::string states;           ///< that they took in turns: "open/closed" or "stick/slip"; "at rest": only their forces vary
  Point place = Point::Zero();  ///< of the worst of them
  int turns = 0, of = 0;        ///< its state changed `turns` times over the last `of` steps
};

/// Change of a pressure over the largest of the contact that decides nothing.
inline constexpr double negligible_change = 1e-4;

/// The states of this rank's points at multipliers x in Omega, which is `set`; forces of 1e-8 of the largest multiplier are none.
/// Bonded points stick. Collective.
std::vector<ContactStatus> states_at(const DualProblem& problem, const qp::FeasibleSet& set, const Vector& x);

/// Contacts with points that `change` may carry across the border, one after the other. Points whose change is next to nothing
/// beside the largest pressure of the contact count as decided. The same on every rank. Collective.
std::vector<Undecided> undecided(const DualProblem& problem, const qp::FeasibleSet& set, const Vector& x,
                                 const qp::PredictedSolution& predicted);

/// Where a solve is stuck that did not converge: points whose state went there and back, or if none did, that changed, or if none
/// did, with the largest change of force still to come (`predicted`, if it is known). The same on every rank. Collective.
std::vector<Stuck> stuck(const DualProblem& problem, const StateRecord& record, const Vector& x,
                         const qp::PredictedSolution* predicted);

struct BandPoint {
  Point at;
  bool open;  ///< not decided
};
/// The widest band of open points, in cells, from one point to the next: 2 where one row is open between decided points, 1 more
/// for each further row. At up to some hundred of them, across the band, which is the way where it is narrowest.
int widest_band(std::span<const BandPoint> points);

}  // namespace mortise::feti
