// Errors carry the exit status of the program, so that a script can tell a wrong deck from a model without equilibrium.
#pragma once

#include <functional>
#include <stdexcept>
#include <string>

#include "base/communicator.hpp"

namespace mortise {

/// What `mortise` returns to the shell.
enum class ExitStatus {
  solved = 0,          ///< solved to the tolerance
  bad_input = 1,       ///< the command line, the deck or the mesh is wrong
  not_converged = 2,   ///< the limits were reached first; results are written and marked so
  no_equilibrium = 3,  ///< a body slides or lifts off, or the model is a mechanism
  machine = 4,         ///< out of memory, file not writable
  interrupted = 130    ///< told to end, by Ctrl-C or a signal
};

/// An error with a message that tells the user what to mend.
class Error : public std::runtime_error {
 public:
  enum class Cause {
    other,
    memory  ///< there was not enough: an approach that takes less may succeed
  };
  Error(ExitStatus status, const std::string& message, Cause cause = Cause::other)
      : std::runtime_error(message), status_(status), cause_(cause)
  {
  }
  ExitStatus status() const { return status_; }
  Cause cause() const { return cause_; }

 private:
  ExitStatus status_;
  Cause cause_;
};

/// Runs `work` on this rank and throws the same Error on every rank if it threw on any, that of the lowest such rank.
/// `work` itself must not communicate. Collective.
void collectively(const Communicator& comm, const std::function<void()>& work);

}  // namespace mortise
