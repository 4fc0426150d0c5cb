// How often the states of contact nodes changed of late.
#pragma once

#include <deque>
#include <vector>

namespace mortise::feti {

enum class ContactStatus : char { open, closed, sticks, slips };  ///< closed: of a point without friction

class StateRecord {
 public:
  static constexpr int kept = 12;  ///< steps

  /// The states of all points after a step, as many as before, or it begins anew. Returns how many differ from those before.
  long long note(std::vector<ContactStatus> states);

  int steps() const { return static_cast<int>(steps_.size()) - 1; }  ///< from one note to the next
  struct Changes {
    int contact = 0, friction = 0;  ///< changes between open and not open, and between sticking and slipping
  };
  /// Of every point, over the steps that are kept.
  std::vector<Changes> changes() const;

 private:
  std::deque<std::vector<ContactStatus>> steps_;
};

}  // namespace mortise::feti
