#include <algorithm>
#include <cmath>

#include <boost/json.hpp>
#include <fmt/format.h>

#include <spindrift/study/stability.h>
#include <spindrift/study_suites/suites.h>

namespace spindrift::study_suites {
namespace {

using study::StabilityPoint;
using study::Sweep;

/// Predicted and found step bounds agree within this factor.
constexpr double kBoundAgreement = 1.5;

boost::json::object toJson(const StabilityPoint& p) {
  return {{"value", p.value},
          {"refused", p.refused},
          {"frames_finite", p.are_frames_finite},
          {"guard_count", p.recovered_count},
          {"well_after", p.is_well_after},
          {"max_density_ratio", p.max_density_ratio},
          {"energy_growth", p.energy_growth},
          {"slowest_step_s", p.slowest_step_s},
          {"stable", p.is_stable}};
}

StabilityPoint fromJson(const boost::json::object& json) {
  StabilityPoint p;
  p.value = json.at("value").to_number<double>();
  p.refused = json.at("refused").as_string();
  p.are_frames_finite = json.at("frames_finite").as_bool();
  p.recovered_count = json.at("guard_count").to_number<std::uint64_t>();
  p.is_well_after = json.at("well_after").as_bool();
  p.max_density_ratio = json.at("max_density_ratio").to_number<double>();
  p.energy_growth = json.at("energy_growth").to_number<double>();
  p.slowest_step_s = json.at("slowest_step_s").to_number<double>();
  p.is_stable = json.at("stable").as_bool();
  return p;
}

void print(std::FILE* out, const Sweep& sweep, const StabilityPoint& p) {
  if (!p.refused.empty()) {
    fmt::print(out, "  {:>8.4g} {:<10} refused: {}\n", p.value, sweep.unit, p.refused);
    return;
  }
  fmt::print(
      out, "  {:>8.4g} {:<10} {:<8} watchdog {:>2}  {:<9}  density {:>6.3f}  energy {:>9.3g}  slowest step {:.0f} ms\n",
      p.value, sweep.unit, p.is_stable ? "stable" : "unstable", p.recovered_count,
      p.is_well_after ? "recovers" : "LOST", p.max_density_ratio, p.energy_growth, 1e3 * p.slowest_step_s);
}

core::Result<std::vector<StabilityPoint>> measure(gpu::Context& ctx, const Sweep& sweep, const std::string& key,
                                                  StudyJournal& journal) {
  std::vector<StabilityPoint> points;
  if (const auto known = journal.find(key)) {
    for (const auto& point : known->as_array()) points.push_back(fromJson(point.as_object()));
    return points;
  }
  boost::json::array json;
  for (const double value : sweep.values) {
    showProgress(fmt::format("{}: {}", sweep.name, value));
    auto point = study::runPoint(ctx, sweep, value);
    if (!point) return core::Error{point.error().code, sweep.name + ": " + point.error().message};
    json.push_back(toJson(*point));
    points.push_back(*std::move(point));
  }
  showProgress("");
  if (auto kept = journal.add(key, std::move(json)); !kept) return kept.error();
  return points;
}

}  // namespace

core::Result<SuiteResult> studyStability(gpu::Context& ctx, const SuiteOptions& options, StudyJournal& journal,
                                         std::FILE* out) {
  SuiteResult result;
  boost::json::array json_sweeps;
  for (const Sweep& sweep : study::stabilitySweeps(options.quick)) {
    if (!options.only.empty() && sweep.name.find(options.only) == std::string::npos) continue;
    fmt::print(out, "{}\n", sweep.name);
    std::fflush(out);
    auto points = measure(ctx, sweep, journalKey("stability", sweep.name, options, ctx), journal);
    if (!points) return points.error();
    boost::json::array json_points;
    for (const StabilityPoint& point : *points) {
      print(out, sweep, point);
      json_points.push_back(toJson(point));
      ++(point.refused.empty() && !point.isSafe() ? result.missed_count : result.held_count);
    }
    boost::json::object json = {{"name", sweep.name}, {"unit", sweep.unit}, {"points", std::move(json_points)}};
    if (sweep.predicted_bound) {
      const auto found = study::foundBound(*points);
      const double ratio = found ? *found / *sweep.predicted_bound : 0.0;
      const bool agrees = ratio <= kBoundAgreement && ratio >= 1 / kBoundAgreement;
      ++(agrees ? result.held_count : result.missed_count);
      json["predicted_bound"] = *sweep.predicted_bound;
      json["found_bound"] = found ? boost::json::value(*found) : boost::json::value();
      fmt::print(out, "  {} bound: predicted {:.4g}, found {:.4g}, within a factor of {}\n", agrees ? "ok  " : "MISS",
                 *sweep.predicted_bound, found.value_or(0.0), kBoundAgreement);
    }
    std::fflush(out);
    json_sweeps.push_back(std::move(json));
  }
  if (json_sweeps.empty()) {
    std::string names;
    for (const Sweep& sweep : study::stabilitySweeps(options.quick)) names += (names.empty() ? "" : "; ") + sweep.name;
    return core::Error{core::ErrorCode::kInvalidInput,
                       "--case: no sweep's name contains '" + options.only + "'; there are: " + names};
  }
  result.json["sweeps"] = std::move(json_sweeps);
  return result;
}

}  // namespace spindrift::study_suites
