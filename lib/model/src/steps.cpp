#include "model/steps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "model/deck.hpp"

namespace mortise::model {

namespace {

// Of all steps.
constexpr int most_states = 10000;

template <class T>
void add_names(const std::vector<T>& list, std::vector<std::string>& names)
{
  for (const auto& item : list) names.push_back(item.name);
}

bool named(const std::vector<std::string>& list, const std::string& name)
{
  return std::find(list.begin(), list.end(), name) != list.end();
}

template <class T>
std::vector<std::string> names_of(const std::vector<T>& list)
{
  std::vector<std::string> names;
  add_names(list, names);
  return names;
}

// Of each contact the name that the deck gives its entry.
std::vector<std::string> names_of_contacts(const Deck& deck, const Contacts& contacts)
{
  std::vector<std::string> names;
  for (const std::size_t entry : contacts.entry) names.push_back(deck.contacts[entry].name);
  return names;
}

// Factors at the end of a step.
void scale(const std::vector<std::string>& names, const StepOptions& step, std::vector<double>& factors)
{
  for (std::size_t i = 0; i < names.size(); ++i)
    if (const auto found = step.scale.find(names[i]); found != step.scale.end()) factors[i] = found->second;
}

template <class T>
void toggle(const std::vector<T>& list, const StepOptions& step, std::vector<bool>& acts)
{
  for (std::size_t i = 0; i < list.size(); ++i) {
    if (named(step.off, list[i].name)) acts[i] = false;
    if (named(step.on, list[i].name)) acts[i] = true;
  }
}

// What acts at the end of a step.
struct Factors {
  std::vector<double> load, support, contact;
  std::vector<bool> loaded, acting;

  std::vector<double> acting_load() const
  {
    auto result = load;
    for (std::size_t i = 0; i < result.size(); ++i)
      if (!loaded[i]) result[i] = 0;
    return result;
  }
};

// Part of the way from one list of factors to the next.
std::vector<double> between(const std::vector<double>& from, const std::vector<double>& to, double part)
{
  std::vector<double> result(to.size());
  for (std::size_t i = 0; i < to.size(); ++i) result[i] = part < 1 ? from[i] + part * (to[i] - from[i]) : to[i];
  return result;
}

bool holds_time(const std::optional<deck::Formula>& formula)
{
  return formula && !(formula->at(1, 0) == formula->at(1, 1));
}

bool holds_time(const fem::LoadOptions& load)
{
  const auto in_time = [](const auto& formula) { return holds_time(std::optional(formula)); };
  return holds_time(load.pressure) || (load.traction && std::any_of(load.traction->begin(), load.traction->end(), in_time)) ||
         (load.temperature_change && in_time(load.temperature_change->formula));
}

bool holds_time(const constraint::SupportOptions& support)
{
  return holds_time(support.normal) || std::any_of(support.displacement.begin(), support.displacement.end(),
                                                   [](const auto& formula) { return holds_time(formula); });
}

// Factors before the first step, which comes from nothing: but formulas that hold t rise by themselves.
template <class T>
std::vector<double> at_first(const std::vector<T>& list, const std::vector<double>& of_first_step)
{
  std::vector<double> result(list.size(), 0.0);
  for (std::size_t i = 0; i < list.size(); ++i)
    if (holds_time(list[i])) result[i] = of_first_step[i];
  return result;
}

}  // namespace

void describe(deck::Description<StepOptions>& d)
{
  d.help(
      "One load step. What it does not name stays as the step before left it. Loads, displacements and overlaps come from 0 in "
      "the "
      "first step, and are whole at its end where no factor is named; those whose formulas hold t follow their formula from the "
      "start.");
  d.key("name", &StepOptions::name, "For results; its number if not given.");
  d.key("scale", &StepOptions::scale,
        "Factors, reached at the end of the step, of loads, of the displacements of supports and of the interference or preload "
        "of contacts, by their names. After the first step a preloaded bolt keeps its length but where a step names it here.");
  d.key("off", &StepOptions::off,
        "Names of loads and supports that cease to act: supports at once, loads little by little over the increments of the step.");
  d.key("on", &StepOptions::on, "Names of loads and supports that act again.");
  d.key("increments", &StepOptions::increments, "Equilibria on the way, between which the factors change linearly.")
      .at_least(1)
      .below(most_states + 1);
}

namespace {

// What a step calls by one name.
struct Called {
  bool load = false, support = false, contact = false;
  bool has_factor = false;  // of what can be scaled

