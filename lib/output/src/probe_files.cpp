#include "output/probe_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "base/error.hpp"
#include "csv.hpp"
#include "fem/quantity.hpp"
#include "io/files.hpp"

namespace mortise::output {

namespace {

using Probe = io::StateSummary::Probe;

constexpr const char* columns_at_point[] = {"ux",  "uy",  "uz",        "sxx",         "syy",         "szz",        "sxy",
                                            "syz", "sxz", "von_mises", "principal_1", "principal_2", "principal_3"};
constexpr std::size_t width = std::size(columns_at_point);

// A point of a probe in a body; plain bytes.
struct Sample {
  Global row;
  std::size_t point;  // among all points of all probes
  int body;
  std::array<double, width> values;
};

// Of each point of all probes the axes that its components are along.
std::vector<std::optional<deck::LocalAxes>> axes_of_points(const model::Deck& deck)
{
  std::vector<std::optional<deck::LocalAxes>> result;
  for (const auto& [name, probe] : deck.output.probes)
    result.insert(result.end(), probe.points().size(),
                  probe.axes.empty() ? std::nullopt : std::optional(model::local_axes(deck, probe.axes)));
  return result;
}

// Those of all ranks, by their rows. Collective.
std::vector<Sample> gather_samples(const model::Deck& deck, const post::Probes& probes, const post::Values& values,
                                   const Communicator& comm)
{
  const auto axes = axes_of_points(deck);
  std::vector<Sample> mine;
  for (std::size_t i = 0; i < probes.sampled.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    const fem::Stress stress = values.stress.row(row).transpose();
    auto& sample = mine.emplace_back(Sample{probes.sampled[i].row, probes.sampled[i].point, probes.sampled[i].body, {}});
    Eigen::Map<Eigen::Matrix<double, width, 1>> all(sample.values.data());
    const auto& own = axes[probes.sampled[i].point];
    const Eigen::Matrix3d rotation = own ? own->everywhere(probes.sampled[i].place.at) : Eigen::Matrix3d::Identity();
    all << rotation * values.displacement.row(row).transpose(), own ? fem::along(rotation, stress) : stress,
        fem::von_mises(stress), fem::principal_stresses(stress);
  }
  auto all = comm.all_gather(mine);
  std::sort(all.begin(), all.end(), [](const Sample& a, const Sample& b) { return a.row < b.row; });
  return all;
}

double length(const io::ProbeOptions& path)
{
  const auto &a = *path.from, &b = *path.to;
  return std::hypot(b[0] - a[0], b[1] - a[1], b[2] - a[2]);
}

// Columns of probes.csv and their entries; of a point in several bodies the names say which.
std::vector<std::pair<std::string, std::string>> entries(const std::vector<Probe>& summaries)
{
  std::vector<std::pair<std::string, std::string>> result;
  const auto number = [](double x) { return fmt::format("{}", x); };
  for (const auto& probe : summaries) {
    if (probe.path) continue;
    if (!probe.at_point) {
      result.emplace_back(probe.name, number(probe.value));
      for (std::size_t c = 0; c < 3; ++c) result.emplace_back(probe.name + "." + "xyz"[c], number(probe.place.coordinates[c]));
      result.emplace_back(probe.name + ".body", quoted(probe.place.body));
      continue;
    }
    const auto same = std::count_if(summaries.begin(), summaries.end(), [&](const Probe& p) { return p.name == probe.name; });
    const auto& s = *probe.at_point;
    std::vector<double> values(s.displacement.begin(), s.displacement.end());
    values.insert(values.end(), s.stress.begin(), s.stress.end());
    values.push_back(s.von_mises);
    values.insert(values.end(), s.principal_stress.begin(), s.principal_stress.end());
    for (std::size_t i = 0; i < width; ++i)
      result.emplace_back(quoted(probe.name + "." + (same > 1 ? probe.place.body + "." : "") + columns_at_point[i]),
                          number(values[i]));
  }
  return result;
}

// Where a path leaves a body for another the row of the one that it leaves comes first.
void follow_bodies(std::vector<Sample>& samples)
{
  int last = -1;
  for (auto first = samples.begin(); first != samples.end();) {
    const auto end = std::find_if(first, samples.end(), [&](const Sample& s) { return s.point != first->point; });
    const auto same = std::find_if(first, end, [&](const Sample& s) { return s.body == last; });
    if (same != end) std::rotate(first, same, same + 1);
    last = (end - 1)->body;
    first = end;
  }
}

// The rows of a path in one state. `samples`: its own, their points counted from its first one.
std::string path_rows(const io::ProbeOptions& path, const mesh::Catalogue& catalogue, const model::LoadState& acts,
                      std::vector<Sample> samples)
{
  follow_bodies(samples);
  std::string text;
  const auto points = path.points();
  auto sample = samples.begin();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double s = length(path) * static_cast<double>(i) / static_cast<double>(points.size() - 1);
    const auto place = fmt::format("{}{},{},", entries_of_state(acts), s, fmt::join(points[i], ","));
    if (sample == samples.end() || sample->point != i) text += place + std::string(width, ',') + "\n";
    for (; sample != samples.end() && sample->point == i; ++sample)
      text += fmt::format("{}{},{}\n", place, quoted(catalogue.bodies[static_cast<std::size_t>(sample->body)].name),
                          fmt::join(sample->values, ","));
  }
  return text;
}

}  // namespace

