// One run of the trade suite: its cost and error, as JSON and as a row of the table.
#pragma once

#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

#include <boost/json.hpp>

#include <spindrift/study/trade.h>
#include <spindrift/study/water_record.h>

namespace spindrift::study_suites {

using study::RecordErrors;
using study::TradeChoice;
using study::WaterRecord;

/// Results of one run.
struct TradeRow {
  std::string knob, setting;
  std::string refused;         ///< why the scene could not run; empty: it ran
  double cost_ms_per_s = 0.0;  ///< as in WaterRecord
  double device_mb = 0.0;
  double stream_mbit_per_s = 0.0;
  std::uint32_t wave_cells_count = 0, particle_count = 0, substeps_per_s_count = 0;
  std::uint64_t recovered_count = 0;
  boost::json::object pass_ms_per_s;
  RecordErrors errors;
  bool is_on_front = false;
};

boost::json::object toJson(const TradeRow& row);
/// Includes "on_front".
boost::json::array toJson(const std::vector<TradeRow>& rows);
TradeRow rowFromJson(const boost::json::object& json);

/// Fills all members except the errors and the front.
TradeRow rowOf(const TradeChoice& choice, const WaterRecord& run);

void printTradeHeader(std::FILE* out);
void print(std::FILE* out, const TradeRow& row, const TradeRow& balanced);
/// Costs of scenes, without errors.
void printCosts(std::FILE* out, const std::vector<TradeRow>& rows);

}  // namespace spindrift::study_suites
