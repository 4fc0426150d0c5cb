#include "io/nodal_field.hpp"

#include <fmt/format.h>
#include <vtkCellData.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkStaticPointLocator.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLUnstructuredGridReader.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <optional>

#include "base/dense.hpp"
#include "base/error.hpp"
#include "io/cell_field.hpp"
#include "words.hpp"

namespace mortise::io {

// What a file holds.
struct NodalField::Content : CellArrays {  // without cells: loose points
  std::string name;
};

namespace {

using Content = NodalField::Content;

constexpr const char* usual_name = "temperature";
constexpr std::size_t longest_row = 10'000;
constexpr double half_a_cell = 0.5;  // diagonals of the nearest cell that a place may lie beside it
constexpr double covered = 0.1;  // of a cell, or of what the nearest points span: two meshes of a curved surface are so far apart
constexpr double same_place = 1e-9;  // of the distance of the points around
constexpr double degenerate = 1e-6;  // eigenvalues below this part of the largest: the points lie in a plane or on a line

[[noreturn]] void fail(const std::string& text)
{
  throw Error(ExitStatus::bad_input, text);
}

std::string lower(std::string text)
{
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

std::string listed(const std::vector<std::string>& names)
{
  return names.empty() ? "none" : fmt::format("\"{}\"", fmt::join(names, "\", \""));
}

// Which of `names` is meant.
std::size_t choose(const std::vector<std::string>& names, const std::string& wanted, const std::string& path, const char* what)
{
  const auto found = wanted.empty()
                         ? std::find_if(names.begin(), names.end(), [](const auto& n) { return lower(n) == usual_name; })
                         : std::find(names.begin(), names.end(), wanted);
  if (found != names.end()) return static_cast<std::size_t>(found - names.begin());
  if (wanted.empty() && names.size() == 1) return 0;
  if (!wanted.empty()) fail(fmt::format("{}: has no {} \"{}\"; it has {}", path, what, wanted, listed(names)));
  fail(fmt::format("{}: has no {} \"{}\"; say with `field` which one is meant: {}", path, what, usual_name, listed(names)));
}

void require_file(const std::string& path)
{
  std::ifstream stream(path);
  if (!stream || std::filesystem::is_directory(path))
    fail(fmt::format("{} cannot be read{}", path, stream ? "" : std::string(": ") + std::strerror(errno)));
}

Content read_vtu(const std::string& path, const std::string& name)
{
  vtkNew<vtkXMLUnstructuredGridReader> reader;
  if (!reader->CanReadFile(path.c_str())) fail(path + ": is no .vtu file of unstructured cells");
  reader->SetFileName(path.c_str());
  reader->GlobalWarningDisplayOff();
  reader->Update();
  auto* grid = reader->GetOutput();
  if (reader->GetErrorCode() != 0 || !grid || grid->GetNumberOfPoints() == 0 || grid->GetNumberOfCells() == 0)
    fail(path +
         ": holds no cells that can be read; data that are appended VTK cannot read beside a new expat: save the file as ASCII "
         "or binary");
  auto* data = grid->GetPointData();
  std::vector<std::string> names;
  for (int a = 0; a < data->GetNumberOfArrays(); ++a)
    if (auto* array = data->GetArray(a); array && array->GetNumberOfComponents() == 1 && array->GetName())
      names.emplace_back(array->GetName());
  auto* of_cells = grid->GetCellData();
  if (!name.empty() && of_cells->HasArray(name.c_str()) && !data->HasArray(name.c_str()))
    fail(fmt::format("{}: \"{}\" is a field of cells; values at points are needed (in ParaView: Cell Data to Point Data)", path,
                     name));
  Content content;
  content.name = names.empty() ? "" : names[choose(names, name, path, "field of points with one component")];
  if (names.empty()) choose(names, name, path, "field of points with one component");
  auto* array = data->GetArray(content.name.c_str());
  const vtkIdType count = grid->GetNumberOfPoints();
  if (array->GetNumberOfTuples() != count) fail(path + ": has not as many values as points");
  for (vtkIdType p = 0; p < count; ++p) {
    const double* x = grid->GetPoint(p);
    content.points.insert(content.points.end(), x, x + 3);
    content.values.push_back(array->GetTuple1(p));
  }
  vtkNew<vtkIdList> nodes;
  content.offsets.push_back(0);
  for (vtkIdType c = 0; c < grid->GetNumberOfCells(); ++c) {
    grid->GetCellPoints(c, nodes);
    for (vtkIdType i = 0; i < nodes->GetNumberOfIds(); ++i) {
      const vtkIdType n = nodes->GetId(i);
      if (n < 0 || n >= count) fail(fmt::format("{}: cell {} has a point that is not there", path, c));
      content.connectivity.push_back(n);
    }
    content.offsets.push_back(static_cast<long long>(content.connectivity.size()));
    content.types.push_back(static_cast<unsigned char>(grid->GetCellType(c)));
  }
  return content;
}

// Which coordinate a column is, -1: none.
int coordinate(const std::string& name)
{
  const auto text = lower(name);
  for (int c = 0; c < 3; ++c)
    for (const auto& spelt : {std::string(1, "xyz"[c]), fmt::format("points:{}", c), fmt::format("points_{}", c)})
      if (text == spelt) return c;
  return -1;
}

Content read_csv(const std::string& path, const std::string& name, int dimension)
{
  std::ifstream stream(path);
  std::string line;
  std::array<int, 3> column{-1, -1, -1};
  std::size_t columns = 0, value_column = 0;
  Content content;
  for (int number = 1; std::getline(stream, line); ++number) {
    if (line.size() > longest_row) fail(fmt::format("{}:{}: the line is too long", path, number));
    const bool by_marks = line.find_first_of(",;") != std::string::npos;
    auto parts = words(line, by_marks ? ",;\r" : " \t\r");
    for (auto& part : parts) {
      const auto begin = part.find_first_not_of(" \t\""), end = part.find_last_not_of(" \t\"");
      part = begin == std::string::npos ? "" : part.substr(begin, end - begin + 1);
    }
    if (parts.empty()) continue;
    if (columns == 0) {
      columns = parts.size();
      std::vector<std::string> others;
      std::vector<std::size_t> place;
      for (std::size_t i = 0; i < columns; ++i) {
        if (const int c = coordinate(parts[i]); c >= 0)
          column[static_cast<std::size_t>(c)] = static_cast<int>(i);
        else
          others.push_back(parts[i]), place.push_back(i);
      }
      for (int c = 0; c < dimension; ++c)
        if (column[static_cast<std::size_t>(c)] < 0)
          fail(fmt::format("{}:{}: expected a line of names with x, y{} and the field among them, found \"{}\"", path, number,
                           dimension == 3 ? ", z" : "", line.substr(0, 60)));
      const auto chosen = choose(others, name, path, "column");
      value_column = place[chosen];
      content.name = others[chosen];
      continue;
    }
    double value = 0;
    Point at = Point::Zero();
    bool fits = parts.size() == columns && is_number(parts[value_column], value);
    for (std::size_t c = 0; fits && c < static_cast<std::size_t>(dimension); ++c)
      fits = is_number(parts[static_cast<std::size_t>(column[c])], at[static_cast<Eigen::Index>(c)]);
    if (!fits)
      fail(fmt::format("{}:{}: expected {} values with numbers as coordinates and for \"{}\", found \"{}\"", path, number,
                       columns, content.name, line.substr(0, 60)));
    content.points.insert(content.points.end(), at.data(), at.data() + 3);
    content.values.push_back(value);
  }
  if (content.values.empty()) fail(path + ": holds no points; expected a line of names and then one a line");
  if (content.values.size() == 1)
    fail(path + ": holds one point alone, which says nothing of those around it; a change that is the same all over is a number");
  return content;
}

Content read(const std::string& path, const std::string& name, int dimension)
{
  require_file(path);
  const auto kind = lower(std::filesystem::path(path).extension().string());
  if (kind != ".vtu" && kind != ".csv") fail(fmt::format("{}: expected a .vtu or a .csv file", path));
  auto content = kind == ".vtu" ? read_vtu(path, name) : read_csv(path, name, dimension);
  for (std::size_t i = 0; i < content.values.size(); ++i) {
    const double* x = &content.points[3 * i];
    if (!std::isfinite(content.values[i]) || std::any_of(x, x + 3, [](double c) { return !(std::abs(c) <= largest_number); }))
      fail(fmt::format("{}: the value of \"{}\" at ({:.6g}, {:.6g}, {:.6g}) is no number", path, content.name, x[0], x[1], x[2]));
  }
  return content;
}

}  // namespace

struct NodalField::Source {
  std::string path, name;
  std::size_t size = 0;
  int dimension = 3;
  std::optional<CellField> cells;
  // Else loose points.
  std::vector<double> places, values;
  Point lowest = Point::Zero(), highest = Point::Zero();  // corners of the box round them
  vtkNew<vtkPolyData> cloud;
  vtkNew<vtkStaticPointLocator> points;
  vtkNew<vtkIdList> near;

