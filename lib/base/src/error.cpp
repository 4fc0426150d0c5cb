#include "base/error.hpp"

#include <new>

namespace mortise {

void collectively(const Communicator& comm, const std::function<void()>& work)
{
  long long failed = comm.size();
  std::string message;
  auto status = ExitStatus::machine;
  auto cause = Error::Cause::other;
  try {
    work();
  } catch (const Error& error) {
    failed = comm.rank(), message = error.what(), status = error.status(), cause = error.cause();
  } catch (const std::bad_alloc&) {
    failed = comm.rank(), message = "out of memory", cause = Error::Cause::memory;
  } catch (const std::exception& error) {
    failed = comm.rank(), message = error.what();
  }
  const auto first = static_cast<int>(comm.min(failed));
  if (first == comm.size()) return;
  comm.broadcast(message, first);
  std::vector<int> code{static_cast<int>(status), static_cast<int>(cause)};
  comm.broadcast(code, first);
  throw Error(static_cast<ExitStatus>(code[0]), message, static_cast<Error::Cause>(code[1]));
}

}  // namespace mortise
