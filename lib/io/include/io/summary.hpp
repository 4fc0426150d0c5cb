// summary.json: what a run found and what it cost. Its fields are a promise to other programs. Quantities are in the deck's
// units.
#pragma once

#include <array>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/types.hpp"
#include "base/warning.hpp"

namespace mortise::io {

/// One equilibrium and what it took to find it.
struct StateSummary {
  bool converged = false;
  int friction_steps = 0, outer_iterations = 0, hessian_multiplications = 0;
  struct {
    double projected_gradient = 0, equality = 0, equilibrium = 0, penetration = 0, complementarity = 0, supports = 0,
           interfaces = 0;
  } residuals;
  struct {
    double discretization = std::numeric_limits<double>::quiet_NaN();  ///< relative, in the energy norm; NaN: not estimated
    double algebraic = std::numeric_limits<double>::quiet_NaN();
  } error_estimate;
  double strain_energy = 0, max_von_mises = 0, max_displacement = 0;
  struct Location {
    std::array<double, 3> coordinates{};
    std::string body;
  };
  Location max_von_mises_place;
  struct Reaction {
    std::string boundary;  ///< of a support at points empty
    std::array<double, 3> force;
    std::optional<std::array<double, 3>> moment = {};  ///< about moments_about; none in axisymmetry
    std::string name = {};
  };
  std::array<double, 3> moments_about{};
  std::vector<Reaction> reactions;
  /// A probe of the deck; one at a point has an entry for each body that the point lies in.
  struct Probe {
    std::string name;
    std::string largest, smallest;  ///< of an extreme: its quantity
    std::string axes = {};          ///< that components are along; empty: those of the model
    double value = 0;
    Location place;
    struct State {
      std::array<double, 3> displacement, principal_stress;
      std::array<double, 6> stress;
      double von_mises;
    };
    std::optional<State> at_point = {};
    struct Path {
      std::string file;
      int points;
      double length;
    };
    std::optional<Path> path = {};
  };
  std::vector<Probe> probes;
  /// The point of a coupling: how it moves, what it does to the boundary, and what of that is the reaction of supports.
  struct Coupling {
    std::string name, boundary;
    std::array<double, 3> displacement, rotation, force, moment, reaction_force, reaction_moment;
    bool prescribed;  ///< by a support
  };
  std::vector<Coupling> couplings;
  /// A spring between two points; `force` > 0 pulls them together.
  struct Spring {
    std::string name;
    double force, elongation;
  };
  std::vector<Spring> springs;
  struct Contact {
    std::string name;
    std::array<double, 3> force;
    double max_pressure, area;
    long long open, stick, slip;
    double max_recovered_pressure = 0;  ///< averaged over the faces at a node
    double max_tension = 0;             ///< of bonded contacts, averaged likewise; >= 0
    struct Preload {
      double force, shortening;
    };
    bool exchanged = false;  ///< points and fields are those of the side that the deck calls primary
    /// What it starts with, before interference and loads; negative `smallest`: an overlap.
    struct InitialGap {
      double smallest, largest_overlap, touching_area;
    };
    std::optional<InitialGap> initial_gap = {};
    std::optional<Preload> preload = {};  ///< of a preloaded bolt: its tension, and how far the cut is drawn together
    /// Points whose state is not known, and between how many cells they lie.
    struct Band {
      long long points;
      int cells;
    };
    struct Undecided {
      Band open_closed, stick_slip;
    };
    std::optional<Undecided> undecided = {};  ///< only where there are such points
  };
  std::vector<Contact> contacts;
  /// Where a run is stuck that did not converge: points of one contact that took turns, and the worst of them.
  struct Stuck {
    std::string contact;
    long long points;
    std::string states;  ///< "open/closed", "stick/slip" or "at rest", see friction::Stuck
    std::array<double, 3> place;
    int turns, steps;  ///< how often the worst one's state changed, over how many steps
  };
  std::vector<Stuck> stuck;
};

/// The last equilibrium, with the work of all.
struct Summary : StateSummary {
  bool finished = true;  ///< false while states are still to come: then `converged` is false and `exit_status` null
  std::string version, title;
  std::string algorithm;  ///< that solved the last state
  int exit_status = 0, ranks = 1;
  Global primal_unknowns = 0, dual_unknowns = 0, subdomains = 0, kernel_dimension = 0, bodies = 0;
  Global single_precision = 0;               ///< of subdomains, whose factors are
  Global clusters = 0;                       ///< of subdomains; 0 without
  std::vector<std::string> body_names = {};  ///< by the index that fields have
  struct Step : StateSummary {
    std::string name;
    double time = 0;
  };
  std::vector<Warning> warnings;       ///< of all states, the worst of each kind and place
  std::vector<Step> steps;             ///< if the deck has load steps: all states that were solved
  std::map<std::string, double> time;  ///< seconds a stage, the largest over the ranks
  double peak_memory_bytes = 0;        ///< summed over the ranks
  /// What one rank sends, as base/traffic.hpp counts it.
  struct Communication {
    double messages = 0, bytes = 0, collectives = 0, collective_bytes = 0;
  };
  struct Spread {
    Communication largest, mean;  ///< over the ranks, each figure for itself
  };
  std::map<std::string, Spread> communication;  ///< a stage; empty: not counted, and not in the file
};

/// The text of summary.json for a run that was told to end before any state was solved.
std::string interrupted_summary(const std::string& version, const std::string& title, int exit_status);

/// The text of summary.json; numbers that are not finite become null.
std::string to_json(const Summary& summary);

}  // namespace mortise::io