  void prepare(Content content);
  double in_cells(const Point& x) const;
  double among_points(const Point& x);
  double outside(const Point& x);
  double span_round(const Point& x);
  int neighbours() const { return std::min(dimension == 3 ? 24 : 12, static_cast<int>(size)); }
  Point point(vtkIdType p) const { return Eigen::Map<const Point>(&places[3 * static_cast<std::size_t>(p)]); }
  [[noreturn]] void too_far(const Point& x, double distance, double most) const;
};

void NodalField::Source::too_far(const Point& x, double distance, double most) const
{
  fail(fmt::format(
      "({:.6g}, {:.6g}, {:.6g}) lies {:.3g} away from {} of {}, where up to {:.3g} would do; the file has to cover the "
      "whole body, in its units of length",
      x[0], x[1], x[2], distance, cells ? "the cells" : "the points", path, most));
}

void NodalField::Source::prepare(Content content)
{
  name = content.name;
  size = content.values.size();
  if (!content.types.empty()) {
    cells.emplace(std::move(content));
    return;
  }
  places = std::move(content.points);
  values = std::move(content.values);
  vtkNew<vtkPoints> at;
  at->SetDataTypeToDouble();
  at->SetNumberOfPoints(static_cast<vtkIdType>(size));
  for (std::size_t p = 0; p < size; ++p) at->SetPoint(static_cast<vtkIdType>(p), &places[3 * p]);
  const Eigen::Map<const Eigen::Matrix3Xd> all(places.data(), 3, static_cast<Eigen::Index>(size));
  lowest = all.rowwise().minCoeff();
  highest = all.rowwise().maxCoeff();
  cloud->SetPoints(at);
  points->SetDataSet(cloud);
  points->BuildLocator();
}

double NodalField::Source::in_cells(const Point& x) const
{
  const auto found = cells->nearest(x);
  if (found.distance > half_a_cell * found.size) too_far(x, found.distance, half_a_cell * found.size);
  return found.value;
}

// How far the neighbours of the point nearest to x are from it.
double NodalField::Source::span_round(const Point& x)
{
  const Point at = point(points->FindClosestPoint(x.data()));
  points->FindClosestNPoints(neighbours(), at.data(), near);
  double result = 0;
  for (vtkIdType i = 0; i < near->GetNumberOfIds(); ++i) result = std::max(result, (point(near->GetId(i)) - at).norm());
  return result;
}

double NodalField::Source::outside(const Point& x)
{
  if (cells) {
    const auto found = cells->nearest(x);
    return found.distance > covered * found.size ? found.distance : 0;
  }
  const double beside = (x - x.cwiseMax(lowest).cwiseMin(highest)).norm();
  return beside > 0 && beside > covered * span_round(x) ? beside : 0;
}

double NodalField::Source::among_points(const Point& x)
{
  points->FindClosestNPoints(neighbours(), x.data(), near);
  const vtkIdType count = near->GetNumberOfIds();
  const vtkIdType closest = near->GetId(0);
  const double distance = (point(closest) - x).norm();
  double farthest = 0;
  for (vtkIdType i = 0; i < count; ++i) farthest = std::max(farthest, (point(near->GetId(i)) - x).norm());
  if (distance <= same_place * farthest) return values[static_cast<std::size_t>(closest)];
  // Weighted means, and the slopes about them.
  double sum = 0, mean = 0;
  Point centre = Point::Zero();
  std::vector<double> weight(static_cast<std::size_t>(count));
  for (vtkIdType i = 0; i < count; ++i) {
    const auto p = near->GetId(i);
    const double d = (point(p) - x).norm(), fade = 1 - d / (1.001 * farthest);
    const double w = weight[static_cast<std::size_t>(i)] = fade * fade / (d * d);
    sum += w;
    mean += w * values[static_cast<std::size_t>(p)];
    centre += w * point(p);
  }
  mean /= sum;
  centre /= sum;
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  Point moment = Point::Zero();
  for (vtkIdType i = 0; i < count; ++i) {
    const auto p = near->GetId(i);
    const Point arm = point(p) - centre;
    const double w = weight[static_cast<std::size_t>(i)] / sum;
    spread += w * arm * arm.transpose();
    moment += w * (values[static_cast<std::size_t>(p)] - mean) * arm;
  }
  const auto modes = dense::space_eigenpairs(spread);
  Point slope = Point::Zero();
  for (Eigen::Index m = 0; m < 3; ++m)
    if (const double size = modes.values[m]; size > degenerate * modes.values[2])
      slope += modes.vectors.col(m).dot(moment) / size * modes.vectors.col(m);
  // Farther away than the points around the closest one are from it, they tell nothing.
  if (const double around = span_round(x); distance > around) too_far(x, distance, around);
  return mean + slope.dot(x - centre);
}

NodalField::NodalField(const std::string& path, const std::string& name, int dimension, const Communicator& comm)
    : source_(std::make_shared<Source>())
{
  source_->path = path;
  source_->dimension = dimension;
  Content content;
  collectively(comm, [&] {
    if (comm.root()) content = read(path, name, dimension);
  });
  comm.broadcast(content.name);
  comm.broadcast(content.points);
  comm.broadcast(content.values);
  comm.broadcast(content.offsets);
  comm.broadcast(content.connectivity);
  comm.broadcast(content.types);
  source_->prepare(std::move(content));
}

double NodalField::operator()(const Point& x) const
{
  return source_->cells ? source_->in_cells(x) : source_->among_points(x);
}

double NodalField::outside(const Point& x) const
{
  return source_->outside(x);
}

std::size_t NodalField::size() const
{
  return source_->size;
}

const std::string& NodalField::name() const
{
  return source_->name;
}

const std::string& NodalField::path() const
{
  return source_->path;
}

}  // namespace mortise::io