std::vector<Probe> probe_summaries(const model::Deck& deck, const mesh::Catalogue& catalogue, const post::Probes& probes,
                                   const post::Fields& fields, const Communicator& comm)
{
  std::vector<Probe> summaries;
  if (deck.output.probes.empty()) return summaries;
  const auto samples = gather_samples(deck, probes, fields.interior.sampled, comm);
  const auto body_name = [&](int body) {
    return body < 0 ? std::string() : catalogue.bodies[static_cast<std::size_t>(body)].name;
  };
  auto extreme = fields.extremes.begin();
  std::size_t first = 0;  // point of the probe
  for (const auto& [name, probe] : deck.output.probes) {
    Probe entry;
    entry.name = name;
    entry.largest = probe.largest;
    entry.smallest = probe.smallest;
    entry.axes = probe.axes;
    const auto points = probe.points();
    if (probe.is_extreme()) {
      entry.value = extreme->value;
      entry.place = {{extreme->at[0], extreme->at[1], extreme->at[2]}, body_name(extreme->body)};
      ++extreme;
      summaries.push_back(std::move(entry));
    } else if (probe.is_path()) {
      entry.path = Probe::Path{fmt::format("probe.{}.csv", name), static_cast<int>(points.size()), length(probe)};
      summaries.push_back(std::move(entry));
    } else {
      for (const auto& sample : samples) {
        if (sample.point != first) continue;
        const auto& v = sample.values;
        entry.place = {points.front(), body_name(sample.body)};
        entry.at_point = Probe::State{{v[0], v[1], v[2]}, {v[10], v[11], v[12]}, {v[3], v[4], v[5], v[6], v[7], v[8]}, v[9]};
        summaries.push_back(entry);
      }
    }
    first += points.size();
  }
  return summaries;
}

void ProbeFiles::write(const mesh::Catalogue& catalogue, const model::LoadState& acts, const post::Probes& probes,
                       const post::Values& sampled, const std::vector<Probe>& summaries, const Communicator& comm)
{
  if (deck_.output.probes.empty()) return;
  const auto samples = gather_samples(deck_, probes, sampled, comm);
  add_row(acts, summaries);
  std::size_t first = 0;  // point of the probe
  for (const auto& [name, probe] : deck_.output.probes) {
    const auto end = first + probe.points().size();
    if (probe.is_path()) {
      std::vector<Sample> own;
      std::copy_if(samples.begin(), samples.end(), std::back_inserter(own),
                   [&](const Sample& s) { return s.point >= first && s.point < end; });
      for (auto& sample : own) sample.point -= first;
      auto& text = paths_[name];
      if (text.empty()) text = fmt::format("{}s,x,y,z,body,{}\n", header_of_states(deck_), fmt::join(columns_at_point, ","));
      text += path_rows(probe, catalogue, acts, std::move(own));
    }
    first = end;
  }
  collectively(comm, [&] {
    if (!comm.root()) return;
    if (!table_.empty()) io::write_text(deck_.output.directory + "/probes.csv", table_);
    for (const auto& [name, text] : paths_) io::write_text(fmt::format("{}/probe.{}.csv", deck_.output.directory, name), text);
  });
}

// Of probes.csv, and its header before the first one.
void ProbeFiles::add_row(const model::LoadState& acts, const std::vector<Probe>& summaries)
{
  const auto scalars = entries(summaries);
  if (scalars.empty()) return;
  const auto line = [&](std::string text, auto member) {
    for (const auto& entry : scalars) text += entry.*member + ",";
    text.back() = '\n';
    return text;
  };
  using Entry = std::pair<std::string, std::string>;
  if (table_.empty()) table_ = line(header_of_states(deck_), &Entry::first);
  table_ += line(entries_of_state(acts), &Entry::second);
}

}  // namespace mortise::output
