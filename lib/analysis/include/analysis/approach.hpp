// How a deck's quadratic programmes are solved, by products with F or by a direct solution, and what is tried where one of these
// finds no end.
#pragma once

#include <exception>
#include <functional>
#include <memory>
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
class CarriedContact;

/// One way to solve all load steps, on a decomposition of its own.
struct Approach {
  enum class Kind {
    as_asked,             ///< what the deck says
    smaller_subdomains,   ///< the same with large subdomains cut into small pieces
    direct_instead,       ///< every body whole but those of boundary elements, and F as a matrix
    products_to_the_end,  ///< face Newton without patience, after a direct solution that failed
    whole_bodies          ///< as asked with every body whole but those of boundary elements; records count in this order
  } kind = Kind::as_asked;
  /// Whether its bodies are whole.
  bool takes_bodies_whole() const { return kind == Kind::direct_instead || kind == Kind::whole_bodies; }
  std::string algorithm;                   ///< as solver.algorithm of the deck
  std::optional<qp::Patience> patience{};  ///< when a load step gives up, see feti::DualSolution::gave_up
  int spent = 0;                           ///< products with F so far, those of earlier approaches included
  Kind next = Kind::direct_instead;        ///< what is tried after giving up
  bool smaller = false;                    ///< large subdomains have been cut into small pieces
  /// Where products gave up in the first state: how they left contact, spread over the ranks, for a direct solution to begin
  /// with.
  std::shared_ptr<const CarriedContact> contact = {};
};

/// The approach with its patience: with `auto` as many products as a direct solution costs, or few where subdomains are several
/// times as large as usual and smaller ones are to be tried next. Where a direct solution takes long, products with whole bodies
/// come before it. The numbers are those of qp::limits::Automatic. Throws Error(machine) if the deck asks for a direct solution
/// and there is no room for it. Collective.
Approach with_patience(Approach approach, const Assembly& assembly, const constraint::Constraints& constraints,
                       const Communicator& comm);

/// What an attempt to solve all load steps comes to.
struct Outcome {
  std::optional<ExitStatus> status;                      ///< of the run; nothing if another approach is to go on,
  Approach::Kind next = Approach::Kind::direct_instead;  ///< this one where products gave up
  int spent = 0;                                         ///< products with F so far, those of earlier approaches included
  std::exception_ptr error = {};                         ///< what it threw, if it failed in a way that another one may not
  std::shared_ptr<const CarriedContact> contact = {};    ///< see Approach
};

/// To be called where an exception is handled that an approach threw after so many products with F, those of earlier approaches
/// included. Rounding and lack of memory may spoil a direct solution, and not products with F: then the outcome of this attempt;
/// else the exception goes on. Not collective: any rank may come here.
Outcome failed(const Approach& approach, int spent, const Communicator& comm);

/// Solves all load steps by one approach on one decomposition. Collective.
using Attempt = std::function<Outcome(const partition::Decomposition&, const Approach&)>;

/// Tries one approach after the other until one does not give up. First what the deck asks for on the decomposition `as_cut`.
/// Where products with F find no end, large subdomains are cut into small pieces, since the coarse problem of many small ones
/// knows how slender bodies bend; then bodies are taken whole, with products where a direct solution takes long, and solved
/// directly; where rounding (cells a thousand times as long as thick) or memory spoils that, products with F go on to their
/// limit. `resumed`: the approach that an earlier run came to, with which this one begins. Throws what the last attempt throws.
/// Collective.
ExitStatus try_approaches(const model::Deck& deck, const partition::Decomposition& as_cut, const Attempt& attempt,
                          const Context& context, const std::optional<Approach>& resumed = {});

}  // namespace mortise::analysis
