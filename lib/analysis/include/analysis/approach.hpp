// Products with F, or a direct solution: how a deck's quadratic programmes are gone about, and what is tried where that finds no
// end.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "base/context.hpp"
#include "base/error.hpp"
#include "constraint/constraints.hpp"
#include "model/deck.hpp"
#include "partition/decomposition.hpp"
#include "qp/budget.hpp"

namespace mortise::analysis {

class Assembly;

struct Approach {
  enum class Kind {
    as_asked,            ///< what the deck says
    smaller_subdomains,  ///< the same with large subdomains cut into small pieces
    direct_instead,      ///< every body whole, and F as a matrix
    products_to_the_end  ///< face Newton, after a direct solution that did not settle
  } kind = Kind::as_asked;
  std::string algorithm;                   ///< as solver.algorithm of the deck
  std::optional<qp::Patience> patience{};  ///< when a load step gives up, see friction::Result::gave_up
  int spent = 0;                           ///< products so far, which count
  Kind next = Kind::direct_instead;        ///< what is tried after giving up
  bool smaller = false;                    ///< large subdomains have been cut into small pieces
};

/// The approach with its patience: with `auto` as many products as a direct solution is worth, or, where subdomains are several
/// times as large as usual, smaller ones. Throws Error(machine) if the deck asks for a direct solution and there is no room for
/// it. Collective.
Approach with_patience(Approach approach, const Assembly& assembly, const constraint::Constraints& constraints,
                       const Communicator& comm);

/// Whether an error of this approach leads to the next one instead of ending the run: what a direct solution may fall on where
/// products with F do not, rounding and memory.
bool is_tried_again(const Approach& approach, const Error& error);

/// All load steps by one approach on one decomposition; nothing if it gave up. Adds to approach.spent what it spent, also where
/// it throws.
using Attempt = std::function<std::optional<ExitStatus>(const partition::Decomposition&, Approach&)>;

/// What the deck asks for on the decomposition `as_cut`. Where products with F find no end, large subdomains are cut into small
/// pieces, since the coarse problem of many small ones knows how slender bodies bend; then bodies are taken whole and
/// solved directly; where rounding (cells a thousand times as long as thick) or memory spoils that, the first way is gone to its
/// end. `resumed`: the one that an earlier run came to, which is the first then. Collective.
ExitStatus try_approaches(const model::Deck& deck, const partition::Decomposition& as_cut, const Attempt& attempt,
                          const Context& context, const std::optional<Approach>& resumed = {});

}  // namespace mortise::analysis
