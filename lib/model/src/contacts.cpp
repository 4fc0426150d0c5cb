// What contacts make on the mesh: pairs of surfaces, laws of friction, preloads.
#include <map>
#include <memory>

#include "contact/cyclic.hpp"
#include "model/model.hpp"

namespace mortise::model {

std::vector<contact::Pair> Model::contact_pairs(const LoadState& state) const
{
  std::vector<contact::Pair> pairs;
  const auto surface = [&](const std::string& name) {
    const auto [boundary, on_body] = select(name);
    return partition::boundary_surface(decomposition_, boundary, on_body);
  };
  std::map<std::string, std::shared_ptr<const mesh::Surface>> primaries;  // the ring of many rollers stands here once
  for (std::size_t c = 0; c < contacts_.size(); ++c) {
    const auto& contact = contacts_[c];
    pairs.push_back({contact, surface(contact.secondary), nullptr});
    pairs.back().options.interference *= state.contact[c];
    if (contact.obstacle) continue;
    if (contact.cyclic) {
      pairs.back().primary = std::make_shared<const mesh::Surface>(contact::rotated(surface(contact.primary), contact));
      continue;
    }
    auto& primary = primaries[contact.primary];
    if (!primary) primary = std::make_shared<const mesh::Surface>(surface(contact.primary));
    pairs.back().primary = primary;
  }
  return pairs;
}

std::vector<friction::Law> friction_laws(const Contacts& contacts)
{
  std::vector<friction::Law> laws;
  for (const auto& contact : contacts.options) laws.push_back(friction::law_of(contact::name_of(contact.law), contact.friction));
  return laws;
}

std::vector<constraint::Preload> preloads(const Contacts& contacts, const LoadState& state,
                                          const std::vector<double>& shortenings)
{
  std::vector<constraint::Preload> preloads;
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    const auto& options = contacts[c].preload;
    if (!options) continue;
    constraint::Preload preload{static_cast<int>(c), contacts[c].name, {}, 0};
    if (state.locked[c])
      preload.shortening = shortenings[preloads.size()];
    else if (options->force)
      preload.force = state.contact[c] * *options->force;
    else
      preload.shortening = state.contact[c] * options->shortening.value_or(0);
    preloads.push_back(std::move(preload));
  }
  return preloads;
}

}  // namespace mortise::model
