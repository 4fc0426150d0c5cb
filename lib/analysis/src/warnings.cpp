#include "analysis/warnings.hpp"

#include <utility>

namespace mortise::analysis {

void Warnings::add(Warning warning)
{
  for (auto& known : all_) {
    if (known.kind != warning.kind || known.body != warning.body || known.boundary != warning.boundary ||
        known.contact != warning.contact)
      continue;
    if (warning.value > known.value) known = std::move(warning);
    return;
  }
  all_.push_back(std::move(warning));
}

void Warnings::report(Warning warning, Log& log)
{
  log.warning("{}; {}", warning.text, warning.cure);
  add(std::move(warning));
}

}  // namespace mortise::analysis
