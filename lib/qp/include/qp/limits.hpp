// Where the algorithms of the table of solvers end, and where one takes over from another: a struct for each row of solver.cpp,
// for what they have in common and for the changes that `auto` makes. Steps, weights and guards against rounding that only one
// function knows stand in its file. Residuals are over ||P b|| unless it says else, errors in the norm of A. What a solve is
// asked for is its caller's, see Goal; how Coulomb's fixed point ends stands in lib/friction.
#pragma once

#include <cstddef>
#include <cstdint>

namespace mortise::qp::limits {

/// Of every row: what residuals and errors mean, whoever finds them.
struct Every {
  static constexpr double loosest = 1e-2;    ///< residual of a problem whose solution only leads to the next one
  static constexpr double finest = 1e-7;     ///< enough where no error is allowed
  static constexpr double rounding = 1e-12;  ///< below which there is nothing to gain

  /// The residual up to which an estimated error that is good enough ends a solve. Beyond it the error has to be small itself:
  /// one that is estimated from a residual as large as b is a guess.
  static constexpr double largest_residual = 0.4;
  // Parts of the energy norm that an error may be for a small residual to be a solution, see Goal::credible.
  static constexpr double condition = 100;        ///< times the residual, but
  static constexpr double least_credible = 1e-4;  ///< no less: at 1e-3 displacements of strips that bend are off by 1e-3
  static constexpr double most_credible = 1e-2;   ///< where an error is allowed, or nothing can make the residual smaller
  /// Goal::incompatibility: energy and residuals feel little of what is soft, as plates that bend.
  static constexpr double compatible = 1e-3;
  static constexpr double nearly_compatible = 1e-2;   ///< where going on did not make the residual smaller
  static constexpr double exactly_compatible = 1e-5;  ///< of a start by matrices: each figure more is a step of A^-1
};

/// Of every row: products with A, see qp::Budget.
struct Budget {
  static constexpr int most = 10000;    ///< of one solve, whatever becomes better
  static constexpr int stretch = 2500;  ///< without anything better: of random decks that ended well the worst had 1,200
  static constexpr double less = 0.7;   ///< times the best so far is better
  static constexpr int look = 100;      ///< that tell whether to go on where something else is ready
  /// That tell a pace. With all since the first one a belt went on for 285 products, as its residual had fallen quickly at first.
  static constexpr int of_late = 50;
};

/// The row `face_newton`. Where it gives up, SMALSE-M goes on if radii are given, and the fixed point over such problems if not.
struct FaceNewton {
  // Each active set is solved roughly: one that is not yet the right one is worth no more.
  static constexpr double inner_reduction = 0.2;   ///< of the projected gradient; 0.1 and 0.3 are alike, 0.03 and 0.7 worse
  static constexpr double below_goal = 0.1;        ///< of the residual that is asked for, and no further
  static constexpr double below_goal_alone = 0.5;  ///< the same without constraints: this active set is the last
  static constexpr double below_allowed = 0.3;     ///< of the residual at which the error would be the allowed one
  static constexpr double nothing_to_do = 1e-2;    ///< of what is to be reached: an active set that begins there is solved
  static constexpr std::size_t fewest_inner = 60;  ///< steps; as many as there is room to keep, if that is more
  static constexpr int most_unconstrained = 1000;  ///< steps where there are no constraints, and no other active sets

  // Solved.
  static constexpr int stands_still = 5;               ///< active sets without a better residual: what is left may be rounding
  static constexpr double rounding_of_balance = 1e-9;  ///< what projections may lack of G x = e then
  static constexpr double least_size = 0.01;           ///< of ||A||^1/2 ||x||_A, for ||P b|| where b asks for nearly nothing
  static constexpr double first_look = 0.1;            ///< of the first error, at which the allowed one is asked for: that costs
  static constexpr double at_rest = 0.05;             ///< change of normal forces still to come: friction and pressures know them
  static constexpr double certain = 0.1;              ///< of the allowed error, at which that change does not matter
  static constexpr double radii_at_rest = 2e-3;       ///< their change, over them: else a joint may be beyond its friction
  static constexpr double residual_of_direct = 1e-7;  ///< from matrices: less moves forces among dependent rows for ever
  static constexpr double part_that_is_nothing = 0.1;  ///< of what rounding may make of an error
  static constexpr double times_nothing = 10;          ///< that, at most, is the energy norm of what only moves: solved

