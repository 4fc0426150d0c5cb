// Values that vary in space and time: a number, or a formula in x, y, z, r, theta, t as muParser reads it.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "base/types.hpp"
#include "deck/codec.hpp"

namespace mortise::deck {

/// r and theta are the polar coordinates of x and y, theta in radians from -pi to pi; t is the time of the load step. Copies are
/// cheap.
class Formula {
 public:
  Formula(double constant = 0) : constant_(constant) {}  // NOLINT: a number is a formula
  /// Throws std::invalid_argument that says what is wrong and where.
  explicit Formula(const std::string& text);

  /// The value at a place and a time. May be infinite or no number, as 1 / x at 0.
  double operator()(const Point& x, double time) const;
  /// This formula times `factor` at `time`, whatever time the result is called with.
  Formula at(double factor, double time) const;
  bool is_constant() const { return parser_ == nullptr; }
  /// The value of one that is_constant().
  double constant() const { return factor_ * constant_; }
  /// As it was written; "" for a number.
  const std::string& text() const;
  /// Whether both have one text, factor and time.
  bool operator==(const Formula& other) const;

 private:
  struct Parser;
  double constant_ = 0, factor_ = 1;
  std::optional<double> time_;
  std::shared_ptr<Parser> parser_;
};

template <>
struct Codec<Formula> {
  static void read(Formula& value, const YAML::Node& node, const std::string& path, Document& document, const Limits& limits);
  static YAML::Node write(const Formula& value);
  static nlohmann::ordered_json schema(const Limits& limits);
};

}  // namespace mortise::deck
