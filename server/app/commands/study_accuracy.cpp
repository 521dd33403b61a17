#include <algorithm>
#include <chrono>

#include <boost/json.hpp>
#include <fmt/format.h>

#include <spindrift/study/accuracy.h>

#include "study_suites.h"

namespace spindrift::app {
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

std::vector<Row> rowsOf(const boost::json::value& json) {
  std::vector<Row> rows;
  for (const auto& row : json.as_array()) rows.push_back(fromJson(row.as_object()));
  return rows;
}

}  // namespace

core::Result<SuiteResult> studyAccuracy(gpu::Context& ctx, const StudyOptions& options, StudyJournal& journal,
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
    std::vector<Row> rows;
    const auto known = journal.find(key);
    if (known) {
      rows = rowsOf(*known);
    } else {
      auto measured = each.run(ctx, options.quick);
      if (!measured) return core::Error{measured.error().code, each.name + ": " + measured.error().message};
      rows = *std::move(measured);
    }
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    showProgress("");
    boost::json::array json_rows;
    for (const Row& row : rows) {
      print(out, row);
      json_rows.push_back(toJson(row));
      if (row.kind != Tolerance::kNone) ++(row.passes() ? result.held_count : result.missed_count);
    }
    if (!known) {
      if (auto kept = journal.add(key, json_rows); !kept) return kept.error();
    }
    fmt::print(out, "  {}\n", known ? std::string("from the journal") : fmt::format("{:.1f} s", seconds));
    std::fflush(out);
    json_cases.push_back({{"name", each.name}, {"purpose", each.purpose}, {"seconds", seconds}, {"rows", json_rows}});
  }
  result.json["cases"] = std::move(json_cases);
  return result;
}

}  // namespace spindrift::app
