// Tables of what the simulation is worth, printed as they grow and kept in a journal, so that a long run can go on.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <fstream>
#include <thread>

#include <boost/json.hpp>
#include <fmt/format.h>
#include <unistd.h>

#include <spindrift/gpu/context.h>
#include <spindrift/study/accuracy.h>

#include "commands.h"
#include "output.h"

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
  for (const Tolerance kind : {Tolerance::kRelative, Tolerance::kAbsolute, Tolerance::kAtMost, Tolerance::kNone}) {
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

/// Finished cases of an interrupted run, one JSON object a line: {"key", "rows"}. The key holds what a result depends
/// on.
class Journal {
 public:
  explicit Journal(std::string file) : file_(std::move(file)) {
    if (file_.empty()) return;
    std::ifstream in(file_);
    for (std::string line; std::getline(in, line);) {
      boost::system::error_code broken;
      const boost::json::value value = boost::json::parse(line, broken);
      if (broken || !value.is_object()) continue;  // cut off in the middle: that case runs again
      entries_.push_back(value.as_object());
    }
  }

  [[nodiscard]] std::optional<std::vector<Row>> find(const std::string& key) const {
    for (const auto& entry : entries_) {
      if (entry.at("key").as_string() != key) continue;
      std::vector<Row> rows;
      for (const auto& row : entry.at("rows").as_array()) rows.push_back(fromJson(row.as_object()));
      return rows;
    }
    return std::nullopt;
  }

  core::Result<void> add(const std::string& key, const std::vector<Row>& rows) {
    if (file_.empty()) return {};
    boost::json::array list;
    for (const Row& row : rows) list.push_back(toJson(row));
    std::ofstream out(file_, std::ios::app);
    out << boost::json::serialize(boost::json::object{{"key", key}, {"rows", std::move(list)}}) << '\n';
    if (!out.flush())
      return core::Error{core::ErrorCode::kUnavailable, file_ + ": cannot be written: choose another --journal"};
    return {};
  }

 private:
  std::string file_;
  std::vector<boost::json::object> entries_;
};

}  // namespace

int study(const StudyOptions& options) {
  auto device = gpu::parseDeviceChoice(options.device);
  if (!device) return fail(device.error());
  const auto& cases = study::accuracyCases();
  if (!options.only.empty() && std::ranges::find(cases, options.only, &study::Case::name) == cases.end()) {
    std::string names;
    for (const auto& each : cases) names += (names.empty() ? "" : ", ") + each.name;
    return fail({core::ErrorCode::kInvalidInput, "--case: there is no '" + options.only + "'; choose one of " + names});
  }
  auto ctx = gpu::Context::create(*device);
  if (!ctx) return fail(ctx.error());

  std::FILE* out = options.json_file == "-" ? stderr : stdout;
  char host[256] = "";
  gethostname(host, sizeof host - 1);
  const gpu::DeviceInfo& info = (*ctx)->device();
  fmt::print(out, "accuracy{}; machine {}, {} hardware threads; device {}, {}\n", options.quick ? ", quick" : "", host,
             std::thread::hardware_concurrency(), info.name, info.gl_version);
  Journal journal(options.journal_file);
  boost::json::array json_cases;
  std::size_t missed = 0;
  std::size_t held = 0;
  const bool shows_progress = isatty(STDERR_FILENO) != 0;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const study::Case& each = cases[i];
    if (!options.only.empty() && each.name != options.only) continue;
    fmt::print(out, "{}: {}\n", each.name, each.purpose);
    std::fflush(out);
    if (shows_progress) fmt::print(stderr, "\r[{}/{}] {} ...\033[K", i + 1, cases.size(), each.name);
    const std::string key =
        fmt::format("accuracy {} {} {} {}", each.name, options.quick ? "quick" : "full", SPINDRIFT_VERSION, info.name);
    const auto begin = std::chrono::steady_clock::now();
    std::optional<std::vector<Row>> rows = journal.find(key);
    const bool is_known = rows.has_value();
    if (!rows) {
      auto result = each.run(**ctx, options.quick);
      if (!result) return fail({result.error().code, each.name + ": " + result.error().message});
      rows = *std::move(result);
      if (auto kept = journal.add(key, *rows); !kept) return fail(kept.error());
    }
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    if (shows_progress) fmt::print(stderr, "\r\033[K");
    boost::json::array json_rows;
    for (const Row& row : *rows) {
      print(out, row);
      json_rows.push_back(toJson(row));
      if (row.kind == Tolerance::kNone) continue;
      ++(row.passes() ? held : missed);
    }
    fmt::print(out, "  {}\n", is_known ? std::string("from the journal") : fmt::format("{:.1f} s", seconds));
    std::fflush(out);
    json_cases.push_back({{"name", each.name}, {"purpose", each.purpose}, {"seconds", seconds}, {"rows", json_rows}});
  }
  fmt::print(out, "{} within tolerance, {} missed\n", held, missed);
  const boost::json::object json = {{"suite", "accuracy"},
                                    {"quick", options.quick},
                                    {"threads", std::thread::hardware_concurrency()},
                                    {"device", info.name},
                                    {"gl_version", info.gl_version},
                                    {"held", held},
                                    {"missed", missed},
                                    {"cases", json_cases}};
  if (auto written = writeJson(options.json_file, json); !written) return fail(written.error());
  return missed == 0 ? 0 : 1;
}

}  // namespace spindrift::app