  // Given up.
  static constexpr double better = 0.9;       ///< times the best residual or, beside it, error: else nothing was gained
  static constexpr int patience = 20;         ///< active sets without a better residual
  static constexpr int update_patience = 10;  ///< the same where radii follow the solution, for then there is another way
  static constexpr int most_active_sets = 200;
  static constexpr int most_safeguards = 12;  ///< steps that went up: another algorithm will do better
  static constexpr double away = 10;          ///< times the error of a start by matrices that will do but for its states
};

/// The row `smalse`. Nothing but Budget::most ends it early, for its residual may rise for long.
struct Smalse {
  static constexpr double start_precision = 0.25;  ///< M_0; not the usual 1: the start is feasible and mu is known roughly
  static constexpr double shrink_precision = 0.5;  ///< beta: M falls by this when the Lagrangian did not rise enough
  static constexpr double start_accuracy = 0.1;    ///< eta: no inner iteration ends above it, however far G x is from e
  static constexpr int most_outer = 1000;
  static constexpr double rounding = 1e-15;  ///< of ||x||: what rounding leaves of the distance to G x = e

  // Where an error is allowed, tolerances fall from Every::loosest to Every::finest until it is reached.
  static constexpr double below_allowed = 0.5;                 ///< of the tolerance that would lead to the allowed error
  static constexpr double least_fall = 0.5, most_fall = 0.03;  ///< times the tolerance before: errors do not go like residuals
  static constexpr double fall_of_doubtful = 0.1;              ///< the same, of a residual whose error is too large for it
};

/// The row `direct`: when solutions by matrices will do, and how often they are corrected. Face Newton shows them to be some.
struct Direct {
  static constexpr double rounding_of_direct = 1e-4;  ///< of the energy norm: error that they may leave; the mesh's is more
  /// The same where a residual is asked for that rounding of products keeps: a hundredth of what Every::least_credible lets pass.
  static constexpr double makes_up_for_residual = 1e-6;
  static constexpr double rough_residual = 1e-4;  ///< that may be left then
  /// And of what matrices found where products do not end at all, as for soft films between stiff bodies: multipliers have no
  /// more figures. post::unreached_tolerance() tells it.
  static constexpr double makes_up_for_any_residual = 1e-3;
  static constexpr double much = 1e-3;             ///< of the energy norm: an error beyond which other matrices are tried
  static constexpr int most_motions = 100;         ///< of G, of which a sharper error is worth a solution each
  static constexpr int steps_to_least_energy = 2;  ///< the second for what rounding leaves of the first
  static constexpr double outside = 1e-6;          ///< of x: part of it that may lie outside of Omega, or not balance the loads

  // Corrections of what the matrices differ from A by, as rows that depend on each other are given a compliance.
  static constexpr int most_corrections = 4;      ///< as long as each leaves
  static constexpr double better = 0.3;           ///< times the defect before,
  static constexpr double of_goal = 0.1;          ///< and more than so much of the residual that is asked for, or of
  static constexpr double asked_at_least = 1e-6;  ///< for what is left makes states turn,
  static constexpr double of_energy = 3e-5;       ///< or of the energy norm
};

/// The row `direct`: the search for the states of constraints (StateSearch): guesses, softened contact, central paths. Residuals
/// are over x.
struct States {
  static constexpr double settled = 1e-10;  ///< residual of a problem that is solved
  static constexpr double flutter = 1e-12;  ///< below which guesses differ by rounding alone

  // Guesses.
  static constexpr int most_guesses = 15;          ///< at one softness, and so many
  static constexpr int most_last_guesses = 60;     ///< once it is none: plates settle after 24
  static constexpr int look_back_at_first = 4;     ///< guesses that must have halved changes, if these are more than a few
  static constexpr int look_back_on_path = 1;      ///< the same from points of a path, which soon has a nearer one
  static constexpr double few_changes = 0.02;      ///< of all constraints: few changes,
  static constexpr double handful = 8;             ///< or so many in all, if that is more
  static constexpr double nearly_right = 0.1;      ///< changes, of all constraints, of states that another way has come to
  static constexpr int idle_before_single = 4;     ///< guesses without fewer changes: from then on one place at a time,
  static constexpr int idle_single = 30;           ///< for so many more,
  static constexpr int most_single_guesses = 300;  ///< or all together
  static constexpr double other_loads = 1e-3;      ///< residual of a solution before, beyond which what slipped sticks first
  static constexpr int most_load_steps = 16;       ///< on the way to these loads, tries and all,
  static constexpr double least_load_step = 0.05;  ///< and the shortest one
  static constexpr double residual_of_soft = 0.1;  ///< of a soft contact, which only gives states to begin with
  static constexpr int most_polishing = 4;         ///< guesses more, as long as they make the residual smaller

