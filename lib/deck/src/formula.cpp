#include "deck/formula.hpp"

#include <fmt/format.h>
#include <muParser.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

namespace mortise::deck {

namespace {

// muParser's `=` gives a coordinate another value for the rest of the formula: a slip of the pen.
bool assigns(const std::string& text)
{
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '=') continue;
    const bool before = i > 0 && std::string("=<>!").find(text[i - 1]) != std::string::npos;
    if (!before && (i + 1 == text.size() || text[i + 1] != '=')) return true;
  }
  return false;
}

}  // namespace

struct Formula::Parser {
  std::string text;
  double x = 0, y = 0, z = 0, r = 0, theta = 0, t = 0;
  mu::Parser parser;
  bool varies_in_time;

  explicit Parser(const std::string& formula) : text(formula)
  {
    for (const auto& [name, variable] : {std::pair("x", &x), std::pair("y", &y), std::pair("z", &z), std::pair("r", &r),
                                         std::pair("theta", &theta), std::pair("t", &t)})
      parser.DefineVar(name, variable);
    parser.DefineConst("pi", std::numbers::pi);
    if (assigns(text)) throw mu::ParserError("a formula assigns nothing; == compares");
    parser.SetExpr(text);
    int results = 0;
    parser.Eval(results);
    if (results != 1) throw mu::ParserError("expected one value, found several");
    varies_in_time = parser.GetUsedVar().contains("t");
  }
};

Formula::Formula(const std::string& text)
{
  try {
    parser_ = std::make_shared<Parser>(text);
  } catch (const mu::ParserError& error) {
    throw std::invalid_argument(error.GetMsg());
  }
}

double Formula::operator()(const Point& x, double time) const
{
  if (!parser_) return constant();
  parser_->x = x[0];
  parser_->y = x[1];
  parser_->z = x[2];
  parser_->r = std::hypot(x[0], x[1]);
  parser_->theta = std::atan2(x[1], x[0]);
  parser_->t = time_.value_or(time);
  return factor_ * parser_->parser.Eval();
}

Formula Formula::at(double factor, double time) const
{
  Formula result = *this;
  result.factor_ *= factor;
  if (!time_ && parser_ && parser_->varies_in_time) result.time_ = time;
  return result;
}

bool Formula::operator==(const Formula& other) const
{
  if (is_constant() || other.is_constant()) return is_constant() == other.is_constant() && constant() == other.constant();
  return text() == other.text() && factor_ == other.factor_ && time_ == other.time_;
}

const std::string& Formula::text() const
{
  static const std::string none;
  return parser_ ? parser_->text : none;
}

void Codec<Formula>::read(Formula& value, const YAML::Node& node, const std::string& path, Document& document,
                          const Limits& limits)
{
  double number = 0;
  if (!node.IsScalar() || node.Scalar().empty() || YAML::convert<double>::decode(node, number)) {
    Codec<double>::read(number, node, path, document, limits);
    value = number;
    return;
  }
  try {
    value = Formula(node.Scalar());
  } catch (const std::invalid_argument& error) {
    document.error(
        path, fmt::format("expected a number, or a formula in x, y, z, r, theta, t such as \"10 * (1 - z / 5)\", found {}: {}",
                          found(node), error.what()));
  }
}

YAML::Node Codec<Formula>::write(const Formula& value)
{
  return value.is_constant() ? Codec<double>::write(value.constant()) : YAML::Node(value.text());
}

nlohmann::ordered_json Codec<Formula>::schema(const Limits& limits)
{
  return {{"anyOf", {Codec<double>::schema(limits), {{"type", "string"}}}}};
}

}  // namespace mortise::deck
