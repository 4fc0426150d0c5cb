// What this rank sends through MPI, whoever calls: Mortise, Tpetra, HDF5. traffic.cpp defines the calls of MPI that send, counts,
// and goes on to MPI's second name of each (the profiling interface, MPI standard, chapter "Tool Support"); calls from shared
// libraries find these definitions too. Not counted: files, one-sided and persistent communication, which nobody here uses for
// what grows.
#pragma once

namespace mortise {

/// Of one rank. A message to itself counts nothing, nor does a call among one rank.
struct Traffic {
  long long messages = 0;     ///< point to point, sent
  long long bytes = 0;        ///< in them
  long long collectives = 0;  ///< calls
  /// In these calls: of each the larger of what the rank hands in and what it gets, whatever MPI makes of it.
  long long collective_bytes = 0;

  Traffic& operator+=(const Traffic& other);
  Traffic& operator-=(const Traffic& other);
};
inline Traffic operator-(Traffic a, const Traffic& b)
{
  return a -= b;
}

/// What this rank has sent since the start of the program.
Traffic traffic();

}  // namespace mortise
