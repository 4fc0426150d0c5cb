#include "history.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <thread>

namespace mortise {
namespace {

using std::chrono::milliseconds;

// What the moving line says of an inner iteration, a moment after the first one of the state.
std::string line_of(const deck::OrAuto<double>& tolerance, qp::Progress first, qp::Progress then, milliseconds later)
{
  setenv("MORTISE_TERMINAL", "1", 1);
  std::FILE* out = std::tmpfile();
  {
    const Communicator comm;
    Log log(comm, out);
    Timers timers;
    qp::Options options;
    options.tolerance = tolerance;
    const Context context{comm, log, timers};
    History history(options, context);
    model::LoadState state;
    history.note(state, 1, 0, first);
    std::this_thread::sleep_for(later);
    history.note(state, 1, 0, then);
  }
  std::rewind(out);
  char text[500];
  const std::size_t size = std::fread(text, 1, sizeof text, out);
  std::fclose(out);
  unsetenv("MORTISE_TERMINAL");
  return std::string(text, size);
}

qp::Progress at(double residual, double error, double allowed)
{
  qp::Progress progress{"inner", 2, 17};
  progress.projected_gradient = residual, progress.error = error, progress.allowed_error = allowed;
  return progress;
}

TEST(History, SaysTheResidualAndWhereItHasToCome)
{
  const double unknown = std::numeric_limits<double>::quiet_NaN();
  const auto soon = milliseconds(110);
  EXPECT_NE(
      line_of({1e-4}, at(1, unknown, unknown), at(0.01, unknown, unknown), soon).find("residual 1.0e-02 (tolerance 1.0e-04)"),
      std::string::npos);
  EXPECT_NE(line_of({}, at(1, unknown, unknown), at(0.01, 3, unknown), soon).find("residual 1.0e-02 (tolerance auto)"),
            std::string::npos);
  EXPECT_NE(line_of({}, at(1, unknown, unknown), at(0.01, 3, 0.6), soon).find("residual 1.0e-02 (tolerance auto, about 2.0e-03)"),
            std::string::npos);
  // The error is small enough, contact still moves: there is no residual to wait for.
  EXPECT_NE(line_of({}, at(1, unknown, unknown), at(0.01, 0.3, 0.6), soon).find("(tolerance auto)"), std::string::npos);
}

TEST(History, SaysHowLongItTakes)
{
  // A power of ten in 3.2 s, and two are left.
  const auto line = line_of({}, at(1, 30, 0.3), at(0.1, 3, 0.03), milliseconds(3200));
  EXPECT_NE(line.find("; about 6 s left"), std::string::npos) << line;
}

}  // namespace
}  // namespace mortise