  // What rounding leaves of a residual.
  static constexpr double stalled = 0.5;            ///< of the residual before: it stands,
  static constexpr double rounded_residual = 1e-6;  ///< and is no more than this, or than so many times
  static constexpr double roundings = 1e4;          ///< what rounding makes of W x,
  static constexpr int idle = 8;                    ///< with so many guesses without fewer changes
  static constexpr int solved_again = 3;            ///< guesses that solve the problem, whatever states the next one takes

  // Bodies that slide on for ever.
  static constexpr double same_step = 1e-6;  ///< of motions, from guess to guess
  static constexpr double way_out = 0.05;    ///< of the slip, that a motion may open contact by and still be a slide

  // Which way comes after which, by what it costs.
  static constexpr std::int64_t few_unknowns = 2000;  ///< up to which a factor of W takes a moment; beyond, as long as guesses
  static constexpr std::int64_t very_few_unknowns = 800;  ///< up to which steps of other lengths are tried: hundreds of guesses
  static constexpr std::int64_t few_motions = 5000;       ///< up to which a sparse factor takes a moment
  static constexpr std::int64_t few_motions_of_whole = 20000;   ///< the same of one with nothing eliminated,
  static constexpr std::int64_t motions_of_one_whole = 100000;  ///< and where there is one alone
  static constexpr int guesses_of_path = 60;                    ///< that a path takes as long as
  static constexpr double soft_for_large_ones = 1e5;            ///< softness beyond which a path takes fewer steps than hardening
  static constexpr double most_operations = 3e12;               ///< of factors that a last search may take: 100 s

  // Central paths.
  static constexpr int most_on_path = 100;              ///< linear problems
  static constexpr int stuck_on_path = 12;              ///< the last of so many must have halved tau, or what equations lack
  static constexpr double path_near = 1e-3;             ///< residual from which on guesses are tried from the path,
  static constexpr double path_nearer = 0.1;            ///< and of what it was then, to try again
  static constexpr double end_of_path = 1e-13;          ///< of the first product,
  static constexpr double end_of_rough_path = 1e-7;     ///< where guesses go on from it
  static constexpr double worth_a_guess = 0.1;          ///< residual, with matrices whose paths are costly
  static constexpr double end_of_costly_path = 1e-7;    ///< residual where guesses do not end it, and are all there is
  static constexpr double settled_on_path = 1e-9;       ///< residual at which radii are those of the forces,
  static constexpr double rounded_on_path = 1e-7;       ///< or no better,
  static constexpr int in_vain = 2;                     ///< with so many radii in a row
  static constexpr int patience_with_radii = 6;         ///< radii in a row without a residual that is so much,
  static constexpr int patience_with_costly_radii = 1;  ///< with sparse matrices,
  static constexpr double nearer = 0.7;                 ///< of the least before
};

/// `auto`, from products with A to matrices: products that a row may take while another is ready, see Patience. What matrices
/// take is foreseen by lib/analysis (effort, approach), which knows subdomains.
struct Automatic {
  // Of the first products: as many as take as long as the matrices.
  static constexpr double shortest = 15;        ///< in any case: contact that is easily found needs no more
  static constexpr double a_second = 16;        ///< more for each second that matrices take,
  static constexpr double a_moment = 60;        ///< where these are less,
  static constexpr double longest = 100;        ///< up to so many: one random deck in twenty takes more than 52
  static constexpr double part_of_rest = 0.25;  ///< of what matrices take, that an end of products in sight may take more,
  static constexpr double most_of_rest = 40;    ///< products at most,
  static constexpr double at_once = 0.1;        ///< if matrices take so many seconds
  static constexpr int on_large_ones = 80;      ///< on subdomains that are much larger than usual,
  static constexpr int on_smaller_ones = 60;    ///< and then on smaller ones, at least

  // With every body whole, between these and matrices.
  static constexpr double long_direct = 4;          ///< seconds from which on matrices are long enough for that
  static constexpr int on_whole_bodies = 300;       ///< without rows between subdomains contact alone is left to find
  static constexpr int near_on_whole_bodies = 100;  ///< and these more with the end in sight
  static constexpr int on_slender_bodies = 40;      ///< of them: plates 400 times as wide as thick find no end in 400

  // Of matrices.
  static constexpr int of_check = 600;                     ///< that show a start: plates 280 times as wide as thick need 452
  static constexpr double part_of_memory = 0.5;            ///< of what is available, that they may take
  static constexpr std::int64_t most_multipliers = 12000;  ///< with dense ones
};

}  // namespace mortise::qp::limits
