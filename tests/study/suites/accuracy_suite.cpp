#include <algorithm>
#include <chrono>
#include <cmath>

#include <boost/json.hpp>
#include <fmt/format.h>

#include <spindrift/study/accuracy.h>
#include <spindrift/study_suites/suites.h>

namespace spindrift::study_suites {
namespace {

using study::Row;
using study::Tolerance;

const char* nameOf(Tolerance kind) {
  switch (kind) {
    case Tolerance::kRelative:
      return "relative";
    case Tolerance::kAbsolute:
      return "absolute";
    case Tolerance::kAtMost:
      return "at most";
    case Tolerance::kAtLeast:
      return "at least";
    case Tolerance::kNone:
      break;
  }
  return "none";
}

boost::json::object toJson(const Row& row) {
  return {{"name", row.name},           {"unit", row.unit},     {"measured", row.measured},
          {"expected", row.expected},   {"error", row.error()}, {"tolerance_kind", nameOf(row.kind)},
          {"tolerance", row.tolerance}, {"source", row.source}, {"passes", row.passes()}};
}

Row fromJson(const boost::json::object& json) {
  Row row;
  row.name = json.at("name").as_string();
  row.unit = json.at("unit").as_string();
  row.measured = json.at("measured").to_number<double>();
  row.expected = json.at("expected").to_number<double>();
  row.tolerance = json.at("tolerance").to_number<double>();
  row.source = json.at("source").as_string();
  for (const Tolerance kind :
       {Tolerance::kRelative, Tolerance::kAbsolute, Tolerance::kAtMost, Tolerance::kAtLeast, Tolerance::kNone}) {
    if (json.at("tolerance_kind").as_string() == nameOf(kind)) row.kind = kind;
  }
  return row;
}

std::string bound(const Row& row) {
  switch (row.kind) {
    case Tolerance::kRelative:
      return fmt::format("{:.6g} +- {:.3g} %", row.expected, 100 * row.tolerance);
    case Tolerance::kAbsolute:
      return fmt::format("{:.6g} +- {:.3g}", row.expected, row.tolerance);
    case Tolerance::kAtMost:
      return fmt::format("<= {:.4g}", row.expected);
    case Tolerance::kAtLeast:
      return fmt::format(">= {:.4g}", row.expected);
    case Tolerance::kNone:
      break;
  }
  return "-";
}

std::string errorOf(const Row& row) {
  if (row.kind == Tolerance::kRelative) return fmt::format("{:+.2g} %", 100 * row.error());
  if (row.kind == Tolerance::kAbsolute) return fmt::format("{:+.2g}", row.error());
  return "";
}

void print(std::FILE* out, const Row& row) {
  fmt::print(out, "  {:<4} {:<78} {:>12.6g} {:<5} {:>22} {:>10}   {}\n",
             row.kind == Tolerance::kNone ? ""
             : row.passes()               ? "ok"
                                          : "MISS",
             row.name, row.measured, row.unit, bound(row), errorOf(row), row.source);
}

boost::json::object toJson(const study::Figure& figure) {
  boost::json::array curves;
  for (const study::Figure::Curve& curve : figure.curves) {
    boost::json::array points;
    for (const auto& [x, y] : curve.points) points.push_back(boost::json::array{x, y});
    curves.push_back({{"name", curve.name}, {"is_measured", curve.is_measured}, {"points", std::move(points)}});
  }
  return {{"name", figure.name},
          {"title", figure.title},
          {"x_label", figure.x_label},
          {"y_label", figure.y_label},
          {"is_logarithmic", figure.is_logarithmic},
          {"curves", std::move(curves)}};
}

study::Figure figureFrom(const boost::json::object& json) {
  study::Figure figure;
  figure.name = json.at("name").as_string();
  figure.title = json.at("title").as_string();
  figure.x_label = json.at("x_label").as_string();
  figure.y_label = json.at("y_label").as_string();
  figure.is_logarithmic = json.at("is_logarithmic").as_bool();
  for (const auto& value : json.at("curves").as_array()) {
    const auto& object = value.as_object();
    study::Figure::Curve curve{std::string(object.at("name").as_string()), {}, object.at("is_measured").as_bool()};
    for (const auto& point : object.at("points").as_array())
      curve.points.emplace_back(point.at(0).to_number<double>(), point.at(1).to_number<double>());
    figure.curves.push_back(std::move(curve));
  }
  return figure;
}

/// Values as whole numbers of a step, 1/500 of the largest: finer than colours show, and short.
boost::json::object toJson(const study::FieldFigure& figure) {
  double largest = 0.0;
  for (const auto& panel : figure.panels) {
    for (const double value : panel.values) largest = std::max(largest, std::abs(value));
  }
  const double step = largest > 0 ? largest / 500 : 1.0;
  boost::json::array panels;
  for (const auto& panel : figure.panels) {
    boost::json::array steps;
    for (const double value : panel.values) steps.push_back(std::lround(value / step));
    panels.push_back({{"name", panel.name}, {"steps", std::move(steps)}});
  }
  return {{"name", figure.name},           {"title", figure.title},
          {"unit", figure.unit},           {"columns_count", figure.columns_count},
          {"cell_m", figure.cell_m},       {"first_x_m", figure.first_x_m},
          {"first_z_m", figure.first_z_m}, {"step", step},
          {"panels", std::move(panels)}};
}

study::FieldFigure fieldsFrom(const boost::json::object& json) {
  study::FieldFigure figure;
  figure.name = json.at("name").as_string();
  figure.title = json.at("title").as_string();
  figure.unit = json.at("unit").as_string();
  figure.columns_count = json.at("columns_count").to_number<std::size_t>();
  figure.cell_m = json.at("cell_m").to_number<double>();
  figure.first_x_m = json.at("first_x_m").to_number<double>();
  figure.first_z_m = json.at("first_z_m").to_number<double>();
  const double step = json.at("step").to_number<double>();
  for (const auto& value : json.at("panels").as_array()) {
    const auto& object = value.as_object();
    study::FieldFigure::Panel panel{std::string(object.at("name").as_string()), {}};
    for (const auto& steps : object.at("steps").as_array()) panel.values.push_back(steps.to_number<double>() * step);
    figure.panels.push_back(std::move(panel));
  }
  return figure;
}

boost::json::object toJson(const study::CaseResult& result) {
  boost::json::array rows, figures, fields;
  for (const Row& row : result.rows) rows.push_back(toJson(row));
  for (const study::Figure& figure : result.figures) figures.push_back(toJson(figure));
  for (const study::FieldFigure& figure : result.fields) fields.push_back(toJson(figure));
  boost::json::object out{{"rows", std::move(rows)}, {"figures", std::move(figures)}};
  if (!fields.empty()) out["fields"] = std::move(fields);
  return out;
}

study::CaseResult resultFrom(const boost::json::object& json) {
  study::CaseResult result;
  for (const auto& row : json.at("rows").as_array()) result.rows.push_back(fromJson(row.as_object()));
  for (const auto& figure : json.at("figures").as_array()) result.figures.push_back(figureFrom(figure.as_object()));
  if (const auto* fields = json.if_contains("fields")) {
    for (const auto& figure : fields->as_array()) result.fields.push_back(fieldsFrom(figure.as_object()));
  }
  return result;
}

}  // namespace

core::Result<SuiteResult> studyAccuracy(gpu::Context& ctx, const SuiteOptions& options, StudyJournal& journal,
                                        std::FILE* out) {
  const auto& cases = study::accuracyCases();
  if (!options.only.empty() && std::ranges::find(cases, options.only, &study::Case::name) == cases.end()) {
    std::string names;
    for (const auto& each : cases) names += (names.empty() ? "" : ", ") + each.name;
    return core::Error{core::ErrorCode::kInvalidInput,
                       "--case: there is no '" + options.only + "'; choose one of " + names};
  }
  SuiteResult result;
  boost::json::array json_cases;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const study::Case& each = cases[i];
    if (!options.only.empty() && each.name != options.only) continue;
    fmt::print(out, "{}: {}\n", each.name, each.purpose);
    std::fflush(out);
    showProgress(fmt::format("[{}/{}] {}", i + 1, cases.size(), each.name));
    const std::string key = journalKey("accuracy", each.name, options, ctx);
    const auto begin = std::chrono::steady_clock::now();
    study::CaseResult found;
    const auto known = journal.find(key);
    if (known) {
      found = resultFrom(known->as_object());
    } else {
      auto measured = each.run(ctx, options.quick);
      if (!measured) return core::Error{measured.error().code, each.name + ": " + measured.error().message};
      found = *std::move(measured);
    }
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    showProgress("");
    for (const Row& row : found.rows) {
      print(out, row);
      if (row.kind != Tolerance::kNone) ++(row.passes() ? result.held_count : result.missed_count);
    }
    if (!known) {
      if (auto kept = journal.add(key, toJson(found)); !kept) return kept.error();
    }
    fmt::print(out, "  {}\n", known ? std::string("from the journal") : fmt::format("{:.1f} s", seconds));
    std::fflush(out);
    boost::json::object json = toJson(found);
    json["name"] = each.name;
    json["purpose"] = each.purpose;
    json["seconds"] = seconds;
    json_cases.push_back(std::move(json));
  }
  result.json["cases"] = std::move(json_cases);
  return result;
}

}  // namespace spindrift::study_suites
