// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <polhode/io/importers/feb_file.hpp>

namespace polhode::io {

/// A piece of a load curve: a polynomial of the time since its beginning.
struct FebPiece {
  double from = 0.0, to = 0.0;     ///< [s]
  std::array<double, 6> powers{};  ///< Coefficients, from the constant on.
  [[nodiscard]] double at(double t) const;
};

/// The part of a piece between two times.
[[nodiscard]] FebPiece between(FebPiece piece, double begin, double end);

/// A load curve as FEBio reads it.
struct FebCurve {
  enum class Rule : unsigned char { linear, step, smooth, smooth_step };
  enum class Extend : unsigned char { constant, extrapolate, repeat, repeat_offset };
  Rule rule = Rule::linear;
  Extend extend = Extend::constant;
  std::vector<std::array<double, 2>> points;  ///< Time and value, by time.

  /// Pieces from 0, or the first point, up to a time at least.
  /// @param most  Largest number of pieces; none are returned if there would be more.
  [[nodiscard]] std::vector<FebPiece> pieces(double until, std::size_t most) const;
};

/// Times between which a value acts; elsewhere it is zero.
struct FebWindow {
  double begin = 0.0, end = 0.0;  ///< [s]
};

/// A value in one of several steps.
struct FebSpan {
  double begin = 0.0, end = 0.0;  ///< [s]
  std::optional<FebValue> value;  ///< Nothing: that at the start of the step.
  bool relative = false;          ///< Added to that at the start of the step.
  bool released = false;          ///< Goes on as it was, as nothing follows it any more.
};

/// The load controllers of a file, as values of a model file.
class FebCurves {
 public:
  explicit FebCurves(FebFile& file) : file_(file) {}

  bool dynamic = true;  ///< Whether the analysis is.
  double until = 0.0;   ///< End of the analysis [s]; curves that repeat are written out up to it.

  /// Reads <LoadData>.
  void read(const XmlFile::Element& section);

  /// A value over time, times a factor.
  [[nodiscard]] SourceNode node(const FebValue& value, double factor = 1.0);
  /// A value that each step gives in its own way.
  [[nodiscard]] SourceNode node(const XmlFile::Element& at, const std::vector<FebSpan>& spans,
                                double factor = 1.0);
  /// Times of the points of a load curve; none of other controllers.
  [[nodiscard]] std::vector<std::array<double, 2>> points(int controller) const;

  /// The PID controllers that values use; to be called when all values are written.
  /// @param bodies  Names in the model of the rigid bodies, by their name in the file.
  /// @param order   Names in the model, in the order of the file.
  void write_controllers(const std::map<std::string, std::string>& bodies,
                         const std::vector<std::string>& order, SourceNode& root);

  std::optional<FebWindow> window;  ///< Of all values that are written while it is there.

 private:
  struct Controller {
    const XmlFile::Element* at = nullptr;
    std::string math;  ///< Expression of t in the language of a model file.
    FebCurve curve;
    std::string channel;              ///< Parameter that a PID controller reads.
    double target = 0.0, gains[3]{};  ///< Of it: proportional, integral, derivative.
    bool usable = false;
  };
  /// A controller of the model: that of a file times a factor.
  struct Controlled {
    int id;
    double factor;
    std::string name;
    const XmlFile::Element* at;  ///< First value that uses it.
  };
  /// Whether a value follows a load curve.
  [[nodiscard]] bool is_curve(const FebValue& value) const;
  /// Pieces of a value between two times; nothing after an error.
  std::optional<std::vector<FebPiece>> pieces_of(const FebSpan& span);
  void read_pid(const XmlFile::Element& e, Controller& controller);
  SourceNode pid_node(const NodeBuilder& make, const FebValue& value, double factor);
  void read_curve(const XmlFile::Element& e, Controller& controller);
  SourceNode pieces_node(const NodeBuilder& make, const XmlFile::Element& at,
                         std::vector<FebPiece> pieces, double scale);

  FebFile& file_;
  std::map<int, Controller> controllers_;
  std::vector<Controlled> controlled_;
};

/// An expression of FEBio in the language of a model file; "" if it has anything else.
/// @param unknown  The part that is not known.
[[nodiscard]] std::string expression_of_feb(const std::string& text, std::string& unknown);

}  // namespace polhode::io