  int kinds() const { return load + support + contact; }
};

Called called(const Deck& deck, const std::string& name)
{
  Called result;
  for (const auto& load : deck.loads)
    if (load.name == name) result.load = result.has_factor = true;
  for (const auto& support : deck.supports)
    if (support.name == name) {
      result.support = true;
      if (!support.stiffness.any()) result.has_factor = true;
    }
  for (const auto& contact : deck.contacts)
    if (contact.name == name) {
      result.contact = true;
      if (contact.preload || contact.interference != 0) result.has_factor = true;
    }
  return result;
}

// Names that mean two things, or nothing that a factor has an effect on.
void check_names_of_step(const Deck& deck, const StepOptions& step, const std::string& path, deck::Document& document)
{
  const auto check = [&](const std::string& name, const std::string& at) {
    if (called(deck, name).kinds() > 1)
      document.error(
          at, fmt::format("\"{}\" is the name of a load, a support or a contact at once; give each a `name` of its own", name));
  };
  for (const auto& [name, factor] : step.scale) {
    check(name, path + "scale." + name);
    if (const auto meant = called(deck, name); meant.kinds() == 1 && !meant.has_factor)
      document.error(path + "scale." + name, meant.contact
                                                 ? "this contact has neither interference nor preload, which a factor could scale"
                                                 : "this support has stiffness and no displacement, which a factor could scale");
  }
  for (const auto& [key, names] : {std::pair("off", &step.off), std::pair("on", &step.on)})
    for (const auto& name : *names) check(name, path + key);
}

}  // namespace

void check_steps(const Deck& deck, deck::Document& document)
{
  const double states = std::accumulate(deck.steps.begin(), deck.steps.end(), 0.0,
                                        [](double sum, const StepOptions& step) { return sum + step.increments; });
  if (states > most_states)
    document.error("steps",
                   fmt::format("ask for {:.10g} equilibria, each of which is solved and written; at most {} are possible: "
                               "take fewer `increments`",
                               states, most_states));
  std::vector<std::string> switched;
  add_names(deck.loads, switched);
  add_names(deck.supports, switched);
  auto scaled = switched;
  add_names(deck.contacts, scaled);
  for (std::size_t s = 0; s < deck.steps.size(); ++s) {
    const auto& step = deck.steps[s];
    const auto path = fmt::format("steps[{}].", s);
    for (const auto& [name, factor] : step.scale)
      if (!named(scaled, name))
        document.error(path + "scale." + name,
                       "there is no load, support or contact of that name" + deck::suggestion(name, scaled));
    for (const auto& [key, names] : {std::pair("off", &step.off), std::pair("on", &step.on)})
      for (const auto& name : *names)
        if (!named(switched, name))
          document.error(path + key, fmt::format("there is no load or support \"{}\"{}", name, deck::suggestion(name, switched)));
    check_names_of_step(deck, step, path, document);
    for (const auto& name : step.on)
      if (named(step.off, name)) document.error(path + "on", fmt::format("\"{}\" is switched on and off in one step", name));
  }
}

std::vector<LoadState> load_states(const Deck& deck, const Contacts& on_mesh)
{
  Factors now{std::vector<double>(deck.loads.size(), 1.0), std::vector<double>(deck.supports.size(), 1.0),
              std::vector<double>(on_mesh.size(), 1.0), std::vector<bool>(deck.loads.size(), true),
              std::vector<bool>(deck.supports.size(), true)};
  const std::vector<bool> none(on_mesh.size(), false);
  if (deck.steps.empty()) return {{"", 1, now.load, now.support, now.contact, now.acting, none}};
  const auto loads = names_of(deck.loads), supports = names_of(deck.supports), contacts = names_of_contacts(deck, on_mesh);
  std::vector<LoadState> states;
  std::vector<double> load, support, contact(on_mesh.size(), 0.0);
  for (std::size_t s = 0; s < deck.steps.size(); ++s) {
    const auto& step = deck.steps[s];
    scale(loads, step, now.load);
    scale(supports, step, now.support);
    scale(contacts, step, now.contact);
    toggle(deck.loads, step, now.loaded);
    toggle(deck.supports, step, now.acting);
    const auto acting = now.acting_load();
    if (s == 0) {
      load = at_first(deck.loads, acting);
      support = at_first(deck.supports, now.support);
    }
    std::vector<bool> locked;
    for (const auto& name : contacts) locked.push_back(s > 0 && !step.scale.contains(name));
    for (int i = 1; i <= step.increments; ++i) {
      const double part = static_cast<double>(i) / step.increments;
      states.push_back({step.name.empty() ? std::to_string(s + 1) : step.name, static_cast<double>(s) + part,
                        between(load, acting, part), between(support, now.support, part), between(contact, now.contact, part),
                        now.acting, locked});
    }
    load = acting;
    support = now.support;
    contact = now.contact;
  }
  return states;
}

}  // namespace mortise::model
