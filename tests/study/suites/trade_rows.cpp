#include "trade_rows.h"

#include <utility>

#include <fmt/format.h>

namespace spindrift::study_suites {
namespace {

boost::json::value toJson(const std::optional<double>& value) {
  return value ? boost::json::value(*value) : boost::json::value();
}

std::optional<double> optionalNumber(const boost::json::object& json, const char* name) {
  const auto& value = json.at(name);
  return value.is_null() ? std::nullopt : std::optional(value.to_number<double>());
}

std::string percent(const std::optional<double>& ratio) {
  return ratio ? fmt::format("{:.3g}", 100 * *ratio) : "-";
}

}  // namespace

boost::json::object toJson(const TradeRow& r) {
  return {{"knob", r.knob},
          {"setting", r.setting},
          {"refused", r.refused},
          {"cost_ms_per_s", r.cost_ms_per_s},
          {"device_mb", r.device_mb},
          {"stream_mbit_per_s", r.stream_mbit_per_s},
          {"wave_cells", r.wave_cells_count},
          {"particles", r.particle_count},
          {"substeps_per_s", r.substeps_per_s_count},
          {"guard_count", r.recovered_count},
          {"pass_ms_per_s", r.pass_ms_per_s},
          {"height_rms_ratio", r.errors.height_rms_ratio},
          {"surface_rms_ratio", toJson(r.errors.surface_rms_ratio)},
          {"surface_max_ratio", toJson(r.errors.surface_max_ratio)},
          {"spectrum_ratio", toJson(r.errors.spectrum_ratio)},
          {"column_rms_ratio", toJson(r.errors.column_rms_ratio)},
          {"front_rms_ratio", toJson(r.errors.front_rms_ratio)},
          {"density_rms_ratio", toJson(r.errors.density_rms_ratio)},
          {"energy_rms_ratio", r.errors.energy_rms_ratio}};
}

TradeRow rowFromJson(const boost::json::object& json) {
  TradeRow r;
  r.knob = json.at("knob").as_string();
  r.setting = json.at("setting").as_string();
  r.refused = json.at("refused").as_string();
  r.cost_ms_per_s = json.at("cost_ms_per_s").to_number<double>();
  r.device_mb = json.at("device_mb").to_number<double>();
  r.stream_mbit_per_s = json.at("stream_mbit_per_s").to_number<double>();
  r.wave_cells_count = json.at("wave_cells").to_number<std::uint32_t>();
  r.particle_count = json.at("particles").to_number<std::uint32_t>();
  r.substeps_per_s_count = json.at("substeps_per_s").to_number<std::uint32_t>();
  r.recovered_count = json.at("guard_count").to_number<std::uint64_t>();
  r.pass_ms_per_s = json.at("pass_ms_per_s").as_object();
  r.errors.height_rms_ratio = json.at("height_rms_ratio").to_number<double>();
  r.errors.surface_rms_ratio = optionalNumber(json, "surface_rms_ratio");
  r.errors.surface_max_ratio = optionalNumber(json, "surface_max_ratio");
  r.errors.spectrum_ratio = optionalNumber(json, "spectrum_ratio");
  r.errors.column_rms_ratio = optionalNumber(json, "column_rms_ratio");
  r.errors.front_rms_ratio = optionalNumber(json, "front_rms_ratio");
  r.errors.density_rms_ratio = optionalNumber(json, "density_rms_ratio");
  r.errors.energy_rms_ratio = json.at("energy_rms_ratio").to_number<double>();
  return r;
}

boost::json::array toJson(const std::vector<TradeRow>& rows) {
  boost::json::array json;
  for (const TradeRow& row : rows) {
    boost::json::object object = toJson(row);
    object["on_front"] = row.is_on_front;
    json.push_back(std::move(object));
  }
  return json;
}

TradeRow rowOf(const TradeChoice& choice, const WaterRecord& run) {
  TradeRow row;
  row.knob = choice.knob;
  row.setting = choice.setting;
  row.cost_ms_per_s = run.cost_ms_per_s;
  row.device_mb = static_cast<double>(run.device_bytes) / 1e6;
  row.stream_mbit_per_s = run.frame_bytes * 8e-6 * choice.scene.stream.frame_rate_hz;
  row.wave_cells_count = run.wave_cells_count;
  row.particle_count = run.particle_count;
  row.substeps_per_s_count = run.substeps_per_s_count;
  row.recovered_count = run.recovered_count;
  for (const gpu::PassCost& pass : run.passes) row.pass_ms_per_s[pass.name] = pass.total_ms / run.seconds;
  return row;
}

void printTradeHeader(std::FILE* out) {
  fmt::print(out, "  {:<17} {:<20} {:>8} {:>6} {:>6} {:>7} {:>7} {:>7} {:>8} {:>8} {:>7} {:>8} {:>8} {:>7} {:>7}\n",
             "knob", "setting", "ms / s", "cost x", "MB", "Mbit/s", "height%", "error x", "surface%", "largest%",
             "spectr%", "columns%", "density%", "front%", "energy%");
}

void print(std::FILE* out, const TradeRow& row, const TradeRow& balanced) {
  if (!row.refused.empty()) {
    fmt::print(out, "  {:<17} {:<20} refused: {}\n", row.knob, row.setting, row.refused);
    return;
  }
  const RecordErrors& e = row.errors;
  fmt::print(
      out,
      "{} {:<17} {:<20} {:>8.1f} {:>6.2f} {:>6.1f} {:>7.2f} {:>7.3g} {:>7.2f} {:>8} {:>8} {:>7} {:>8} {:>8} {:>7} "
      "{:>7.3g}{}\n",
      row.is_on_front ? "*" : " ", row.knob, row.setting, row.cost_ms_per_s, row.cost_ms_per_s / balanced.cost_ms_per_s,
      row.device_mb, row.stream_mbit_per_s, 100 * e.height_rms_ratio,
      e.height_rms_ratio / balanced.errors.height_rms_ratio, percent(e.surface_rms_ratio), percent(e.surface_max_ratio),
      percent(e.spectrum_ratio), percent(e.column_rms_ratio), percent(e.density_rms_ratio), percent(e.front_rms_ratio),
      100 * e.energy_rms_ratio, row.recovered_count > 0 ? fmt::format("  watchdog {}", row.recovered_count) : "");
}

void printCosts(std::FILE* out, const std::vector<TradeRow>& rows) {
  fmt::print(out, "  {:<26} {:<22} {:>9} {:>8} {:>9}   ms per simulated second by pass\n", "parts", "size", "ms / s",
             "MB", "substeps");
  for (const TradeRow& row : rows) {
    fmt::print(out, "  {:<26} {:<22} {:>9.1f} {:>8.2f} {:>9}  ", row.knob, row.setting, row.cost_ms_per_s,
               row.device_mb, row.substeps_per_s_count);
    for (const auto& [name, ms] : row.pass_ms_per_s)
      fmt::print(out, " {} {:.1f}", std::string(name), ms.to_number<double>());
    fmt::print(out, "\n");
  }
  std::fflush(out);
}

}  // namespace spindrift::study_suites
